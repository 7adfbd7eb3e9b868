// What is seen of the legs and how it moves with the platform: directions alone, or the lines themselves, as
// edges show them (direction and position: the extension that Briot et al. 2016 leave open, section 4.3).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/robots/leg_state.h"
#include "core/robots/parallel_robot.h"

namespace legible {

enum class SeenFeature {
  kDirections,  // of each leg u: 3 rows, of rank 2, in a plane 1
  kLines,       // of each leg u, and where across u its line passes, m: 6 rows, of rank 4, in a plane 2
};

// d(features)/dt = matrix * twist, (v, omega) of the platform's origin in base: the rows of one leg after
// the other, dimensionless and m. Nothing where a leg does not reach the pose.
std::optional<Eigen::Matrix<double, Eigen::Dynamic, 6>> FeatureInteraction(const ParallelRobot& robot,
                                                                           const std::vector<int>& legs,
                                                                           const Rigid3& base_from_platform,
                                                                           SeenFeature feature);

// The velocity across u of the point of the leg's line that is at the start of its seen segment, 3 x 6: zero
// where the segment starts at a fixed joint.
Eigen::Matrix<double, 3, 6> LineShift(const RobotLeg& leg, const LegState& state,
                                      const Rigid3& base_from_platform);

}  // namespace legible
