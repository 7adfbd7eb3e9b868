#include "calib/board/halves.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "calib/board/neighbour_scatter.h"
#include "core/geometry/camera_parameters.h"

namespace legible {
namespace {

constexpr double kConfidence = 0.999;
constexpr int kFewestViews = 6;  // three determine a camera

// Every other view of those that take part, and where the whole solution has them.
struct Half {
  BoardCalibrationInput input;
  BoardCalibration start;
};

Half HalfOf(const BoardCalibrationInput& input, const BoardCalibration& whole, size_t which) {
  Half half{{input.points_in_board_m, {}, input.width_px, input.height_px}, {}};
  half.start.camera = whole.camera;
  half.start.warp = whole.warp;
  size_t count = 0;
  for (size_t i = 0; i < input.views.size(); ++i) {
    if (!whole.views[i].left_out.empty() || count++ % 2 != which) continue;
    half.input.views.push_back(input.views[i]);
    half.start.views.push_back(whole.views[i]);
  }
  return half;
}

// All points of a grid, each with the sigma that its difference should have before any motion.
struct WeightedGrid {
  std::vector<GridPoint> points;
  std::vector<double> sigma_px;
  StackedRows rows;
};

WeightedGrid WeightedOver(const Camera& camera, const ImageGrid& grid, const Eigen::MatrixXd& covariance) {
  WeightedGrid weighted{PointsOver(camera, grid), {}, {}};
  for (const GridPoint& point : weighted.points)
    weighted.sigma_px.push_back(
        std::sqrt((point.d_unknowns * covariance * point.d_unknowns.transpose()).trace()));
  weighted.rows = Stack(weighted.points, weighted.sigma_px);
  return weighted;
}

// The differences in the image after the motion that suits best, found by Gauss-Newton, weighted.
Eigen::VectorXd DifferencesOf(const Camera& other, const WeightedGrid& weighted, const ImageGrid& grid) {
  constexpr int kSteps = 10;
  const auto by_motion = weighted.rows.by_motion.completeOrthogonalDecomposition();
  Vector6d motion = Vector6d::Zero();
  Eigen::VectorXd differences(weighted.rows.by_motion.rows());
  for (int step = 0; step <= kSteps; ++step) {
    for (size_t i = 0; i < weighted.points.size(); ++i)
      differences.segment<2>(2 * static_cast<Eigen::Index>(i)) =
          (PixelAfter(other, weighted.points[i], grid, motion) - weighted.points[i].pixel) /
          weighted.sigma_px[i];
    if (step < kSteps) motion -= by_motion.solve(differences);
  }
  return differences;
}

void Compare(const Camera& first, const Camera& second, const Eigen::MatrixXd& covariance,
             HalvesComparison& result) {
  const WeightedGrid weighted = WeightedOver(first, result.grid, covariance);
  if (weighted.points.empty()) {
    result.why_not = "the lens model reaches no part of the image that is looked at";
    return;
  }
  const Eigen::VectorXd differences = DifferencesOf(second, weighted, result.grid);
  // In first order the differences are D z with z of that covariance: their square is a sum of squares of
  // normal values with the eigenvalues of L^T D^T D L as variances (L L^T = covariance), nearly a chi-square
  // times a factor (Satterthwaite).
  const Eigen::MatrixXd d = WithoutMotion(weighted.rows);
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  const Eigen::MatrixXd squares = root.transpose() * (d.transpose() * d) * root;
  const double mean = squares.trace(), freedom = mean * mean / squares.squaredNorm();
  const boost::math::chi_squared distribution(freedom);
  result.ratio = std::sqrt(differences.squaredNorm() / mean);
  result.ratio_limit = std::sqrt(boost::math::quantile(distribution, kConfidence) / freedom);

  double seen = 0, expected = 0;
  for (size_t i = 0; i < weighted.points.size(); ++i) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(i);
    const Eigen::Vector2d difference_px = weighted.sigma_px[i] * differences.segment<2>(row);
    const GridPoint& point = weighted.points[i];
    const size_t cell = static_cast<size_t>(point.row * result.grid.columns + point.column);
    const double expected_px = weighted.sigma_px[i] * (d.middleRows<2>(row) * root).norm();
    result.difference_px[cell] = difference_px;
    result.expected_px[cell] = expected_px;
    seen += difference_px.squaredNorm();
    expected += expected_px * expected_px;
  }
  result.difference_rms_px = std::sqrt(seen / static_cast<double>(weighted.points.size()));
  result.expected_rms_px = std::sqrt(expected / static_cast<double>(weighted.points.size()));
}

// The Mahalanobis distance of the halves' parameters by their stated covariances, of which its square's
// expectation is the number of parameters.
double RatioToStated(const std::vector<BoardCalibration>& halves) {
  const Eigen::MatrixXd covariance =
      halves[0].information.CameraCovariance() + halves[1].information.CameraCovariance();
  const Eigen::Index count = covariance.rows();
  const Eigen::VectorXd difference =
      (ParametersOf(halves[0].camera) - ParametersOf(halves[1].camera)).head(count);
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd scaled = scale.asDiagonal() * difference;
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  return std::sqrt(scaled.dot(correlation.llt().solve(scaled)) / static_cast<double>(count));
}

}  // namespace

HalvesComparison CompareHalves(const BoardCalibrationInput& input, const BoardCalibration& whole,
                               const BoardCalibrationOptions& options, const ImageGrid& grid) {
  HalvesComparison result;
  result.grid = grid;
  result.difference_px.resize(static_cast<size_t>(grid.columns * grid.rows));
  result.expected_px.resize(result.difference_px.size());
  const auto used = std::count_if(whole.views.begin(), whole.views.end(),
                                  [](const ViewFit& view) { return view.left_out.empty(); });
  if (used < kFewestViews) {
    result.why_not = fmt::format("{} views are too few for two halves, {} are needed", used, kFewestViews);
    return result;
  }
  BoardCalibrationOptions quiet = options;
  quiet.progress = nullptr;
  std::vector<BoardCalibration> found;
  for (size_t which : {0u, 1u}) {
    const Half half = HalfOf(input, whole, which);
    found.push_back(RefineCamera(half.input, half.start, quiet));
    if (found.back().status == BoardCalibrationStatus::kConverged) continue;
    result.why_not = "half of the views alone lead to no camera: " + found.back().message;
    return result;
  }
  // By the scatter of corners among their neighbours, which a lens model that does not fit leaves as it is.
  const double scatter = NeighbourScatter(input, whole, options.trusts_all).value_or(whole.noise_factor);
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Zero(whole.information.information.rows(), whole.information.information.cols());
  for (const BoardCalibration& half : found)
    covariance += std::pow(scatter / half.noise_factor, 2) * half.information.CameraCovariance();
  Compare(found[0].camera, found[1].camera, covariance, result);
  result.ratio_to_stated = RatioToStated(found);
  return result;
}

}  // namespace legible
