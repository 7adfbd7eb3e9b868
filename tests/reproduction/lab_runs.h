// Servos of DeltaLab rigs with noise, friction and errors of the model, and what became of them.
#pragma once

#include <string>
#include <vector>

#include "servo/path_shape.h"
#include "tests/reproduction/lab_rigs.h"
#include "tests/testing/delta_lab.h"

namespace legible {

// What the law is told of its goal: an image that this camera took of the robot there, or the pose alone.
enum class GoalKind { kImage, kPose };

struct LabCase {
  ControlLawOptions law;
  GoalKind goal = GoalKind::kImage;
  double edge_noise_px = 0.3;
  double goal_noise_px = 0.3;  // in the image of the goal
  // A joint at rest moves when it is to go 2 mm/s, one that moves loses 1 mm/s, both times 0.5 to 1.5 with
  // the joint's length.
  bool has_friction = true;
  double unsupervised_s = 0;  // over 0: nothing ends the run but this time
};

// From all joints at 375 mm of the true robot, with drives that lag by 20 ms and readings to 1 um. The gain
// is adaptive, as in the paper "low at init, high near convergence": from about 1/s at the start to 4/s at
// the goal. A pose as goal is that of the drawing's readings, in the drawing's frames: the true goal is where
// the true robot's frames have the same.
LabServo RoughLabServo(const LabRig& rig, const SimulationTruth& model, const LabCase& lab_case,
                       std::uint64_t seed);

// How a run ended. Errors are of where the true robot came to rest, without noise.
struct LabOutcome {
  ServoEnd end = ServoEnd::kRunning;  // running: it was not even begun
  std::string reason;
  double time_s = 0;     // when it ended, and
  double settled_s = 0;  // since when the platform was within 5 % of its way from where it came to rest
  double edge_error_px = 0, direction_error_rad = 0;
  double position_m = 0, rotation_rad = 0;
  double deviation_share = 0;  // of the path of the platform's origin from a straight line, by its length
};
LabOutcome OutcomeOf(const LabServo& servo, const LabRun& run);

// Runs it, unless the goal is not fit for the law, as the program would say before it moves anything.
LabOutcome RunCase(const LabServo& servo);

}  // namespace legible
