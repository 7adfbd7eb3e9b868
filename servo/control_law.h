// The control laws: how far each joint still has to go, as the edges, directions, pose or readings say.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <limits>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/vision/seen_edges.h"
#include "servo/pseudo_inverse.h"
#include "servo/servo_goal.h"
#include "servo/servo_model.h"

namespace legible {

enum class ControlMode {
  kEdges,       // edges in the image (Andreff, Dallej, Martinet 2007, eq. 17-41)
  kDirections,  // directions of the legs, from both edges of each (the same, section 3.1.1)
  kPose,        // the platform's pose
  kJoints,      // the joint readings
};
// "edges", "directions", "pose", "joints".
const char* ToString(ControlMode mode);

enum class PoseSource {
  kReadings,  // forward kinematics
  kEdges,     // the pose that fits the edges best
};

// Where the legs' directions in the interaction matrices come from.
enum class DirectionSource {
  kEdges,  // both edges of the leg, as in the paper; of a leg that shows one only, the model
  kModel,  // forward kinematics of the readings
};

struct ControlLawOptions {
  ControlMode mode = ControlMode::kEdges;
  PoseSource pose_source = PoseSource::kReadings;
  DirectionSource direction_source = DirectionSource::kModel;
  std::bitset<kLegCount> legs = std::bitset<kLegCount>().set();  // that are looked at
  bool is_weighted = true;  // by each edge's covariance; false: all alike, as in the paper
  PseudoInverseOptions inverse;
  // What is seen is no ground to move on where its noise leaves a motion of the platform less certain than
  // this (LawResult::motion_sigma_m over the platform's radius), or where
  double most_motion_sigma = 0.5;
  // smallest over largest singular value of what is seen (rotations by the platform's radius) are less.
  double least_conditioning = 3e-5;
  // The same of the robot's inverse Jacobian.
  double least_robot_conditioning = 0.01;

  void Check() const;  // throws std::invalid_argument
};

// Whether the law needs images at all.
bool LooksAtImages(const ControlLawOptions& options);

enum class LawStatus {
  kOk,
  kBadReadings,          // not numbers
  kNoPose,               // the readings belong to no pose near the last one
  kRobotSingular,        // closer to a singularity than least_robot_conditioning
  kTooFewEdges,          // fewer than six, or of fewer than three legs, that the goal has too
  kIllConditionedEdges,  // beyond most_motion_sigma or least_conditioning
  kNoPoseFromEdges,
};

struct LawInput {
  SeenEdges seen;
  Vector6d joint_readings_m = Vector6d::Zero();
  // How far the joints may have moved since these readings were true: ranges are kept either way.
  Vector6d way_since_readings_m = Vector6d::Zero();
  Rigid3 guess_base_from_platform;  // where forward kinematics starts
};

// What each law says; `error` and its noise are in the law's own unit (UnitOf).
struct LawResult {
  LawStatus status = LawStatus::kOk;
  // The joints' way to the goal, m: the commanded speeds are this times the gain. Zero unless kOk.
  Vector6d to_go_m = Vector6d::Zero();
  // Way that differs from it by d costs |metric d|^2 more: what a step that a limit forces aside trades by.
  Matrix6d metric = Matrix6d::Identity();
  double error = 0;  // root mean square of what is controlled
  // Of that, what noise alone leaves, by the covariances of the edges seen and (but for a pose) the goal's.
  double error_noise = 0;
  int legs = 0, edges = 0;  // that take part
  // Of the legs that are looked at and that the goal has: no edge is seen, or only one that the goal has too.
  std::bitset<kLegCount> unseen, half_seen;
  int rank = 0;
  Vector6d singular_values = Vector6d::Zero();  // of what is seen (or of the inverse Jacobian), descending
  // Standard deviation of the platform's motion that is told worst (rotations by the platform's radius), m,
  // by the noise of the edges seen in one image. NaN of a law that looks at none.
  double motion_sigma_m = std::numeric_limits<double>::quiet_NaN();
  double most_motion_sigma_m = 0;  // that is allowed
  double robot_conditioning = 0;   // smallest over largest singular value, rotations scaled
  Rigid3 base_from_platform;       // by the readings
  double edge_error_px = 0;        // rms over the ends of all edges that goal and image share; NaN: none
  double direction_error_rad = 0;  // rms over the legs; NaN: none

  double Conditioning() const { return singular_values[5] / singular_values[0]; }
};

// "px", "rad" or "m": of the error that a law controls. A pose's is its displacement, rotations by the
// platform's radius.
const char* UnitOf(ControlMode mode);

// Throws std::invalid_argument, in words for the user, where the goal does not say what the mode needs.
void DemandGoal(const ServoGoal& goal, const ControlLawOptions& options);

// Depends on nothing but what it is given. Allocates nothing, unless it fits a pose to edges.
LawResult EvaluateLaw(const ServoModel& model, const ServoGoal& goal, const LawInput& input,
                      const ControlLawOptions& options);

}  // namespace legible
