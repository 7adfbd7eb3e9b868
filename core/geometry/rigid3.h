// Rigid transforms and the few rotations that go with them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace legible {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The transform b_from_a: takes coordinates in frame a to coordinates in frame b.
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m

  Eigen::Vector3d operator*(const Eigen::Vector3d& x_in_a) const { return rotation * x_in_a + translation; }
};

// c_from_a = c_from_b * b_from_a.
Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a);

// a_from_b.
Rigid3 Inverse(const Rigid3& b_from_a);

// Matrix of the cross product: Skew(a) b = a x b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// Rotation by |rotation_vector| rad about the vector's direction; exact and smooth at zero.
Eigen::Quaterniond RotationFromVector(const Eigen::Vector3d& rotation_vector_rad);

// Inverse of RotationFromVector, of angle in [0, pi]; the quaternion's sign does not matter.
Eigen::Vector3d VectorFromRotation(const Eigen::Quaterniond& rotation);

// Left Jacobian of the rotation group: Exp(omega + d) = Exp(LeftJacobian(omega) d) Exp(omega) in first order
// of d. Its transpose, LeftJacobian(-omega), is the right one. Singular only at full turns.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& rotation_vector_rad);

// b_from_a moved by a small displacement (v, omega) expressed in b: rotation Exp(omega) R, translation t + v.
Rigid3 Displaced(const Rigid3& b_from_a, const Vector6d& displacement_in_b);

// A point of a taken to b by the displaced transform, with its derivatives by the point and by the
// displacement.
struct MovedPoint {
  Eigen::Vector3d x_in_b;
  Eigen::Matrix3d d_x_in_a;
  Eigen::Matrix<double, 3, 6> d_displacement;
};
MovedPoint Move(const Rigid3& b_from_a, const Vector6d& displacement_in_b, const Eigen::Vector3d& x_in_a);

// The displacement (v, omega) in b that takes `from` to `to`: to = Displaced(from, Displacement(from, to)).
Vector6d Displacement(const Rigid3& from, const Rigid3& to);

// The b_from_a that minimises sum |b_from_a * x_in_a - x_in_b|^2 (Umeyama 1991, without scale).
// Throws std::invalid_argument unless both hold the same number (3 or more) of finite points, not all on one
// line.
Rigid3 FitRigid(const std::vector<Eigen::Vector3d>& x_in_a, const std::vector<Eigen::Vector3d>& x_in_b);

}  // namespace legible
