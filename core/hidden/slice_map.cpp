#include "core/hidden/slice_map.h"

#include <numeric>
#include <stdexcept>

namespace legible {
namespace {

void CheckAxes(const std::array<SliceAxis, 2>& axes) {
  for (const SliceAxis& axis : axes) {
    if (axis.coordinate < 0 || axis.coordinate > 5)
      throw std::invalid_argument("a pose has the coordinates 0 to 5");
    if (axis.count < 2) throw std::invalid_argument("an axis of a slice needs two values or more");
  }
  if (axes[0].coordinate == axes[1].coordinate)
    throw std::invalid_argument("the two axes of a slice are the same coordinate");
}

std::optional<SliceCell> CellAt(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& pose,
                                double cone_half_angle_rad) {
  std::vector<int> every(robot.legs.size());
  std::iota(every.begin(), every.end(), 0);
  const auto type1 = Type1MeasureOf(robot, every, pose);
  const auto hidden = Type2MeasureOf(robot, RobotKind::kHidden, legs, pose);
  const auto real = Type2MeasureOf(robot, RobotKind::kReal, every, pose);
  if (!type1 || !hidden || !real) return std::nullopt;
  return SliceCell{*type1, *hidden, *real, LargestErrorByConeNoise(robot, legs, pose, cone_half_angle_rad)};
}

}  // namespace

SliceMap MapSlice(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& base_from_platform,
                  const std::array<SliceAxis, 2>& axes, double cone_half_angle_rad) {
  CheckAxes(axes);
  SliceMap map{axes, {}};
  Vector6d coordinates;
  coordinates << base_from_platform.translation, VectorFromRotation(base_from_platform.rotation);
  for (int j = 0; j < axes[1].count; ++j)
    for (int i = 0; i < axes[0].count; ++i) {
      coordinates[axes[0].coordinate] = axes[0].At(i);
      coordinates[axes[1].coordinate] = axes[1].At(j);
      const Rigid3 pose{RotationFromVector(coordinates.tail<3>()), coordinates.head<3>()};
      map.cells.push_back(CellAt(robot, legs, pose, cone_half_angle_rad));
    }
  return map;
}

}  // namespace legible
