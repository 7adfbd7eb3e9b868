// Whether the corner fit's covariance is the scatter of its errors.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "core/vision/corner_fit.h"
#include "tests/core/vision/corner_scene.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

// Scatter of the fits of one corner under noise.
struct Scatter {
  int fitted = 0;
  Eigen::Vector2d bias_px = Eigen::Vector2d::Zero();
  double rms_px = 0;              // of a coordinate
  double normalised_squares = 0;  // mean of error' covariance^-1 error, a coordinate
  double variance_ratio = 0;      // scatter about the mean over the mean reported covariance
};

// The site as it might be expected.
CornerSite Guess(const CornerSite& site, const CornerExpectations& expected, std::mt19937_64& generator) {
  CornerSite guess = site;
  guess.pixel += Eigen::Vector2d(Uniform(generator, -0.4, 0.4), Uniform(generator, -0.4, 0.4));
  if (std::isfinite(expected.direction_sigma_rad))
    for (Eigen::Vector2d& edge : guess.edges_px)
      edge =
          Eigen::Rotation2Dd(std::normal_distribution<double>(0, expected.direction_sigma_rad)(generator)) *
          edge;
  return guess;
}

constexpr double kLensBlur_px = 0.8;

// The blur as it might be expected.
CornerExpectations Drawn(CornerExpectations expected, std::mt19937_64& generator) {
  const double true_blur_px = std::sqrt(kLensBlur_px * kLensBlur_px + 1.0 / 12);
  if (std::isfinite(expected.blur_sigma_px))
    expected.blur_px = std::normal_distribution<double>(true_blur_px, expected.blur_sigma_px)(generator);
  return expected;
}

Scatter ScatterOf(const CornerSite& site, const CornerExpectations& expected, int runs, double noise,
                  std::mt19937_64& generator) {
  constexpr int kSize_px = 33;
  CornerSite inside = site;
  inside.pixel += Eigen::Vector2d::Constant(0.5 * (kSize_px - 1));
  const CleanImage clean = RenderScene(CellScene(inside, 30, 220), PixelCamera(kSize_px), 0, kLensBlur_px);
  Scatter scatter;
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero(), reported = Eigen::Matrix2d::Zero();
  for (int run = 0; run < runs; ++run) {
    const CornerFit fit = FitCorner(WithNoise(clean, noise, generator), Guess(inside, expected, generator),
                                    Drawn(expected, generator));
    if (fit.status != CornerStatus::kFitted) continue;
    ++scatter.fitted;
    const Eigen::Vector2d error = fit.pixel - inside.pixel;
    scatter.bias_px += error;
    squares += error * error.transpose();
    reported += fit.covariance_px2;
    scatter.normalised_squares += error.dot(fit.covariance_px2.inverse() * error) / 2;
  }
  scatter.bias_px /= scatter.fitted;
  squares /= scatter.fitted;
  scatter.rms_px = std::sqrt(squares.trace() / 2);
  scatter.normalised_squares /= scatter.fitted;
  squares -= scatter.bias_px * scatter.bias_px.transpose();
  scatter.variance_ratio = squares.trace() / (reported / scatter.fitted).trace();
  return scatter;
}

// The inside of a tag's black border: the first cell of its code is light here.
CornerCells TagCells() {
  CornerCells cells = DarkWedge();
  cells(3, 3) = 1;
  return cells;
}

struct Case {
  const char* name;
  CornerCells cells;
  double pitch_px;
  bool knows_beyond;
  CornerExpectations expected;
  double largest_rms_px;
};

// Sigma, not the error, is what has to be right: of corners as sharp as a pixel allows, of modules of 3 px
// too.
TEST(FitCorner, ScattersAsItsCovarianceSays) {
  std::mt19937_64 generator = TestGenerator();
  const CornerExpectations on_board{0.015, 0.85, 0.08, 2, 40};
  for (const Case& c : {Case{"wedge, 3 px", TagCells(), 3, true, on_board, 0.05},
                        Case{"wedge, 4 px", TagCells(), 4, true, on_board, 0.05},
                        Case{"wedge, 5 px", TagCells(), 5, true, on_board, 0.05},
                        Case{"wedge, 5 px, alone", TagCells(), 5, true, {}, 0.05},
                        Case{"wedge, 8 px", TagCells(), 8, true, on_board, 0.03},
                        Case{"wedge, 30 px", DarkWedge(), 30, false, {}, 0.02},
                        Case{"saddle, 6 px", DarkSaddle(), 6, false, on_board, 0.02},
                        Case{"saddle, 30 px", DarkSaddle(), 30, false, {}, 0.01}}) {
    double ratio = 0, rms = 0, normalised = 0, bias = 0;
    constexpr int kSites = 10, kRuns = 200;
    for (int i = 0; i < kSites; ++i) {
      CornerSite site = RandomSite(generator, c.cells);
      for (Eigen::Vector2d& edge : site.edges_px) edge = c.pitch_px * edge.normalized();
      site.knows_beyond = c.knows_beyond;
      // Oblique pitches are shorter across.
      const double sine = std::abs(site.edges_px[0].x() * site.edges_px[1].y() -
                                   site.edges_px[0].y() * site.edges_px[1].x()) /
                          (c.pitch_px * c.pitch_px);
      for (Eigen::Vector2d& edge : site.edges_px) edge /= sine;
      const Scatter scatter = ScatterOf(site, c.expected, kRuns, 2, generator);
      EXPECT_EQ(scatter.fitted, kRuns) << c.name;
      ratio += scatter.variance_ratio / kSites;
      rms += scatter.rms_px / kSites;
      normalised += scatter.normalised_squares / kSites;
      bias += scatter.bias_px.norm() / kSites;
    }
    std::cout << c.name << ": rms " << rms << " px, bias " << bias << " px, variance ratio " << ratio
              << ", normalised squares " << normalised << std::endl;
    EXPECT_GT(std::sqrt(ratio), 0.9) << c.name;
    EXPECT_LT(std::sqrt(ratio), 1.1) << c.name;
    EXPECT_LT(rms, c.largest_rms_px) << c.name;
  }
}

}  // namespace
}  // namespace legible
