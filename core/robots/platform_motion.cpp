#include "core/robots/platform_motion.h"

#include <Eigen/Dense>

#include "core/robots/leg_geometry.h"

namespace legible {
namespace {

constexpr double kOnPlane_m = 1e-15;
constexpr int kMostSteps = 10;

// What RPS legs forbid: C keeps to the plane through A across the axis of R.
struct SidewaysConstraints {
  Eigen::Matrix<double, Eigen::Dynamic, 6> rows;  // of the distances' rates, by the twist
  Eigen::VectorXd distance_m;
};

SidewaysConstraints SidewaysConstraintsOf(const ParallelRobot& robot, const Rigid3& base_from_platform) {
  const auto legs = LegsKeptInPlanes(robot);
  SidewaysConstraints constraints{{legs.size(), 6}, Eigen::VectorXd(legs.size())};
  for (size_t k = 0; k < legs.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const RobotLeg& leg = *legs[k];
    constraints.rows.row(row) =
        leg_geometry::SidewaysLine<double>(leg, base_from_platform.rotation * leg.platform_joint_m);
    constraints.distance_m[row] =
        leg.first_axis.dot(base_from_platform * leg.platform_joint_m - leg.base_joint_m);
  }
  return constraints;
}

}  // namespace

std::vector<int> FreeCoordinates(PlatformMotion motion) {
  switch (motion) {
    case PlatformMotion::kPlanarPoint:
      return {0, 1};
    case PlatformMotion::kPlanar:
      return {0, 1, 5};
    case PlatformMotion::kTranslation:
      return {0, 1, 2};
    case PlatformMotion::kSchoenflies:
      return {0, 1, 2, 5};
    case PlatformMotion::kSpatial:
      break;
  }
  return {0, 1, 2, 3, 4, 5};
}

std::vector<const RobotLeg*> LegsKeptInPlanes(const ParallelRobot& robot) {
  std::vector<const RobotLeg*> legs;
  for (const RobotLeg& leg : robot.legs)
    if (robot.motion == PlatformMotion::kSpatial && leg.chain.front().type == JointType::kRevolute &&
        SeenSegmentOf(leg.chain).carrier == Carrier::kFixed)
      legs.push_back(&leg);
  return legs;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasis(const ParallelRobot& robot,
                                                     const Rigid3& base_from_platform) {
  const std::vector<int> free = FreeCoordinates(robot.motion);
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis = Matrix6d(Matrix6d::Identity())(Eigen::all, free);
  const auto constraints = SidewaysConstraintsOf(robot, base_from_platform);
  if (constraints.distance_m.size() == 0) return basis;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(constraints.rows, Eigen::ComputeFullV);
  return svd.matrixV().rightCols(6 - svd.rank());
}

Eigen::Matrix<double, 6, Eigen::Dynamic> MotionBasisInSize(const ParallelRobot& robot,
                                                           const Rigid3& base_from_platform, double size_m) {
  Eigen::MatrixXd basis = MotionBasis(robot, base_from_platform);
  basis.topRows<3>() /= size_m;
  basis = basis.householderQr().householderQ() * Eigen::MatrixXd::Identity(6, basis.cols());
  basis.topRows<3>() *= size_m;
  return basis;
}

bool CanTake(const ParallelRobot& robot, const Rigid3& base_from_platform, double tolerance) {
  Vector6d left_out = Displacement(robot.home, base_from_platform);
  for (const int coordinate : FreeCoordinates(robot.motion)) left_out[coordinate] = 0;
  return left_out.lpNorm<Eigen::Infinity>() < tolerance &&
         !(SidewaysConstraintsOf(robot, base_from_platform).distance_m.lpNorm<Eigen::Infinity>() > tolerance);
}

Rigid3 BackToMotion(const ParallelRobot& robot, const Rigid3& base_from_platform) {
  Rigid3 pose = base_from_platform;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto constraints = SidewaysConstraintsOf(robot, pose);
    if (!(constraints.distance_m.lpNorm<Eigen::Infinity>() > kOnPlane_m)) break;
    const Eigen::MatrixXd rows = constraints.rows;
    pose = Displaced(pose, -rows.completeOrthogonalDecomposition().solve(constraints.distance_m));
  }
  return pose;
}

}  // namespace legible
