// Three numbers for an orientation: rotation vectors, and Euler angles by name.
#pragma once

#include <numbers>
#include <optional>
#include <string>

#include "core/geometry/rigid3.h"

namespace legible {

inline constexpr double kDegree_rad = std::numbers::pi / 180;

// How three numbers (rad) say a rotation. "rotation-vector": axis times angle. Three axis letters: angles
// about them in turn, of axes that move with the body in capitals ("ZYX": yaw, pitch, roll; R = Rz Ry Rx) and
// of fixed axes in small letters ("xyz", the same rotation with its numbers in reverse).
class OrientationConvention {
 public:
  OrientationConvention() = default;  // rotation vectors

  // Nothing for a name that is no convention: not three of x, y, z in one case, or a letter twice in a row.
  static std::optional<OrientationConvention> FromName(const std::string& name);

  const std::string& name() const { return name_; }
  bool IsRotationVector() const;
  std::string Description() const;  // in words, with the unit left open

  Eigen::Quaterniond ToRotation(const Eigen::Vector3d& coordinates_rad) const;
  Eigen::Vector3d FromRotation(const Eigen::Quaterniond& rotation) const;

 private:
  std::string name_ = "rotation-vector";
};

}  // namespace legible
