// Which legs to watch on the way from one pose to another (Briot et al. 2016, Appendix A.2): every set of
// legs is judged, what cannot work is discarded with its reason, the rest is ranked and the best one
// simulated.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/hidden/assembly_modes.h"
#include "core/hidden/cone_noise.h"
#include "core/hidden/controllability.h"
#include "core/hidden/path_certificate.h"
#include "servo/direction_simulation.h"

namespace legible {

// Of which every set is judged.
inline constexpr int kMostLegsToChooseFrom = 8;

struct LegSelectionOptions {
  std::vector<std::vector<int>> leg_sets;  // to judge, legs from 0; empty: every set
  double cone_half_angle_rad = 1e-3;       // by which each seen direction is off at most
  int path_samples = 33;                   // at which errors and visibility are looked at, ends included
  DirectionServoOptions servo;
  // Whether a leg (from 0) shows at a pose; empty: all do everywhere.
  std::function<bool(int leg, const Rigid3& base_from_platform)> is_visible;
};

enum class LegSetVerdict {
  kPossible,        // start and goal are proved to be in one aspect
  kArrives,         // that could not be proved, but the servo, simulated, ends at the goal
  kUndecided,       // that could not be proved, and the servo, simulated, ends elsewhere
  kInvisible,       // a leg does not show all the way
  kUncontrollable,  // the directions do not hold the platform anywhere
  kSingularGoal,    // not at the goal, though elsewhere
  kOtherAspect,     // proved: no path without a singularity
  kOutOfReach,      // a leg does not reach start, goal or the way between
  kMisled,          // in one aspect, but simulated it ends elsewhere
};
const char* ToString(LegSetVerdict verdict);

struct JudgedLegSet {
  std::vector<int> legs;  // from 0
  LegSetVerdict verdict = LegSetVerdict::kUndecided;
  std::string why;                  // in words, where not possible
  Controllability controllability;  // at the goal
  PathCertificate path;             // of the hidden robot, straight (straight_path.h) or as it was simulated
  bool is_path_simulated = false;   // the latter
  AssemblyModes modes;              // of the hidden robot at the goal
  // On the way that `path` certifies, at path_samples poses of a straight one, up to 200 of a simulated one;
  // where it certifies none on the straight one.
  std::optional<LargestPoseError> error_at_goal, error_on_path;
  std::optional<DirectionServoRun> simulated;  // where the verdict needed it, and of the best
};

// Whether the servo of the set is known to end at the goal: it is possible, or arrives.
bool LeadsToGoal(const JudgedLegSet& set);

struct LegSelection {
  PathCertificate robot_path;      // the real robot's, straight
  std::vector<JudgedLegSet> sets;  // by verdict, best first
  bool has_choice = false;         // the servo of the first one ends at the goal, simulated
};

// Ranked by a bound of a platform joint's displacement by cone noise (largest position plus largest rotation
// by the platform's radius) at the goal, then on the way. There is no choice where the robot itself is proved
// to have a singularity between start and goal. Throws std::invalid_argument for fewer than two path samples
// or more than kMostLegsToChooseFrom legs. `is_done(judged, of)` is told of progress.
LegSelection SelectLegs(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
                        const LegSelectionOptions& options,
                        const std::function<void(int judged, int of)>& progress = {});

}  // namespace legible
