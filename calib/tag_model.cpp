#include "calib/tag_model.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace legible {
namespace {

// L^-1 of covariance = L L^T.
Eigen::Matrix2d Whitening(const Eigen::Matrix2d& covariance) {
  return covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
}

}  // namespace

std::optional<TagResiduals> EvaluateTag(const Camera& camera, const TagPlacement& placement,
                                        const Vector6d& placement_displacement,
                                        const Rigid3& camera_from_platform, const Vector6d& pose_displacement,
                                        const TagObservation& observation) {
  TagResiduals result;
  for (size_t k = 0; k < observation.corners_px.size(); ++k) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(k);
    const MovedPoint in_parent =
        Move(placement.parent_from_group, placement_displacement, observation.corners_in_group_m[k]);
    Eigen::Vector3d corner_in_camera = in_parent.x_in_b;
    Eigen::Matrix<double, 3, 6> d_placement = in_parent.d_displacement, d_pose;
    d_pose.setZero();
    if (placement.carrier == TagCarrier::kPlatform) {
      const MovedPoint in_camera = Move(camera_from_platform, pose_displacement, in_parent.x_in_b);
      corner_in_camera = in_camera.x_in_b;
      d_placement = in_camera.d_x_in_a * in_parent.d_displacement;
      d_pose = in_camera.d_displacement;
    }
    if (!(corner_in_camera.z() > 0)) return std::nullopt;
    const ProjectedPoint projected = ProjectWithJacobians(camera, corner_in_camera);
    const Eigen::Matrix2d whitening = Whitening(observation.covariances_px2[k]) / observation.sigma_scale;
    result.error_px.segment<2>(row) = projected.pixel - observation.corners_px[k];
    result.residual.segment<2>(row) = whitening * result.error_px.segment<2>(row);
    result.d_camera.middleRows<2>(row) = whitening * projected.d_camera;
    result.d_placement.middleRows<2>(row) = whitening * projected.d_x * d_placement;
    result.d_pose.middleRows<2>(row) = whitening * projected.d_x * d_pose;
  }
  return result;
}

PlacementResiduals EvaluatePlacement(const TagPlacement& placement, const Vector6d& placement_displacement,
                                     const BaseFrame& base) {
  const bool on_base = placement.carrier == TagCarrier::kBase;
  const Rigid3 drawn = on_base ? base.camera_from_base * placement.drawn_carrier_from_group
                               : placement.drawn_carrier_from_group;
  const Rigid3 found = Displaced(placement.parent_from_group, placement_displacement);
  const Vector6d off = Displacement(drawn, found);
  const Eigen::Vector3d turn = off.tail<3>();
  PlacementResiduals result{off, Matrix6d::Zero(), Eigen::Matrix<double, 6, 18>::Zero()};
  // found = Exp(turn) drawn: what turns `found` acts from the left, what turns `drawn` from the right.
  result.d_placement.topLeftCorner<3, 3>().setIdentity();
  result.d_placement.bottomRightCorner<3, 3>() =
      LeftJacobian(turn).inverse() * LeftJacobian(placement_displacement.tail<3>());
  if (on_base) {
    result.d_base_joints << -base.MotionOf(drawn.translation),
        -LeftJacobian(-turn).inverse() * base.d_joints.bottomRows<3>();
  }
  Vector6d information;
  information << Eigen::Vector3d::Constant(1 / placement.translation_sigma_m),
      Eigen::Vector3d::Constant(1 / placement.rotation_sigma_rad);
  result.residual = information.asDiagonal() * result.residual;
  result.d_placement = information.asDiagonal() * result.d_placement;
  result.d_base_joints = information.asDiagonal() * result.d_base_joints;
  return result;
}

}  // namespace legible
