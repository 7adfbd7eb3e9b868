#include "calib/board/view_cost.h"

#include <algorithm>

namespace legible {
namespace {

// Into a block of `width` columns, zero beyond those of `rows`.
void CopyRows(const ViewResiduals::Rows& rows, Eigen::Index width, double* to) {
  if (to == nullptr) return;
  Eigen::Map<ViewResiduals::Rows> block(to, rows.rows(), width);
  block.leftCols(rows.cols()) = rows;
  block.rightCols(width - rows.cols()).setZero();
}

}  // namespace

ViewCost::ViewCost(const BoardProblem& problem, const ViewObservation& view, int camera_block)
    : problem_(problem), view_(view), camera_block_(camera_block) {
  *mutable_parameter_block_sizes() = {camera_block, 6};
  if (problem.estimates_warp) mutable_parameter_block_sizes()->push_back(2);
  set_num_residuals(2 * static_cast<int>(view.pixels.size()));
}

bool ViewCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Camera camera = WithUnknowns(
      problem_.camera, Eigen::Map<const Eigen::VectorXd>(parameters[0], problem_.CameraUnknowns()));
  const Vector6d displacement = Eigen::Map<const Vector6d>(parameters[1]);
  BoardWarp warp = problem_.warp;
  if (problem_.estimates_warp) warp.bend_m = Eigen::Map<const Eigen::Vector2d>(parameters[2]);
  Eigen::Map<Eigen::VectorXd> to(residuals, num_residuals());
  if (jacobians == nullptr) {
    const auto errors = ViewErrors(camera, warp, view_, displacement);
    if (errors) to = *errors;
    return errors.has_value();
  }
  const auto found = EvaluateView(camera, warp, view_, displacement);
  if (!found) return false;
  to = found->residual;
  CopyRows(found->d_camera, camera_block_, jacobians[0]);
  CopyRows(found->d_pose, 6, jacobians[1]);
  if (problem_.estimates_warp) CopyRows(found->d_warp, 2, jacobians[2]);
  return true;
}

}  // namespace legible
