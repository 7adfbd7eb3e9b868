#include "apps/intrinsics_judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/calibrate_settings.h"
#include "apps/wording.h"

namespace legible {
namespace {

constexpr int kFewViews = 10;
constexpr double kLittleCoverage = 0.6;
constexpr double kLittleTilt_rad = 0.35;
constexpr double kManyLeftOut = 0.05;   // of the corners: more is no accident
constexpr double kSmoothMisfit = 1.25;  // of the corners' noise over that among neighbours

double Degrees(double angle_rad) { return angle_rad * 180 / std::numbers::pi; }

// Which part of the image, of thirds: "in the lower left".
std::string PlaceText(const Eigen::Vector2d& pixel, const Camera& camera) {
  const char* const rows[] = {"upper", "middle", "lower"};
  const char* const columns[] = {"left", "middle", "right"};
  const int row = std::clamp(static_cast<int>(3 * pixel.y() / camera.height_px), 0, 2);
  const int column = std::clamp(static_cast<int>(3 * pixel.x() / camera.width_px), 0, 2);
  if (row == 1 && column == 1) return "in the middle of the image";
  if (row == 1) return fmt::format("at the {} of the image", columns[column]);
  if (column == 1) return row == 0 ? "at the top of the image" : "at the bottom of the image";
  return fmt::format("in the {} {} of the image", rows[row], columns[column]);
}

// Which side of the board is farther away: "its lower right".
std::string SideText(double direction_rad) {
  const char* const sides[] = {"right side", "lower right corner", "lower side", "lower left corner",
                               "left side",  "upper left corner",  "upper side", "upper right corner"};
  const int eighth = static_cast<int>(std::lround(direction_rad / (std::numbers::pi / 4)));
  return sides[((eighth % 8) + 8) % 8];
}

void AddLensWarnings(const IntrinsicsRun& run, std::vector<std::string>& warnings) {
  if (run.halves.HasMisfit()) warnings.push_back(HalvesSentence(run));
  const auto neighbours_px = run.NeighbourSigma_px();
  const double sigma_px = run.result.corner_sigma_px;
  if (neighbours_px && sigma_px > kSmoothMisfit * *neighbours_px)
    warnings.push_back(fmt::format(
        "corners lie {:.3g} px from where the model has them, neighbours {:.3g} px from each other: what the "
        "lens model does not have, or a board that is not flat{}",
        sigma_px, *neighbours_px, run.settings.board_fit.estimates_warp ? "" : " (--board-warp tells)"));
}

// Nothing where the lens model fits.
std::string WideningClause(const BoardCalibration& result) {
  if (result.widening == 1) return "";
  return fmt::format("; the camera's σ are therefore {:.2g} times what the residuals give", result.widening);
}

// Coefficients that are not known to anything like their own size are a lens that needs fewer.
void AddCoefficientWarning(const IntrinsicsRun& run, std::vector<std::string>& warnings) {
  constexpr double kUnknownCoefficient = 1;  // of 1 it moves a corner by its own distance from the centre
  const Eigen::VectorXd variances = run.result.information.CameraCovariance().diagonal();
  const Eigen::Index coefficients = variances.size() - 4;
  if (coefficients == 0 || !(std::sqrt(variances.tail(coefficients).maxCoeff()) > kUnknownCoefficient))
    return;
  warnings.push_back(
      fmt::format("the coefficients of the {} lens are not told apart by these views, and whether it "
                  "fits is not tested by them: take a lens with fewer",
                  LensName(run.settings.lens)));
}

// What is found in images has sigmas of its own.
void AddNoiseWarning(const IntrinsicsRun& run, std::vector<std::string>& warnings) {
  constexpr double kManyTimes = 4;
  if (run.settings.corners || run.result.noise_factor < kManyTimes) return;
  warnings.push_back(
      fmt::format("corners lie {:.2g} times as far from where the model has them as the images let "
                  "them scatter: the board is bent, or not as its file says, or the lens model is poor",
                  run.result.noise_factor));
}

}  // namespace

int ViewsUsed(const BoardCalibration& result) {
  return static_cast<int>(std::count_if(result.views.begin(), result.views.end(),
                                        [](const ViewFit& view) { return view.left_out.empty(); }));
}

int CornersNotMeasured(const IntrinsicsRun& run) {
  size_t count = 0;
  for (const auto& of_view : run.left_out)
    for (const LeftOut& part : of_view) count += part.points.size();
  return static_cast<int>(count);
}

int CornersOf(const BoardCalibration& result) {
  int count = 0;
  for (const ViewFit& view : result.views) count += static_cast<int>(view.weight.size());
  return count;
}

int CornersWeighedDown(const BoardCalibration& result) {
  int count = 0;
  for (const ViewFit& view : result.views)
    count += static_cast<int>(std::count_if(view.weight.begin(), view.weight.end(),
                                            [](double weight) { return weight > 0 && weight < 1; }));
  return count;
}

std::vector<std::string> Warnings(const IntrinsicsRun& run) {
  std::vector<std::string> warnings;
  if (run.result.status != BoardCalibrationStatus::kConverged) return warnings;
  AddLensWarnings(run, warnings);
  AddNoiseWarning(run, warnings);
  AddCoefficientWarning(run, warnings);
  const int views = ViewsUsed(run.result), corners = CornersOf(run.result);
  if (run.result.distinct_views < views)
    warnings.push_back(
        fmt::format("{} of {} views show the board where another does: they count as if each had its "
                    "own noise, and the uncertainty is told too small",
                    views - run.result.distinct_views, views));
  if (views < kFewViews)
    warnings.push_back(
        fmt::format("only {}: one or two decide; take {} or more", Plural(views, "view"), kFewViews));
  if (!run.halves.why_not.empty())
    warnings.push_back("whether the lens model fits is not known: " + run.halves.why_not);
  if (run.result.corners_left_out > kManyLeftOut * corners)
    warnings.push_back(fmt::format("{} of {} corners do not fit and were left out: the report shows which",
                                   run.result.corners_left_out, corners));
  if (run.coverage.Share() < kLittleCoverage)
    warnings.push_back(
        fmt::format("only {:.0f} % of the image has shown corners: the camera is not known in the rest",
                    100 * run.coverage.Share()));
  if (run.coverage.LargestTilt() < kLittleTilt_rad)
    warnings.push_back(
        fmt::format("the board was tilted by {:.0f} degrees at most: 30 to 45 tell the focal length better",
                    Degrees(run.coverage.LargestTilt())));
  return warnings;
}

std::string HalvesSentence(const IntrinsicsRun& run) {
  const HalvesComparison& halves = run.halves;
  if (!halves.why_not.empty()) return halves.why_not;
  const std::string seen = fmt::format(
      "cameras from two halves of the views differ by {:.3g} px over the image, {:.2g} times what the "
      "corners' "
      "scatter explains",
      halves.difference_rms_px, halves.ratio);
  if (!halves.HasMisfit())
    return seen + fmt::format(" (up to {:.2g} is chance): the lens model fits", halves.ratio_limit);
  const bool can_more =
      run.settings.lens == LensModel::kPinhole || run.settings.lens == LensModel::kBrownConrady;
  return seen + fmt::format(" ({:.2g} at most is chance): the lens model does not fit{}{}",
                            halves.ratio_limit,
                            can_more ? "; try --lens rational or fisheye"
                                     : ", or something moved: focus, zoom, the board",
                            WideningClause(run.result));
}

std::string CoverageSentence(const IntrinsicsRun& run) {
  return fmt::format("corners were seen in {:.0f} % of the image, the board tilted by up to {:.0f} degrees",
                     100 * run.coverage.Share(), Degrees(run.coverage.LargestTilt()));
}

std::string NextViewSentence(const IntrinsicsRun& run) {
  if (!run.next_view) return "";
  const NextView& next = *run.next_view;
  const std::string tilt = next.tilt.angle_rad < 0.01
                               ? "facing the camera"
                               : fmt::format("tilted by {:.0f} degrees, its {} farther away",
                                             Degrees(next.tilt.angle_rad), SideText(next.tilt.direction_rad));
  return fmt::format(
      "add a view of the board {}, {:.2g} m away, {}: {:.3g} px over the image would become {:.3g}",
      PlaceText(next.centre_px, run.result.camera), next.distance_m, tilt, next.now_px, next.then_px);
}

std::string BoardText(const Board& board) {
  if (board.tags)
    return fmt::format("{} of {}", Plural(static_cast<int>(board.tags->tags.size()), "tag"),
                       board.tags->family);
  return fmt::format("a chessboard of {} x {} corners", board.chessboard->columns, board.chessboard->rows);
}

std::string DistanceText(const IntrinsicsRun& run, double distance_m) {
  if (std::isinf(distance_m)) return "infinitely far away";
  if (distance_m == run.board_distance_m)
    return fmt::format("at the boards' distance ({:.2g} m)", distance_m);
  return fmt::format("{:.2g} m away", distance_m);
}

}  // namespace legible
