#include "servo/drive_joints.h"

#include <stdexcept>

namespace legible {
namespace {

constexpr double kStall_s = 1.5;

// Joint control looks at nothing.
class NoEdges : public EdgeSource {
 public:
  SeenEdges See(const MotionNow& motion) override {
    SeenEdges seen;
    seen.time_s = motion.time_s;
    return seen;
  }
};

ServoOptions OptionsOf(const JointDriveOptions& options) {
  ServoOptions servo;
  servo.step.law.mode = ControlMode::kJoints;
  servo.step.gain = AdaptiveGain::Constant(options.gain_per_s);
  servo.step.limits = options.limits;
  servo.supervision.tolerance = options.tolerance_m;
  servo.supervision.stall_s = kStall_s;
  servo.supervision.timeout_s = options.timeout_s;
  return servo;
}

// A camera that no law of joint control uses.
Camera AnyCamera() {
  Camera camera;
  camera.width_px = camera.height_px = 2;
  camera.fx_px = camera.fy_px = 1;
  return camera;
}

bool IsHopeless(ServoEnd end) {
  switch (end) {
    case ServoEnd::kBadReadings:
    case ServoEnd::kStaleReadings:
    case ServoEnd::kFrozenReadings:
    case ServoEnd::kDrivesDoNotMove:
    case ServoEnd::kLinkLost:
    case ServoEnd::kStoppedByUser:
      return true;
    default:
      return false;
  }
}

ServoLoopOptions LoopOf(const JointDriveOptions& options) {
  ServoLoopOptions loop;
  loop.period_s = options.period_s;
  loop.is_stopped = options.is_stopped;
  return loop;
}

}  // namespace

void JointDriveOptions::Check() const {
  if (!(tolerance_m > 0) || !(near_enough_m >= tolerance_m))
    throw std::invalid_argument(
        "JointDriveOptions: tolerance_m must be positive and near_enough_m not smaller");
  if (!(gain_per_s > 0) || !(timeout_s > 0))
    throw std::invalid_argument("JointDriveOptions: gain_per_s and timeout_s must be positive");
  limits.Check();
  LoopOf(*this).Check();
}

JointDrive DriveJoints(Rig& rig, const GoughStewart& robot, const Vector6d& joint_readings_m,
                       const JointDriveOptions& options) {
  options.Check();
  ServoGoal goal;
  goal.joint_readings_m = joint_readings_m;
  ServoController controller(MakeServoModel(robot, AnyCamera(), Rigid3()), goal, OptionsOf(options));
  NoEdges nothing;
  double to_go_m = INFINITY;
  const ServoRun run = RunServo(rig, nothing, controller, LoopOf(options),
                                [&](const ServoCycle& cycle) { to_go_m = cycle.output.step.law.error; });
  JointDrive drive;
  drive.end = run.end;
  drive.reason = run.reason;
  drive.has_arrived =
      run.end == ServoEnd::kConverged || (run.end == ServoEnd::kStalled && to_go_m <= options.near_enough_m);
  drive.is_hopeless = IsHopeless(run.end);
  return drive;
}

}  // namespace legible
