#include "calib/board/rough_start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vision/median.h"

namespace legible {
namespace {

constexpr double kFocalLengths[] = {0.35, 0.6, 1, 1.7, 3, 6, 12};  // 141 to 10 degrees across the diagonal
constexpr double kOutlierOfStart = 8;  // times the median error: takes no part in the first solve
constexpr double kUnexplained = 0.25;  // of the distance of neighbouring corners
constexpr int kSteps = 15;

// Distances of the corners from where the model has them, px; infinite for a view it cannot produce.
std::vector<double> DistancesOf(const Camera& camera, const BoardWarp& warp, ViewObservation view) {
  view.whitening_per_px.assign(view.pixels.size(), Eigen::Matrix2d::Identity());
  const auto errors = ViewErrors(camera, warp, view, Vector6d::Zero());
  std::vector<double> distances(view.pixels.size(), std::numeric_limits<double>::infinity());
  for (size_t k = 0; errors && k < distances.size(); ++k)
    distances[k] = errors->segment<2>(2 * static_cast<Eigen::Index>(k)).norm();
  return distances;
}

double MedianDistance(const BoardProblem& problem) {
  std::vector<double> all;
  for (const ViewObservation& view : problem.views) {
    const std::vector<double> distances = DistancesOf(problem.camera, problem.warp, view);
    all.insert(all.end(), distances.begin(), distances.end());
  }
  return MedianOf(all);
}

// Takes what is far off by the median's measure out of a problem that has only been started.
void LeaveOutGross(BoardProblem& problem) {
  for (ViewObservation& view : problem.views) {
    const std::vector<double> distances = DistancesOf(problem.camera, problem.warp, view);
    const double limit_px = kOutlierOfStart * MedianOf(distances);
    for (size_t k = 0; k < distances.size(); ++k) {
      const bool counts = std::isfinite(limit_px) && distances[k] <= limit_px;
      view.whitening_per_px[k] = (counts ? 1.0 : 0.0) * Eigen::Matrix2d::Identity();
    }
  }
}

// A solve that need not be good: a few views, a few steps, gross errors left out.
BoardProblem RoughlySolved(BoardProblem problem) {
  LeaveOutGross(problem);
  BoardSolveOptions solve;
  solve.max_iterations = kSteps;
  solve.relative_tolerance = 1e-4;
  SolveBoard(problem, solve);
  return problem;
}

// The problem with some of its views, and with their poses taken back.
BoardProblem With(const BoardProblem& all, const std::vector<size_t>& some) {
  BoardProblem few = all;
  few.views.clear();
  few.views.reserve(some.size());
  for (const size_t i : some) few.views.push_back(all.views[i]);
  return few;
}

}  // namespace

std::optional<BoardProblem> RoughStart(const StraightenedViews& straightened, LensModel lens, int width_px,
                                       int height_px, const std::vector<ViewObservation>& views,
                                       const std::vector<double>& more_focal_lengths,
                                       const std::function<void(double error_px)>& report) {
  std::vector<double> focal_lengths(std::begin(kFocalLengths), std::end(kFocalLengths));
  focal_lengths.insert(focal_lengths.end(), more_focal_lengths.begin(), more_focal_lengths.end());
  if (const auto zhang = FocalLengthOf(straightened)) focal_lengths.push_back(*zhang);
  const std::vector<size_t> some = ViewsWithMostCorners(views);
  std::optional<BoardProblem> best;  // of some views
  double least_px = std::numeric_limits<double>::infinity();
  for (const double focal_length : focal_lengths) {
    const BoardProblem few =
        RoughlySolved(With(ProblemAt(straightened, focal_length, lens, width_px, height_px, views), some));
    const double error_px = MedianDistance(few);
    report(error_px);
    if (!(error_px < least_px) || !(few.camera.fx_px > 0) || !(few.camera.fy_px > 0)) continue;
    least_px = error_px;
    best = few;
  }
  if (!best) return std::nullopt;
  // The other views' poses by their homographies under the focal length that was found.
  BoardProblem all =
      ProblemAt(straightened, best->camera.fx_px / straightened.unit_px, lens, width_px, height_px, views);
  all.camera = best->camera;
  for (size_t k = 0; k < some.size(); ++k) all.views[some[k]] = best->views[k];
  return RoughlySolved(all);
}

std::vector<size_t> UnexplainedViews(const BoardProblem& problem, bool trusts_all) {
  std::vector<size_t> unexplained;
  for (size_t i = 0; i < problem.views.size(); ++i) {
    const ViewObservation& view = problem.views[i];
    const double error_px = MedianOf(DistancesOf(problem.camera, problem.warp, view));
    const bool is_explained = trusts_all || error_px <= kUnexplained * NeighbourDistance_px(view);
    if (!std::isfinite(error_px) || !is_explained) unexplained.push_back(i);
  }
  return unexplained;
}

}  // namespace legible
