// Decides when a servo has arrived and when it must not go on. What it has decided stays decided.
#pragma once

#include <bitset>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/rig/rig.h"
#include "core/vision/seen_edges.h"
#include "servo/joint_following.h"
#include "servo/servo_step.h"

namespace legible {

enum class ServoEnd {
  kRunning,
  kConverged,
  kBadReadings,     // not numbers
  kStaleReadings,   // too old
  kFrozenReadings,  // the same though the joints should have moved
  kStaleImages,
  kFrozenImages,
  kDrivesDoNotMove,  // neither readings nor images change
  kTooFewEdges,
  kIllConditionedEdges,
  kRobotSingular,
  kNoPose,
  kErrorGrows,
  kStalled,  // the error no longer falls
  kTimeout,
  kLinkLost,
  kStoppedByUser,
  kFailed,  // the program itself
};
// "converged", "stale-images", …
const char* ToString(ServoEnd end);

struct SupervisorOptions {
  double tolerance = 0;  // of the error, in the mode's unit; 0: DefaultTolerance
  // An error that no longer falls and is no more than this many times what noise alone leaves has converged
  // too.
  double tolerance_in_noise = 1.5;
  double dwell_s = 0.2;        // for which it is to stay there
  double stale_s = 0.1;        // oldest image, oldest readings
  double unusable_s = 0.5;     // for which too little may be seen: the robot waits
  double unanswered_m = 3e-3;  // of commanded way that nothing answers
  double growth_factor = 1.5;  // over the smallest error so far, and as many default tolerances as below
  double growth_tolerances = 50;
  double growth_s = 0.5;
  double stall_s = 3;  // in which the error must fall by stall_share
  double stall_share = 0.05;
  double timeout_s = 60;

  void Check() const;  // throws std::invalid_argument
};

// 0.1 px, 2 mrad, 0.1 mm for a pose and 0.05 mm for joints.
double DefaultTolerance(ControlMode mode);

// What a cycle of the loop begins with.
struct CycleInput {
  double time_s = 0;  // of the rig's clock
  StampedReadings readings;
  SeenEdges seen;
};

struct Verdict {
  ServoEnd end = ServoEnd::kRunning;
  std::string reason;       // in words; empty while it runs
  bool is_waiting = false;  // running, but not allowed to move: too little is seen
  double tolerance = 0;     // of the error
};

class Supervisor {
 public:
  Supervisor(const ControlLawOptions& law, const SupervisorOptions& options);

  // How far each joint was commanded since its reading last changed, m.
  const Vector6d& WaySinceReadings() const { return way_since_readings_m_; }

  // To be told of each cycle before the step: what came, and the speeds commanded since the last one.
  void Note(const CycleInput& input, const Vector6d& commanded_m_per_s);
  // And after it.
  Verdict Judge(const CycleInput& input, const ServoStep& step);
  // From outside: the link, the user. Keeps an earlier end.
  Verdict End(ServoEnd end, const std::string& reason);

 private:
  struct Moment {
    double time_s;
    std::bitset<2 * kLegCount> edges;  // behind the error
    double error, fastest_m_per_s;
    double noises;  // mean square of the way to go, in what noise makes of it; of a weighted law
    double singularity_factor;
    bool is_at_speed_limit;
    std::bitset<kLegCount> at_shortest, at_longest;
    Vector6d readings_m, commanded_way_m;
  };

  std::optional<Verdict> JudgeInput(const CycleInput& input) const;
  std::optional<Verdict> JudgeAnswers(const CycleInput& input) const;
  std::optional<Verdict> JudgeFollowing() const;
  bool HaveJointsMovedSinceImages() const;
  std::optional<Verdict> JudgeUsability(const CycleInput& input, const ServoStep& step);
  std::optional<Verdict> JudgeProgress(const CycleInput& input, const ServoStep& step);
  bool HasArrived(const CycleInput& input, const ServoStep& step);
  // Those that an error in the image is the mean over; none where the error is no matter of edges.
  std::bitset<2 * kLegCount> EdgesBehind(const CycleInput& input) const;
  std::string CertaintyText(const ServoStep& step) const;
  std::string WhyTooLate(const ServoStep& step) const;
  bool Grows(const CycleInput& input, const ServoStep& step);
  std::optional<Verdict> JudgeStall(const CycleInput& input, const ServoStep& step);
  Vector6d CommandedWayAt(double time_s) const;
  bool IsOnItsWay() const;
  bool IsNoiseAlone(double mean_error, double error_noise) const;
  std::bitset<kLegCount> MostlyHeld(std::bitset<kLegCount> Moment::*held) const;
  Verdict WhyStalled(const ServoStep& step) const;
  std::string ErrorText(double error) const;

  ControlLawOptions law_;
  SupervisorOptions options_;
  Verdict last_;
  std::optional<double> start_s_, within_since_s_, unusable_since_s_, growing_since_s_;
  std::optional<CycleInput> before_;
  double readings_changed_s_ = 0, images_changed_s_ = 0;
  Vector6d way_since_readings_m_ = Vector6d::Zero();
  JointFollowing following_;
  struct CommandedWay {
    double time_s;
    Vector6d way_m;
  };
  std::deque<CommandedWay> ways_;  // of the last moments, as far back as readings and images may be old
  // Commanded before the first of readings and images that are the same was taken, and from there to the
  // newest.
  Vector6d answered_by_readings_m_ = Vector6d::Zero(), answered_by_images_m_ = Vector6d::Zero();
  Vector6d unanswered_by_readings_m_ = Vector6d::Zero();
  Vector6d unanswered_by_images_m_ = Vector6d::Zero();
  SeenEdges seen_at_readings_;  // when these last changed, and the readings when the images did
  Vector6d readings_at_images_m_ = Vector6d::Zero();
  Vector6d commanded_way_m_ = Vector6d::Zero();
  // By the edges behind them: other edges, other errors.
  std::unordered_map<std::bitset<2 * kLegCount>, double> smallest_errors_;
  int cycles_ = 0, waits_ = 0;
  std::string why_waited_;
  std::deque<Moment> recent_;
};

}  // namespace legible
