#include "calib/board/board_information.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace legible {
namespace {

// The normal equations of one view: the shared unknowns (camera, then the warp where it is estimated) and its
// pose.
struct ViewEquations {
  Eigen::MatrixXd shared;                          // n x n
  Eigen::Matrix<double, Eigen::Dynamic, 6> cross;  // n x 6
  Matrix6d pose;
};

ViewEquations EquationsOf(const BoardProblem& problem, const ViewObservation& view) {
  const auto rows = EvaluateView(problem.camera, problem.warp, view, Vector6d::Zero());
  if (!rows) throw std::runtime_error("InformationOf: the model cannot be evaluated at its own solution");
  Eigen::MatrixXd shared(rows->residual.size(), problem.CameraUnknowns() + (problem.estimates_warp ? 2 : 0));
  shared.leftCols(problem.CameraUnknowns()) = rows->d_camera;
  if (problem.estimates_warp) shared.rightCols<2>() = rows->d_warp;
  return {shared.transpose() * shared, shared.transpose() * rows->d_pose,
          rows->d_pose.transpose() * rows->d_pose};
}

// A displacement (v, omega) of a transform with that translation as a motion about the camera's centre: the
// point x moves by v + omega x (x - t) = (v + t x omega) + omega x x.
Matrix6d MotionAboutCentre(const Eigen::Vector3d& translation) {
  Matrix6d motion = Matrix6d::Identity();
  motion.topRightCorner<3, 3>() = Skew(translation);
  return motion;
}

// Without the warp, which comes last.
Eigen::MatrixXd WithoutWarp(const Eigen::MatrixXd& information, Eigen::Index camera) {
  const Eigen::Index warp = information.rows() - camera;
  if (warp == 0) return information;
  const Eigen::MatrixXd cross = information.topRightCorner(camera, warp);
  return information.topLeftCorner(camera, camera) -
         cross * information.bottomRightCorner(warp, warp).ldlt().solve(cross.transpose());
}

}  // namespace

Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& information) {
  constexpr double kRounding = 1e-15;
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * information *
                                                              scale.asDiagonal());
  const double least = kRounding * solver.eigenvalues()[information.rows() - 1];
  const Eigen::MatrixXd vectors = scale.asDiagonal() * solver.eigenvectors();
  return vectors * solver.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() * vectors.transpose();
}

BoardInformation InformationOf(const BoardProblem& problem) {
  const Eigen::Index camera = problem.CameraUnknowns(), n = camera + (problem.estimates_warp ? 2 : 0);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n), follow = Eigen::MatrixXd::Zero(6, n);
  Matrix6d own = Matrix6d::Zero();
  for (const ViewObservation& view : problem.views) {
    const ViewEquations equations = EquationsOf(problem, view);
    const Eigen::LDLT<Matrix6d> pose(equations.pose);
    const Matrix6d motion = MotionAboutCentre(view.camera_from_board.translation);
    const Eigen::MatrixXd answer = pose.solve(equations.cross.transpose());  // pose = -answer shared
    information += equations.shared - equations.cross * answer;
    follow -= motion * answer;
    own += motion * pose.solve(motion.transpose());
  }
  const double count = static_cast<double>(problem.views.size());
  follow /= count;
  own /= count * count;

  BoardInformation result;
  result.information = WithoutWarp(information, camera);
  const Eigen::MatrixXd shared = CovarianceOf(information);
  result.covariance.resize(camera + 6, camera + 6);
  result.covariance.topLeftCorner(camera, camera) = shared.topLeftCorner(camera, camera);
  result.covariance.bottomLeftCorner(6, camera) = follow * shared.leftCols(camera);
  result.covariance.topRightCorner(camera, 6) = result.covariance.bottomLeftCorner(6, camera).transpose();
  result.covariance.bottomRightCorner<6, 6>() = follow * shared * follow.transpose() + own;
  return result;
}

Eigen::MatrixXd ViewInformation(const BoardProblem& problem, const ViewObservation& view) {
  const ViewEquations equations = EquationsOf(problem, view);
  const Eigen::MatrixXd information =
      equations.shared - equations.cross * equations.pose.ldlt().solve(equations.cross.transpose());
  return information.topLeftCorner(problem.CameraUnknowns(), problem.CameraUnknowns());
}

}  // namespace legible
