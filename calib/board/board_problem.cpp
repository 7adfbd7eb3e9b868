#include "calib/board/board_problem.h"

#include <Eigen/Geometry>

namespace legible {
namespace {

// What all points of a view share: the displaced pose, and how a rotation of it enters.
struct ViewPose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  Eigen::Matrix3d left_jacobian;

  ViewPose(const Rigid3& camera_from_board, const Vector6d& displacement)
      : left_jacobian(LeftJacobian(displacement.tail<3>())) {
    const Rigid3 displaced = Displaced(camera_from_board, displacement);
    rotation = displaced.rotation.toRotationMatrix();
    translation = displaced.translation;
  }
};

Eigen::Vector3d Warped(const BoardWarp& warp, const Eigen::Vector3d& x_in_board) {
  return x_in_board + Eigen::Vector3d(0, 0, warp.ShapeAt(x_in_board).dot(warp.bend_m));
}

bool Counts(const ViewObservation& view, size_t corner) { return !view.whitening_per_px[corner].isZero(0); }

}  // namespace

Eigen::RowVector2d BoardWarp::ShapeAt(const Eigen::Vector3d& x_in_board) const {
  return (1 - Across(x_in_board).array().square()).matrix().transpose();
}

BoardWarp FlatOver(const std::vector<Eigen::Vector3d>& points_in_board_m) {
  Eigen::Vector2d low = points_in_board_m.front().head<2>(), high = low;
  for (const Eigen::Vector3d& point : points_in_board_m) {
    low = low.cwiseMin(point.head<2>());
    high = high.cwiseMax(point.head<2>());
  }
  return {Eigen::Vector2d::Zero(), (low + high) / 2, (high - low) / 2};
}

std::optional<ViewResiduals> EvaluateView(const Camera& camera, const BoardWarp& warp,
                                          const ViewObservation& view, const Vector6d& displacement) {
  const ViewPose pose(view.camera_from_board, displacement);
  const Eigen::Index rows = 2 * static_cast<Eigen::Index>(view.pixels.size());
  const Eigen::Index unknowns = 4 + static_cast<Eigen::Index>(camera.lens);
  ViewResiduals result{Eigen::VectorXd(rows), ViewResiduals::Rows(rows, unknowns),
                       ViewResiduals::Rows(rows, 6), ViewResiduals::Rows(rows, 2)};
  for (size_t k = 0; k < view.pixels.size(); ++k) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(k);
    const Eigen::Vector3d& x_in_board = view.points_in_board_m[k];
    const Eigen::Vector3d turned = pose.rotation * Warped(warp, x_in_board);
    const Eigen::Vector3d x_in_camera = turned + pose.translation;
    if (!Counts(view, k)) {
      result.residual.segment<2>(row).setZero();
      result.d_camera.middleRows<2>(row).setZero();
      result.d_pose.middleRows<2>(row).setZero();
      result.d_warp.middleRows<2>(row).setZero();
      continue;
    }
    if (!(x_in_camera.z() > 0)) return std::nullopt;
    const ProjectedPoint projected = ProjectWithJacobians(camera, x_in_camera);
    const Eigen::Matrix2d& whitening = view.whitening_per_px[k];
    const Eigen::Matrix<double, 2, 3> d_x = whitening * projected.d_x;
    result.residual.segment<2>(row) = whitening * (projected.pixel - view.pixels[k]);
    result.d_camera.middleRows<2>(row) = whitening * projected.d_camera.leftCols(unknowns);
    result.d_pose.middleRows<2>(row) << d_x, -d_x * Skew(turned) * pose.left_jacobian;
    result.d_warp.middleRows<2>(row) = d_x * pose.rotation.col(2) * warp.ShapeAt(x_in_board);
  }
  return result;
}

std::optional<Eigen::VectorXd> ViewErrors(const Camera& camera, const BoardWarp& warp,
                                          const ViewObservation& view, const Vector6d& displacement) {
  const ViewPose pose(view.camera_from_board, displacement);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(view.pixels.size()));
  for (size_t k = 0; k < view.pixels.size(); ++k) {
    if (!Counts(view, k)) continue;
    const Eigen::Vector3d x_in_camera =
        pose.rotation * Warped(warp, view.points_in_board_m[k]) + pose.translation;
    if (!(x_in_camera.z() > 0)) return std::nullopt;
    errors.segment<2>(2 * static_cast<Eigen::Index>(k)) =
        view.whitening_per_px[k] * (Project(camera, x_in_camera) - view.pixels[k]);
  }
  return errors;
}

Eigen::VectorXd UnknownsOf(const Camera& camera) {
  return ParametersOf(camera).head(4 + static_cast<Eigen::Index>(camera.lens));
}

Camera WithUnknowns(const Camera& camera, const Eigen::VectorXd& unknowns) {
  CameraParameters parameters = CameraParameters::Zero();
  parameters.head(unknowns.size()) = unknowns;
  return WithParameters(camera, parameters);
}

}  // namespace legible
