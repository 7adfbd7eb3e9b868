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
  DirectionServoOptions servo;
  // Whether a leg (from 0) shows at a pose; empty: all do everywhere.
  std::function<bool(int leg, const Rigid3& base_from_platform)> is_visible;
};

enum class LegSetVerdict {
  kPossible,        // the servo, simulated, ends at the goal, and its way is proved free of singularities
  kArrives,         // the latter could not be proved
  kMisled,          // in one aspect, but simulated it ends elsewhere: an aspect can have several modes
  kUndecided,       // that could not be proved, and the servo, simulated, ends elsewhere
  kOtherAspect,     // proved: no path without a singularity
  kInvisible,       // a leg does not show at start or goal or on the simulated way
  kOutOfReach,      // a leg of the robot does not reach these, or leaves its joint range
  kSingularGoal,    // the directions do not hold the platform at the goal, though elsewhere
  kUncontrollable,  // nor anywhere else
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
  // Nothing where the set is ruled out at start or goal; on the way at some 60 poses of the simulated one,
  // where that ends at the goal.
  std::optional<LargestPoseError> error_at_goal, error_on_path;
  std::optional<DirectionServoRun> simulated;  // where neither start nor goal nor the path rules the set out
};

// Whether the servo of the set, simulated, ends at the goal: it is possible, or arrives.
bool LeadsToGoal(const JudgedLegSet& set);

struct LegSelection {
  PathCertificate robot_path;      // the real robot's, straight
  std::vector<JudgedLegSet> sets;  // by verdict, best first
  bool has_choice = false;         // the first one leads to the goal, and so does the robot itself
};

// Ranked by a bound of a platform joint's displacement by cone noise (largest position plus largest rotation
// by the platform's radius) at the goal, then on the way. There is no choice where the robot itself is proved
// to have a singularity between start and goal. Throws std::invalid_argument where sets are not named of more
// than kMostLegsToChooseFrom legs. `progress` is told how many sets of how many are judged.
LegSelection SelectLegs(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
                        const LegSelectionOptions& options,
                        const std::function<void(int judged, int of)>& progress = {});

}  // namespace legible
