#include "apps/intrinsics_run.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "apps/intrinsics_layout.h"
#include "calib/board/layout_check.h"
#include "calib/board/neighbour_scatter.h"
#include "core/vision/median.h"
#include "datasets/camera_file.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr int kMapColumns = 32, kMapRows = 24;
constexpr int kCoverageColumns = 12, kCoverageRows = 9;
constexpr int kCoarseColumns = 12, kCoarseRows = 9;  // where each place costs a sum over candidates

Camera GuessOf(const IntrinsicsSettings& settings, const BoardCalibrationInput& input) {
  if (settings.guessed_focal_length_px) {
    const double focal_px = *settings.guessed_focal_length_px;
    return {input.width_px,
            input.height_px,
            focal_px,
            focal_px,
            0.5 * (input.width_px - 1),
            0.5 * (input.height_px - 1),
            settings.lens,
            Distortion::Zero()};
  }
  Camera camera = ReadCamera(*settings.guess).camera;
  if (camera.width_px != input.width_px || camera.height_px != input.height_px)
    throw InputError(*settings.guess, 0,
                     fmt::format("is a camera of {} x {} px, and the images have {} x {}", camera.width_px,
                                 camera.height_px, input.width_px, input.height_px),
                     "leave --guess out, for none is needed, or give one of this camera");
  return camera;
}

// A ratio of size and distances that is wrong by little leaves an estimate, but a wrong one.
void DemandTagSize(const IntrinsicsRun& run) {
  constexpr double kTolerance = 0.015;
  if (!run.board.tags) return;
  const auto factor = TagSizeFactor(*run.board.tags, run.input);
  if (!factor || std::abs(*factor - 1) <= kTolerance) return;
  throw InputError(
      run.settings.board, 0,
      fmt::format("has tags of a size that the images contradict: they are {:.3f} times as large, "
                  "against their distances",
                  *factor),
      "measure the black square and the space between two, and mend the file");
}

double MedianDistance_m(const BoardCalibration& result) {
  std::vector<double> distances;
  for (const ViewFit& view : result.views)
    if (view.left_out.empty()) distances.push_back(view.camera_from_board.translation.norm());
  return MedianOf(distances);
}

// What the images show to be wrong is bad input, not a computation that failed.
void DemandNoContradiction(const IntrinsicsRun& run) {
  if (run.result.status == BoardCalibrationStatus::kNotFlat)
    throw InputError(run.settings.board, 0, "does not describe the board in the images",
                     WhyNotFlat(run.board, run.input));
  DemandTagSize(run);
  if (run.result.status == BoardCalibrationStatus::kHopelessGuess)
    throw InputError(*run.settings.guess, 0, "is no start for these images: " + run.result.message,
                     "leave --guess out, for none is needed, or mend it");
}

std::vector<UncertaintyMap> MapsOf(const IntrinsicsRun& run) {
  std::vector<double> distances_m = run.settings.distances_m;
  if (distances_m.empty())
    distances_m = {run.board_distance_m, 3 * run.board_distance_m, std::numeric_limits<double>::infinity()};
  std::vector<UncertaintyMap> maps;
  maps.reserve(distances_m.size());
  for (const double distance_m : distances_m)
    maps.push_back(
        PixelUncertainty(run.result.camera, run.result.information, {kMapColumns, kMapRows, distance_m}));
  return maps;
}

ImageGrid CoarseGrid(const IntrinsicsRun& run) { return {kCoarseColumns, kCoarseRows, run.board_distance_m}; }

}  // namespace

std::optional<double> IntrinsicsRun::NeighbourSigma_px() const {
  if (!neighbour_scatter) return std::nullopt;
  return result.corner_sigma_px * *neighbour_scatter / result.noise_factor;
}

void Calibrate(IntrinsicsRun& run, ProgressLine& progress) {
  run.options.lens = run.settings.lens;
  run.options.estimates_warp = run.settings.board_fit.estimates_warp;
  run.options.trusts_all = run.settings.board_fit.trusts_all;
  run.options.threads = run.settings.threads;
  if (run.settings.guess) run.options.guess = GuessOf(run.settings, run.input);
  run.options.progress = [&progress](const std::string& stage, int iteration, double rms_px) {
    progress.Show(iteration == 0 ? stage : IterationText(iteration, rms_px));
  };
  run.result = CalibrateCamera(run.input, run.options);
  if (run.result.status != BoardCalibrationStatus::kTooFewViews) DemandWholeBoard(run);
  DemandNoContradiction(run);
  if (run.result.status != BoardCalibrationStatus::kConverged) return;
  progress.Show("comparing two halves of the views");
  run.board_distance_m = MedianDistance_m(run.result);
  run.halves = CompareHalves(run.input, run.result, run.options, CoarseGrid(run));
  run.result = Widened(std::move(run.result), run.halves.Widening());
  run.neighbour_scatter = NeighbourScatter(run.input, run.result, run.settings.board_fit.trusts_all);
  run.coverage = CoverageOf(run.input, run.result, kCoverageColumns, kCoverageRows);
}

void WorkOutUncertainty(IntrinsicsRun& run, ProgressLine& progress) {
  run.maps = MapsOf(run);
  progress.Show("looking for the view to add next");
  run.next_view = ProposeView(run.input, run.result, {CoarseGrid(run), run.board.chessboard.has_value()});
}

}  // namespace legible
