#include "core/vision/board_corners.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/vision/median.h"

namespace legible {
namespace {

// Between a corner and the middle of its edge, the direction turns by half of the curvature: a lens of f =
// 1000 px and k1 = -0.2 bends an edge at half the focal length from the middle of the image to a radius of
// 5000 px. Most edges are bent less.
constexpr double kBend_per_px = 1 / 12000.0;
// What straight edges and a Gaussian blur leave of a real lens's image.
constexpr double kModelSigma_px = 0.002;
constexpr double kBlurSigma = 0.07;    // of the blur, over an image
constexpr double kLeastNoise = 0.3;    // grey levels: that of rounding
constexpr double kNoiseFreedoms = 40;  // that the noise of all corners is worth in one corner's

// The cells know which side is dark.
CornerStatus StatusOf(const CornerFit& fit) {
  return fit.status == CornerStatus::kFitted && fit.contrast < 0 ? CornerStatus::kUnlike : fit.status;
}

}  // namespace

std::vector<CornerFit> FitCorners(const GrayImage& image, const std::vector<ExpectedCorner>& corners,
                                  double corner_sigma_px, CornerExpectations expected) {
  std::vector<CornerFit> fits;
  fits.reserve(corners.size());
  for (const ExpectedCorner& corner : corners) {
    const auto [shorter_px, longer_px] = std::minmax(corner.sides_px[0], corner.sides_px[1]);
    expected.direction_sigma_rad = corner_sigma_px / shorter_px + kBend_per_px * longer_px;
    fits.push_back(FitCorner(image, corner.site, expected));
  }
  return fits;
}

CornerExpectations ExpectationsFrom(const std::vector<CornerFit>& fits) {
  std::vector<double> blurs_px, variances;
  for (const CornerFit& fit : fits)
    if (fit.status == CornerStatus::kFitted) {
      blurs_px.push_back(fit.blur_px);
      variances.push_back(fit.rms * fit.rms);
    }
  CornerExpectations expected;
  if (blurs_px.empty()) return expected;
  expected.blur_px = MedianOf(blurs_px);
  expected.blur_sigma_px = kBlurSigma * expected.blur_px;
  expected.noise = std::max(std::sqrt(MedianOf(variances)), kLeastNoise);
  expected.noise_freedoms = kNoiseFreedoms;
  return expected;
}

BoardSighting SightingOf(const std::vector<ExpectedCorner>& corners, const std::vector<CornerFit>& fits,
                         const std::function<std::string(int)>& name) {
  const Eigen::Matrix2d model_px2 = kModelSigma_px * kModelSigma_px * Eigen::Matrix2d::Identity();
  BoardSighting sighting;
  for (size_t i = 0; i < fits.size(); ++i) {
    const int point = corners[i].point;
    if (StatusOf(fits[i]) == CornerStatus::kFitted)
      sighting.corners.push_back({point, fits[i].pixel, fits[i].covariance_px2 + model_px2});
    else
      sighting.left_out.push_back({name(point), ToString(StatusOf(fits[i])), {point}, fits[i].pixel});
  }
  std::sort(sighting.corners.begin(), sighting.corners.end(),
            [](const BoardCorner& a, const BoardCorner& b) { return a.point < b.point; });
  return sighting;
}

LeftOut WholeBoard(int points, const std::string& reason) {
  LeftOut board{"the board", reason, std::vector<int>(static_cast<size_t>(points)), std::nullopt};
  std::iota(board.points.begin(), board.points.end(), 0);
  return board;
}

}  // namespace legible
