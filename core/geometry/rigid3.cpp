#include "core/geometry/rigid3.h"

#include <Eigen/SVD>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace legible {
namespace {

// Below this angle (rad) the next term of the series of sin x / x and atan x / x is less than rounding.
constexpr double kSmallAngle = 1e-8;

Eigen::Vector3d Mean(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d sum = std::accumulate(points.begin(), points.end(), Eigen::Vector3d(0, 0, 0));
  return sum / static_cast<double>(points.size());
}

}  // namespace

Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation, c_from_b * b_from_a.translation};
}

Rigid3 Inverse(const Rigid3& b_from_a) {
  const Eigen::Quaterniond a_rotation_b = b_from_a.rotation.conjugate();
  return {a_rotation_b, -(a_rotation_b * b_from_a.translation)};
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d skew;
  skew << 0, -a.z(), a.y(),  //
      a.z(), 0, -a.x(),      //
      -a.y(), a.x(), 0;
  return skew;
}

Eigen::Quaterniond RotationFromVector(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  const double scale = angle < kSmallAngle ? 0.5 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(0.5 * angle);
  rotation.vec() = scale * rotation_vector_rad;
  return rotation;
}

Eigen::Vector3d VectorFromRotation(const Eigen::Quaterniond& rotation) {
  // q and -q are the same rotation; the one with w >= 0 turns by at most pi.
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double cosine = sign * rotation.w();
  const double sine = rotation.vec().norm();
  const double scale = sine < kSmallAngle * cosine ? 2 / cosine : 2 * std::atan2(sine, cosine) / sine;
  return sign * scale * rotation.vec();
}

Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle2 = rotation_vector_rad.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d skew = Skew(rotation_vector_rad);
  if (angle < 1e-5) return Eigen::Matrix3d::Identity() + skew / 2 + skew * skew / 6;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / angle2 * skew +
         (angle - std::sin(angle)) / (angle2 * angle) * skew * skew;
}

Rigid3 Displaced(const Rigid3& b_from_a, const Vector6d& displacement_in_b) {
  const Eigen::Quaterniond turn = RotationFromVector(displacement_in_b.tail<3>());
  return {(turn * b_from_a.rotation).normalized(), b_from_a.translation + displacement_in_b.head<3>()};
}

MovedPoint Move(const Rigid3& b_from_a, const Vector6d& displacement_in_b, const Eigen::Vector3d& x_in_a) {
  const Rigid3 moved = Displaced(b_from_a, displacement_in_b);
  const Eigen::Matrix3d rotation = moved.rotation.toRotationMatrix();
  const Eigen::Vector3d turned = rotation * x_in_a;
  MovedPoint result{turned + moved.translation, rotation, {}};
  // d(Exp(omega) x) = -[Exp(omega) x] Jl(omega) d omega.
  result.d_displacement << Eigen::Matrix3d::Identity(),
      -Skew(turned) * LeftJacobian(displacement_in_b.tail<3>());
  return result;
}

Vector6d Displacement(const Rigid3& from, const Rigid3& to) {
  Vector6d displacement;
  displacement << to.translation - from.translation,
      VectorFromRotation(to.rotation * from.rotation.conjugate());
  return displacement;
}

Rigid3 FitRigid(const std::vector<Eigen::Vector3d>& x_in_a, const std::vector<Eigen::Vector3d>& x_in_b) {
  if (x_in_a.size() != x_in_b.size() || x_in_a.size() < 3) {
    throw std::invalid_argument("FitRigid needs the same number of points, 3 or more, in both frames");
  }
  const Eigen::Vector3d mean_in_a = Mean(x_in_a);
  const Eigen::Vector3d mean_in_b = Mean(x_in_b);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < x_in_a.size(); ++i) {
    covariance += (x_in_b[i] - mean_in_b) * (x_in_a[i] - mean_in_a).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > 1e-12 * svd.singularValues()[0])) {
    throw std::invalid_argument("FitRigid needs finite points that do not lie on one line");
  }
  // The last sign keeps a reflection out, also where the points lie in a plane (Umeyama, eq. 39 and 43).
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant();
  const Eigen::Vector3d signs(1, 1, handedness < 0 ? -1 : 1);
  const Eigen::Matrix3d b_rotation_a = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return {Eigen::Quaterniond(b_rotation_a), mean_in_b - b_rotation_a * mean_in_a};
}

}  // namespace legible
