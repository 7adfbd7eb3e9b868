#include "accuracy/three_point.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

#include "accuracy/conditioning.h"

namespace legible {
namespace {

constexpr double kOnOneLine = 1e-9;  // area of a triangle over the square of its longest side

struct Triangle {
  std::array<Eigen::Vector3d, 3> corners_m;
  Eigen::Vector3d normal;  // (second - first) x (third - first)

  Eigen::Vector3d Side(int corner) const { return corners_m[static_cast<size_t>(corner)] - corners_m[0]; }
  bool IsOnOneLine() const {
    const double longest2 =
        std::max({Side(1).squaredNorm(), Side(2).squaredNorm(), (Side(2) - Side(1)).squaredNorm()});
    return normal.norm() <= kOnOneLine * longest2;
  }
};

Triangle TriangleOf(const GoughStewart& robot, const Rigid3& base_from_platform,
                    const std::array<int, 3>& triplet) {
  Triangle triangle;
  for (size_t k = 0; k < 3; ++k)
    triangle.corners_m[k] =
        base_from_platform.rotation * robot.legs.at(static_cast<size_t>(triplet[k])).platform_joint_m;
  triangle.normal = triangle.Side(1).cross(triangle.Side(2));
  return triangle;
}

// The velocity of a point of the platform from those of the corners, 3 x 9. The point is corner 0 + s side 1
// + t side 2
// + h m, m the unit normal: dm = (I - m m^T) (d side 1 x side 2 + side 1 x d side 2) / |side 1 x side 2|.
Eigen::Matrix<double, 3, 9> VelocityByCorners(const Triangle& triangle, const Eigen::Vector3d& point_m) {
  const double length = triangle.normal.norm();
  const Eigen::Vector3d m = triangle.normal / length;
  Eigen::Matrix3d frame;
  frame << triangle.Side(1), triangle.Side(2), m;
  const Eigen::Vector3d coordinates = frame.inverse() * (point_m - triangle.corners_m[0]);
  const Eigen::Matrix3d turn = coordinates.z() / length * (Eigen::Matrix3d::Identity() - m * m.transpose());
  const Eigen::Matrix3d by_side_1 =
      coordinates.x() * Eigen::Matrix3d::Identity() - turn * Skew(triangle.Side(2));
  const Eigen::Matrix3d by_side_2 =
      coordinates.y() * Eigen::Matrix3d::Identity() + turn * Skew(triangle.Side(1));
  Eigen::Matrix<double, 3, 9> velocity;
  velocity << Eigen::Matrix3d::Identity() - by_side_1 - by_side_2, by_side_1, by_side_2;
  return velocity;
}

void Widen(double value, bool is_first, ThreePointRange& range) {
  range.least = is_first ? value : std::min(range.least, value);
  range.largest = is_first ? value : std::max(range.largest, value);
}

}  // namespace

Eigen::Matrix<double, kLegCount, 9> ThreePointJacobian(const GoughStewart& robot,
                                                       const Rigid3& base_from_platform,
                                                       const std::array<int, 3>& triplet) {
  const Triangle triangle = TriangleOf(robot, base_from_platform, triplet);
  if (triangle.IsOnOneLine())
    throw std::invalid_argument("ThreePointJacobian: the three points lie on one line");
  const Matrix6d inverse_jacobian = InverseJacobian(robot, base_from_platform);
  Eigen::Matrix<double, kLegCount, 9> jacobian;
  for (int i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d arm_m =
        base_from_platform.rotation * robot.legs[static_cast<size_t>(i)].platform_joint_m;
    jacobian.row(i) = inverse_jacobian.row(i).head<3>() * VelocityByCorners(triangle, arm_m);
  }
  return jacobian;
}

ThreePointConditions ThreePointConditionsOf(const GoughStewart& robot, const Rigid3& base_from_platform) {
  ThreePointConditions conditions;
  for (int i = 0; i < kLegCount; ++i)
    for (int j = i + 1; j < kLegCount; ++j)
      for (int k = j + 1; k < kLegCount; ++k) {
        if (TriangleOf(robot, base_from_platform, {i, j, k}).IsOnOneLine()) continue;
        const ConditionNumbers numbers =
            ConditionNumbersOf(ThreePointJacobian(robot, base_from_platform, {i, j, k}));
        const bool is_first = conditions.triplets++ == 0;
        Widen(numbers.two, is_first, conditions.two);
        Widen(numbers.frobenius, is_first, conditions.frobenius);
        Widen(numbers.frobenius_of_gram, is_first, conditions.frobenius_of_gram);
      }
  return conditions;
}

}  // namespace legible
