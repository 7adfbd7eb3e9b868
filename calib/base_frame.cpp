#include "calib/base_frame.h"

#include <Eigen/LU>

namespace legible {
namespace {

Eigen::Vector3d MeanOf(const LegPoints& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / kLegCount;
  return mean;
}

}  // namespace

BaseFrame FitBaseFrame(const LegPoints& base_joints_in_camera_m, const LegPoints& drawn_base_joints_m) {
  BaseFrame frame;
  frame.camera_from_base = FitRigid({drawn_base_joints_m.begin(), drawn_base_joints_m.end()},
                                    {base_joints_in_camera_m.begin(), base_joints_in_camera_m.end()});
  const Eigen::Matrix3d rotation = frame.camera_from_base.rotation.toRotationMatrix();
  const Eigen::Vector3d found_mean = MeanOf(base_joints_in_camera_m);
  const Eigen::Vector3d drawn_mean = rotation * MeanOf(drawn_base_joints_m);
  // The fit ends where sum drawn x found = 0, both about their means: its differential gives omega by A.
  Eigen::Matrix3d by_turn = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 18> by_joints, mean;
  for (size_t i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d found = base_joints_in_camera_m[i] - found_mean;
    const Eigen::Vector3d drawn = rotation * drawn_base_joints_m[i] - drawn_mean;
    by_turn += found.dot(drawn) * Eigen::Matrix3d::Identity() - drawn * found.transpose();
    by_joints.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = Skew(drawn);
    mean.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = Eigen::Matrix3d::Identity() / kLegCount;
  }
  const Eigen::Matrix<double, 3, 18> turn = by_turn.inverse() * by_joints;
  frame.d_joints << mean + Skew(drawn_mean) * turn, turn;
  return frame;
}

JointsInBase TakeToBase(const BaseFrame& frame, const LegPoints& base_joints_in_camera_m) {
  const Rigid3 base_from_camera = Inverse(frame.camera_from_base);
  const Eigen::Matrix3d rotation = base_from_camera.rotation.toRotationMatrix();
  JointsInBase result;
  for (int i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d& joint = base_joints_in_camera_m[static_cast<size_t>(i)];
    result.base_joints_m[static_cast<size_t>(i)] = base_from_camera * joint;
    Eigen::Matrix<double, 3, 18> moved = -frame.MotionOf(joint);
    moved.middleCols<3>(3 * i) += Eigen::Matrix3d::Identity();
    result.d_joints.middleRows<3>(3 * i) = rotation * moved;
  }
  return result;
}

}  // namespace legible
