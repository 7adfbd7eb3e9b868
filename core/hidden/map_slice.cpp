#include "core/hidden/map_slice.h"

#include <Eigen/Dense>
#include <numeric>

#include "core/robots/parallel_kinematics.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

constexpr double kOnCell = 1e-9;  // m, rad
constexpr int kMostSteps = 20;

// Of the rotation vector and the place, by the twist.
Matrix6d RatesByTwist(const Rigid3& base_from_platform) {
  Matrix6d rates = Matrix6d::Identity();
  rates.bottomRightCorner<3, 3>() = LeftJacobian(VectorFromRotation(base_from_platform.rotation)).inverse();
  return rates;
}

// From a pose that RPS legs allow along such poses, by Newton's method on the slice's two coordinates.
std::optional<Rigid3> MovedOntoCell(const ParallelRobot& robot, const std::array<int, 2>& axes,
                                    const Vector6d& coordinates, Rigid3 pose) {
  const double size_m = SizeOf_m(robot, robot.home);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d off = (coordinates - CoordinatesOf(pose))(axes);
    if (off.lpNorm<Eigen::Infinity>() < kOnCell) return pose;
    const Eigen::MatrixXd basis = MotionBasisInSize(robot, pose, size_m);
    const Eigen::MatrixXd rates = (RatesByTwist(pose) * basis)(axes, Eigen::all);
    pose = BackToMotion(robot, Displaced(pose, basis * rates.completeOrthogonalDecomposition().solve(off)));
  }
  return std::nullopt;
}

void AddCell(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
             const std::optional<Rigid3>& pose, SingularityMap& map) {
  map.type_2.push_back(pose ? Type2MeasureOf(robot, kind, legs, *pose) : std::nullopt);
  map.type_1.push_back(pose ? Type1MeasureOf(robot, legs, *pose) : std::nullopt);
}

}  // namespace

const char* ToString(CellState state) {
  switch (state) {
    case CellState::kFine:
      return "fine";
    case CellState::kOutsideJointRanges:
      return "outside-joint-ranges";
    case CellState::kOutOfReach:
      break;
  }
  return "out-of-reach";
}

Eigen::Matrix<double, 6, Eigen::Dynamic> CoordinateRates(const ParallelRobot& robot,
                                                         const Rigid3& base_from_platform) {
  const double size_m = SizeOf_m(robot, base_from_platform);
  Eigen::Matrix<double, 6, Eigen::Dynamic> rates =
      RatesByTwist(base_from_platform) * MotionBasisInSize(robot, base_from_platform, size_m);
  rates.topRows<3>() /= size_m;
  return rates;
}

std::optional<Rigid3> PoseOfCell(const ParallelRobot& robot, const PoseSlice& slice, Eigen::Index cell) {
  Vector6d coordinates = slice.held;
  coordinates[slice.axes[0]] = slice.first[cell % slice.first.size()];
  coordinates[slice.axes[1]] = slice.second[cell / slice.first.size()];
  std::optional<Rigid3> pose = PoseAt(coordinates);
  if (!LegsKeptInPlanes(robot).empty())
    pose = MovedOntoCell(robot, slice.axes, coordinates, BackToMotion(robot, *pose));
  if (pose && !CanTake(robot, *pose)) pose.reset();
  return pose;
}

CellState StateOfCell(const ParallelRobot& robot, const Rigid3& base_from_platform) {
  if (!CanTake(robot, base_from_platform)) return CellState::kOutOfReach;
  const auto readings = InverseKinematics(robot, base_from_platform);
  if (!readings) return CellState::kOutOfReach;
  return AreWithinJointRanges(robot, *readings) ? CellState::kFine : CellState::kOutsideJointRanges;
}

SliceMap MapSlice(const ParallelRobot& robot, const PoseSlice& slice,
                  const std::vector<std::vector<int>>& leg_sets, double half_angle_rad,
                  const std::function<void(int cells, int of)>& progress) {
  SliceMap map;
  map.slice = slice;
  for (const std::vector<int>& legs : leg_sets) map.sets.push_back({legs, {}, {}});
  std::vector<int> every(robot.legs.size());
  std::iota(every.begin(), every.end(), 0);
  for (Eigen::Index cell = 0; cell < slice.CellCount(); ++cell) {
    std::optional<Rigid3> pose = PoseOfCell(robot, slice, cell);
    map.states.push_back(pose ? StateOfCell(robot, *pose) : CellState::kOutOfReach);
    if (map.states.back() == CellState::kOutOfReach) pose.reset();
    AddCell(robot, RobotKind::kReal, every, pose, map.real);
    for (LegSetMap& set : map.sets) {
      AddCell(robot, RobotKind::kHidden, set.legs, pose, set.hidden);
      set.errors.push_back(pose ? LargestErrorByConeNoise(robot, set.legs, *pose, half_angle_rad)
                                : std::nullopt);
    }
    if (progress) progress(static_cast<int>(cell) + 1, static_cast<int>(slice.CellCount()));
  }
  return map;
}

}  // namespace legible
