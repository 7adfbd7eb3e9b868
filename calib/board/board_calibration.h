// A camera's intrinsics from views of a calibration board.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calib/board/board_information.h"
#include "calib/board/board_problem.h"
#include "core/session/board.h"

namespace legible {

// A view with fewer corners has no part: four fix its pose and leave nothing to check.
inline constexpr int kFewestViewCorners = 6;

struct BoardCalibrationInput {
  std::vector<Eigen::Vector3d> points_in_board_m;  // PointsOf(board)
  std::vector<BoardView> views;                    // all of one image size
  int width_px = 0, height_px = 0;
};

struct BoardCalibrationOptions {
  LensModel lens = LensModel::kBrownConrady;
  bool estimates_warp = false;       // the board is bent a little, see BoardWarp
  bool trusts_all = false;           // every corner counts whole, however far off
  std::optional<Camera> guess = {};  // where to start; without it from the views alone
  int max_iterations = 100;          // a solve
  int threads = 1;
  std::function<void(const std::string& stage, int iteration, double rms_px)> progress = {};

  void Check() const;  // throws std::invalid_argument
};

enum class BoardCalibrationStatus {
  kConverged,
  kTooFewViews,    // or corners
  kNotFlat,        // the corners are not where the board has them
  kUndetermined,   // the views leave the camera open
  kHopelessGuess,  // it leads to another camera than the views do
  kNotConverged,
};
const char* ToString(BoardCalibrationStatus status);

// What became of one view.
struct ViewFit {
  std::string left_out;                      // why it has no part; empty: it has
  Rigid3 camera_from_board;                  // where it has a part
  std::vector<Eigen::Vector2d> residual_px;  // predicted less observed, of each corner
  std::vector<double> weight;                // of each corner, [0, 1]; 0: left out as an outlier
  double rms_px = 0;                         // of the corners' distances, weighted
};

struct BoardCalibration {
  BoardCalibrationStatus status = BoardCalibrationStatus::kNotConverged;
  std::string message;  // why there is no camera; empty with kConverged
  Camera camera;
  BoardWarp warp;
  std::vector<ViewFit> views;  // of the input
  double rms_px = 0;           // of the corners' distances in the plane, weighted
  double noise_factor = 1;   // by which the corners' own sigmas are too small; their sigma where that is 1 px
  double corners = 0;        // that count, weighted
  int corners_left_out = 0;  // weight 0
  int iterations = 0;
  double seconds = 0;
  double corner_sigma_px =
      0;                   // of one coordinate of a corner, rms over them: their own sigmas and the factor
  int distinct_views = 0;  // that show the board in different places
  BoardInformation information;  // where converged: in the units of the noise that the residuals show
  double widening = 1;           // by which all sigmas are larger than the residuals show; see Widened
};

BoardCalibration CalibrateCamera(const BoardCalibrationInput& input, const BoardCalibrationOptions& options);

// The same from an earlier solution of these or other views: no start is looked for.
BoardCalibration RefineCamera(const BoardCalibrationInput& input, const BoardCalibration& from,
                              const BoardCalibrationOptions& options);

// With all sigmas larger by that factor: the information is its square smaller, that of SolvedProblem too.
BoardCalibration Widened(BoardCalibration calibration, double factor);

// The calibration's views that have a part, with the weights, the noise and the widening that it came to: the
// least-squares problem of which it is the solution, for solving together with other observations of the same
// camera.
BoardProblem SolvedProblem(const BoardCalibrationInput& input, const BoardCalibration& calibration,
                           const BoardCalibrationOptions& options);

}  // namespace legible
