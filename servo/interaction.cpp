#include "servo/interaction.h"

#include <Eigen/Geometry>

namespace legible {

Matrix6d CameraInverseJacobian(const ServoModel& model, const LegDirections& directions) {
  Matrix6d jacobian;
  for (int i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d u = directions.col(i);
    jacobian.row(i) << -u.transpose(),
        -model.base_joint_in_camera_m[static_cast<size_t>(i)].cross(u).transpose();
  }
  return jacobian;
}

Eigen::Matrix<double, 3, 6> DirectionInteraction(const Eigen::Vector3d& base_joint_in_camera_m,
                                                 const Eigen::Vector3d& direction, double length_m) {
  const Eigen::Matrix3d across = (direction * direction.transpose() - Eigen::Matrix3d::Identity()) / length_m;
  Eigen::Matrix<double, 3, 6> interaction;
  interaction << across, -across * Skew(base_joint_in_camera_m + length_m * direction);
  return interaction;
}

Eigen::Matrix3d EdgeByDirection(const Eigen::Vector3d& base_joint_in_camera_m,
                                const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d tangent = direction.cross(normal);
  const double turn = base_joint_in_camera_m.dot(direction) / base_joint_in_camera_m.dot(tangent);
  return (turn * tangent - direction) * normal.transpose();
}

ImageLine ToImage(const ServoModel& model, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d scaled = model.k_inverse_transposed * normal;
  const double size = scaled.norm();
  ImageLine image;
  image.line = scaled / size;
  image.d_normal =
      (model.k_inverse_transposed - image.line * (image.line.transpose() * model.k_inverse_transposed)) /
      size;
  return image;
}

}  // namespace legible
