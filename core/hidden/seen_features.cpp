#include "core/hidden/seen_features.h"

#include <Eigen/Geometry>

namespace legible {
namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;

// Velocity of the start B of the seen segment; of a rail fixed in the platform that of the platform's point
// there, which differs from B's along the rail alone.
Matrix36 StartVelocity(const RobotLeg& leg, const LegState& state, const Rigid3& base_from_platform) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction == DirectionOf::kPlatform)
    return PlatformPointVelocity(state.start_m - leg.carried_offset_m - base_from_platform.translation);
  Matrix36 dc = PlatformPointVelocity(base_from_platform.rotation * leg.platform_joint_m);
  if (segment.direction == DirectionOf::kConstant) return dc;  // the rod carries C along itself alone
  if (segment.carrier == Carrier::kFixed) return Matrix36::Zero();
  const Eigen::Vector3d& t = state.free_direction;
  return t * (state.direction.transpose() * dc) / state.direction.dot(t);
}

}  // namespace

Eigen::Matrix<double, 3, 6> LineShift(const RobotLeg& leg, const LegState& state,
                                      const Rigid3& base_from_platform) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - state.direction * state.direction.transpose();
  return across * StartVelocity(leg, state, base_from_platform);
}

std::optional<Eigen::Matrix<double, Eigen::Dynamic, 6>> FeatureInteraction(const ParallelRobot& robot,
                                                                           const std::vector<int>& legs,
                                                                           const Rigid3& base_from_platform,
                                                                           SeenFeature feature) {
  const Eigen::Index rows_per_leg = feature == SeenFeature::kDirections ? 3 : 6;
  Eigen::Matrix<double, Eigen::Dynamic, 6> matrix(rows_per_leg * static_cast<Eigen::Index>(legs.size()), 6);
  for (size_t k = 0; k < legs.size(); ++k) {
    const RobotLeg& leg = robot.legs[static_cast<size_t>(legs[k])];
    const auto state = StateOf(leg, base_from_platform);
    if (!state) return std::nullopt;
    const Eigen::Index at = rows_per_leg * static_cast<Eigen::Index>(k);
    matrix.middleRows<3>(at) = DirectionInteraction(leg, *state, base_from_platform);
    if (feature == SeenFeature::kLines)
      matrix.middleRows<3>(at + 3) = LineShift(leg, *state, base_from_platform);
  }
  return matrix;
}

}  // namespace legible
