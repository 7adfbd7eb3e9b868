#include "servo/servo_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/stopwatch.h"

namespace legible {
namespace {

constexpr const char* kStoppedByUser = "stopped by the user";

// Leaves the rig at rest, however its scope is left.
class AtRestInTheEnd {
 public:
  explicit AtRestInTheEnd(Rig& rig) : rig_(rig) {}
  AtRestInTheEnd(const AtRestInTheEnd&) = delete;
  AtRestInTheEnd& operator=(const AtRestInTheEnd&) = delete;
  ~AtRestInTheEnd() { rig_.Stop(); }

 private:
  Rig& rig_;
};

// Nothing where the camera has not given an image yet.
std::optional<SeenEdges> SeeIfThereIsAnImage(EdgeSource& source, const MotionNow& motion) {
  try {
    return source.See(motion);
  } catch (const NoImageYet&) {
    return std::nullopt;
  }
}

// The robot is at rest, and a first look may take long: nothing is stale by it. The end of the servo if no
// image comes for a law that needs it, or the user wants no more.
Verdict LookFirst(Rig& rig, EdgeSource& source, ServoController& controller,
                  const ServoLoopOptions& options) {
  const double start_s = rig.Now();
  for (int round = 1; round * options.period_s <= options.first_image_s; ++round) {
    const StampedReadings readings = rig.ReadJoints();
    const auto seen =
        SeeIfThereIsAnImage(source, {readings.time_s, readings.joint_readings_m, Vector6d::Zero()});
    if (seen || !controller.NeedsImages()) return {};
    if (options.is_stopped()) return controller.End(ServoEnd::kStoppedByUser, kStoppedByUser);
    rig.WaitUntil(start_s + round * options.period_s);
  }
  return controller.End(
      ServoEnd::kStaleImages,
      fmt::format("no image has come from the camera within {:.2g} s", options.first_image_s));
}

ServoCycle RunCycle(Rig& rig, EdgeSource& source, ServoController& controller, const Vector6d& commanded) {
  ServoCycle cycle;
  cycle.input.readings = rig.ReadJoints();
  const StampedReadings& readings = cycle.input.readings;
  Stopwatch watch;
  // Without any image it is a law that needs none: the others have waited.
  const auto seen = SeeIfThereIsAnImage(source, {readings.time_s, readings.joint_readings_m, commanded});
  cycle.input.seen = seen.value_or(SeenEdges{});
  cycle.look_s = watch.Lap();
  cycle.input.time_s = rig.Now();
  watch.Lap();
  cycle.output = controller.Cycle(cycle.input);
  cycle.law_s = watch.Lap();
  return cycle;
}

}  // namespace

void ServoLoopOptions::Check() const {
  if (!(period_s > 0) || period_s > kLongestPeriod_s)
    throw std::invalid_argument(
        fmt::format("a period of {} s is out of range: give more than 0 and {} s at most, for a rig holds a "
                    "command no longer than {} s",
                    period_s, kLongestPeriod_s, Rig::kCommandHolds_s));
  if (!(first_image_s >= period_s))
    throw std::invalid_argument("ServoLoopOptions: first_image_s must be no less than period_s");
}

ServoRun RunServo(Rig& rig, EdgeSource& source, ServoController& controller, const ServoLoopOptions& options,
                  const std::function<void(const ServoCycle&)>& record) {
  options.Check();
  const AtRestInTheEnd at_rest(rig);
  ServoRun run;
  const auto take = [&run](const Verdict& verdict) {
    run.end = verdict.end;
    run.reason = verdict.reason;
  };
  try {
    take(LookFirst(rig, source, controller, options));
    const double start_s = rig.Now();
    double late_s =
        0;  // what cycles that took longer than a period have cost: it is not made up for in a burst
    Vector6d commanded = Vector6d::Zero();
    while (run.end == ServoEnd::kRunning) {
      const ServoCycle cycle = RunCycle(rig, source, controller, commanded);
      commanded = cycle.output.joint_speeds_m_per_s;
      take(cycle.output.verdict);
      if (run.end == ServoEnd::kRunning)
        rig.CommandSpeeds(commanded);
      else
        rig.Stop();
      ++run.cycles;
      run.time_s = cycle.input.time_s - start_s;
      record(cycle);
      if (run.end == ServoEnd::kRunning && options.is_stopped())
        take(controller.End(ServoEnd::kStoppedByUser, kStoppedByUser));
      if (run.end != ServoEnd::kRunning) break;
      const double next_s = start_s + run.cycles * options.period_s;
      late_s = std::max(late_s, rig.Now() - next_s);
      rig.WaitUntil(next_s + late_s);
    }
  } catch (const RigError& error) {
    take(controller.End(ServoEnd::kLinkLost, std::string("the rig does not answer: ") + error.what()));
  }
  return run;
}

}  // namespace legible
