#include "core/geometry/orientation.h"

#include <algorithm>
#include <cctype>

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
  if (HasFixedAxes(name_)) return matrix.eulerAngles(third, second, first).reverse();
  return matrix.eulerAngles(first, second, third);
}

}  // namespace legible
