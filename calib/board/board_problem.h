// The least-squares problem of a camera before a flat board: unknowns, observations, their residuals with
// derivatives; free of any solver.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/camera_parameters.h"
#include "core/geometry/rigid3.h"
#include "core/session/board.h"

namespace legible {

// How far a board that is nearly flat stands out of its plane: with (u, v) in [-1, 1] across the board,
// z = bend_m[0] (1 - u^2) + bend_m[1] (1 - v^2), in the direction of the board's z axis.
struct BoardWarp {
  Eigen::Vector2d bend_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero(), half_size_m = Eigen::Vector2d::Ones();

  // A point's (u, v).
  Eigen::Vector2d Across(const Eigen::Vector3d& x_in_board) const {
    return (x_in_board.head<2>() - centre_m).cwiseQuotient(half_size_m);
  }
  // By how much each bend moves a point of the board along z.
  Eigen::RowVector2d ShapeAt(const Eigen::Vector3d& x_in_board) const;
};
// No bend, laid out over these points.
BoardWarp FlatOver(const std::vector<Eigen::Vector3d>& points_in_board_m);

// One view: its pose, and the corners that it shows.
struct ViewObservation {
  Rigid3 camera_from_board;
  std::vector<Eigen::Vector3d> points_in_board_m;
  std::vector<Eigen::Vector2d> pixels;
  // Of each corner, what takes a residual in px to one in sigmas; zero where it does not count.
  std::vector<Eigen::Matrix2d> whitening_per_px;
};

struct BoardProblem {
  Camera camera;
  std::vector<ViewObservation> views;
  BoardWarp warp;
  bool estimates_warp = false;
  double mean_square =
      1;  // of a whitened residual at the solution: below 1 where all of them are weighed down

  // Of the camera: four, and its lens' coefficients.
  int CameraUnknowns() const { return 4 + static_cast<int>(camera.lens); }
};

// Whitened residuals of a view, predicted less observed, x and y of one corner after the other.
struct ViewResiduals {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::VectorXd residual;
  Rows d_camera;  // CameraUnknowns() columns
  Rows d_pose;    // 6: displacement (v, omega) in the camera frame
  Rows d_warp;    // 2
};

// At the view's pose moved by `displacement`, with the camera and the warp as given. Nothing where a corner
// that counts lies behind the camera.
std::optional<ViewResiduals> EvaluateView(const Camera& camera, const BoardWarp& warp,
                                          const ViewObservation& view, const Vector6d& displacement);
// The residuals alone.
std::optional<Eigen::VectorXd> ViewErrors(const Camera& camera, const BoardWarp& warp,
                                          const ViewObservation& view, const Vector6d& displacement);

// Minimises the sum of squares from where the problem stands (Levenberg-Marquardt, the views' poses
// eliminated by Schur's complement) and leaves the result in it.
struct BoardSolveOptions {
  int max_iterations = 100;
  double relative_tolerance = 1e-10;  // of the cost
  int threads = 1;
  std::function<void(int iteration, double cost)> progress = {};
};
struct BoardSolveSummary {
  bool converged = false;
  int iterations = 0;
  double cost = 0;  // half the sum of squares
};
BoardSolveSummary SolveBoard(BoardProblem& problem, const BoardSolveOptions& options);

// The first CameraUnknowns() of a camera's parameters; and the camera with these.
Eigen::VectorXd UnknownsOf(const Camera& camera);
Camera WithUnknowns(const Camera& camera, const Eigen::VectorXd& unknowns);

}  // namespace legible
