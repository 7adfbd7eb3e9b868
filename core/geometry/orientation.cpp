#include "core/geometry/orientation.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace legible {
namespace {

const char kRotationVector[] = "rotation-vector";

int AxisOf(char letter) { return std::tolower(letter) - 'x'; }

bool AreOfOneCase(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return c >= 'x' && c <= 'z'; }) ||
         std::all_of(name.begin(), name.end(), [](char c) { return c >= 'X' && c <= 'Z'; });
}

bool HasFixedAxes(const std::string& name) { return std::islower(name[0]) != 0; }

Eigen::Quaterniond About(int axis, double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::Unit(axis)));
}

// Angles about moving axes i, j, k with R = R_i R_j R_k, the middle one in [-pi/2, pi/2], or in [0, pi] where
// the first and the last axis are the same: small turns have small angles. In gimbal lock the third is 0.
Eigen::Vector3d MovingAngles(const Eigen::Matrix3d& r, int i, int j, int k) {
  constexpr double kLocked = 1e-12;
  const bool is_proper = i == k;
  const int other = 3 - i - j;                        // the axis that is neither i nor j
  const double sign = (j - i + 3) % 3 == 1 ? 1 : -1;  // of the permutation i, j, other
  Eigen::Vector3d angles;
  if (is_proper) {
    const double sine = std::hypot(r(j, i), r(other, i));
    angles[1] = std::atan2(sine, r(i, i));
    if (sine < kLocked) return {std::atan2(sign * r(other, j), r(j, j)), angles[1], 0};
    return {std::atan2(r(j, i), -sign * r(other, i)), angles[1], std::atan2(r(i, j), sign * r(i, other))};
  }
  const double cosine = std::hypot(r(i, i), r(i, j));
  angles[1] = std::atan2(sign * r(i, k), cosine);
  if (cosine < kLocked) return {std::atan2(sign * r(k, j), r(j, j)), angles[1], 0};
  return {std::atan2(-sign * r(j, k), r(k, k)), angles[1], std::atan2(-sign * r(i, j), r(i, i))};
}

}  // namespace

std::optional<OrientationConvention> OrientationConvention::FromName(const std::string& name) {
  const bool is_euler = name.size() == 3 && AreOfOneCase(name) && name[0] != name[1] && name[1] != name[2];
  if (name != kRotationVector && !is_euler) return std::nullopt;
  OrientationConvention convention;
  convention.name_ = name;
  return convention;
}

bool OrientationConvention::IsRotationVector() const { return name_ == kRotationVector; }

std::string OrientationConvention::Description() const {
  if (IsRotationVector()) return "rotation vector, axis times angle, of the platform in base";
  std::string axes;
  for (const char letter : name_)
    axes += (axes.empty() ? "" : ", then ") + std::string(1, static_cast<char>(std::tolower(letter)));
  return "Euler angles " + name_ + ": about " + axes +
         (HasFixedAxes(name_) ? ", axes fixed in base" : ", axes that turn with the platform");
}

Eigen::Quaterniond OrientationConvention::ToRotation(const Eigen::Vector3d& coordinates_rad) const {
  if (IsRotationVector()) return RotationFromVector(coordinates_rad);
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Quaterniond next = About(AxisOf(name_[static_cast<size_t>(i)]), coordinates_rad[i]);
    rotation = HasFixedAxes(name_) ? next * rotation : rotation * next;
  }
  return rotation;
}

Eigen::Vector3d OrientationConvention::FromRotation(const Eigen::Quaterniond& rotation) const {
  if (IsRotationVector()) return VectorFromRotation(rotation);
  const Eigen::Matrix3d matrix = rotation.toRotationMatrix();
  const int first = AxisOf(name_[0]), second = AxisOf(name_[1]), third = AxisOf(name_[2]);
  // Fixed axes a, b, c are moving axes c, b, a.
  if (HasFixedAxes(name_)) return MovingAngles(matrix, third, second, first).reverse();
  return MovingAngles(matrix, first, second, third);
}

}  // namespace legible
