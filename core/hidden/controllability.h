// Whether a robot can be servoed by what is seen of some of its legs at all (Briot et al. 2016, sections 3.3,
// 4.1.1 and 4.3), and if not, why.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/hidden/seen_features.h"
#include "core/robots/parallel_robot.h"

namespace legible {

enum class ControllabilityStatus {
  kControllable,    // every motion of the platform moves what is seen
  kSingularPose,    // not here, but elsewhere: the pose is a Type 2 singularity of the hidden robot; or not
                    // here, and no pose around it is reached that would tell
  kUncontrollable,  // nowhere
  kUnreachable,     // a seen leg does not reach the pose
};
const char* ToString(ControllabilityStatus status);

struct Controllability {
  ControllabilityStatus status = ControllabilityStatus::kUnreachable;
  int freedoms = 0;       // of the platform
  int seen_freedoms = 0;  // rank of the interaction matrix on them
  // Motions that nothing seen tells of: unit columns (v, omega) of the platform's origin in base.
  Eigen::Matrix<double, 6, Eigen::Dynamic> unseen_twists;
  // Of a pose where it is not controllable: as few columns as these have at any pose around. Nothing where
  // none around is reached.
  std::optional<int> fewest_unseen_around;
  std::string why;  // in words, where it is not controllable
};

// At the pose; eight poses around it, moved by a tenth of the platform's distance from its base joints (fixed
// seed; by half as much after each that is not reached, down to 1e-5), tell a singular pose from a robot that
// cannot be controlled anywhere.
Controllability ControllabilityOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                  const Rigid3& base_from_platform, SeenFeature feature);

}  // namespace legible
