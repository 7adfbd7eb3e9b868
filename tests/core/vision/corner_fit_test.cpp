#include "core/vision/corner_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/core/vision/corner_scene.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

TEST(CornerModel, DerivativesAreThoseOfItsBrightness) {
  std::mt19937_64 generator = TestGenerator();
  for (int trial = 0; trial < 200; ++trial) {
    const CornerSite site = RandomSite(generator, RandomCells(generator));
    const CornerModel model(site, 7);
    const Eigen::Vector2d pixel(Uniform(generator, -5, 5), Uniform(generator, -5, 5));
    const CornerModel::Parameters parameters = ParametersOf(site, Uniform(generator, 0.5, 1.5));
    const auto numeric = NumericJacobian(
        [&](const CornerModel::Parameters& p) {
          return Eigen::Matrix<double, 1, 1>(model.At(pixel, p).brightness);
        },
        parameters);
    EXPECT_TRUE(AreNear(model.At(pixel, parameters).d_parameters, numeric, 1e-7)) << trial;
  }
}

// A pixel between two edges, and one exactly on an edge, where Owen's form has removable singularities.
TEST(CornerModel, OnAnEdgeIsAsBesideIt) {
  const CornerSite site = SiteAt({0, 0}, 0, 0.5 * M_PI, 10, DarkWedge());
  const CornerModel model(site, 7);
  const CornerModel::Parameters parameters = ParametersOf(site, 0.8);
  EXPECT_NEAR(model.At({0, 0}, parameters).brightness, 0.75, 1e-10);  // three quarters of the blur see light
  EXPECT_NEAR(model.At({5, 0}, parameters).brightness, 0.5, 1e-9);
  EXPECT_NEAR(model.At({0, -4}, parameters).brightness, model.At({1e-9, -4}, parameters).brightness, 1e-8);
}

TEST(CornerModel, IsTheCellsThroughAGaussian) {
  std::mt19937_64 generator = TestGenerator();
  constexpr double kStep = 0.02;
  for (int trial = 0; trial < 20; ++trial) {
    const CornerSite site = RandomSite(generator, RandomCells(generator));
    const CellScene scene(site, 0, 1);
    const double blur_px = Uniform(generator, 0.5, 1.2);
    const Eigen::Vector2d pixel(Uniform(generator, -3, 3), Uniform(generator, -3, 3));
    double sum = 0, weights = 0;
    for (double y = -5; y <= 5; y += kStep)
      for (double x = -5; x <= 5; x += kStep) {
        const double weight = std::exp(-0.5 * (x * x + y * y));
        weights += weight;
        sum += weight * scene.Brightness(pixel + blur_px * Eigen::Vector2d(x, y));
      }
    EXPECT_NEAR(CornerModel(site, 7).At(pixel, ParametersOf(site, blur_px)).brightness, sum / weights, 1e-3);
  }
}

// A saddle in the middle of an image, its edges along the axes, the next lines 10 px away.
CornerSite SaddleSite() { return SiteAt({16.3, 15.8}, 0, 0.5 * M_PI, 10, DarkSaddle()); }

GrayImage ImageOf(const CornerSite& site, std::mt19937_64& generator) {
  return WithNoise(RenderScene(CellScene(site, 30, 220), PixelCamera(33), 0, 0.8), 2, generator);
}

TEST(FitCorner, FindsPlaceBlurAndContrast) {
  std::mt19937_64 generator = TestGenerator();
  const CornerFit fit = FitCorner(ImageOf(SaddleSite(), generator), SaddleSite());
  ASSERT_EQ(fit.status, CornerStatus::kFitted);
  EXPECT_TRUE(AreNear(fit.pixel, SaddleSite().pixel, 0.04));
  EXPECT_NEAR(fit.blur_px, std::sqrt(0.8 * 0.8 + 1.0 / 12), 0.05);
  EXPECT_NEAR(fit.contrast, 190, 5);
  EXPECT_NEAR(fit.rms, 2, 0.5);
}

TEST(FitCorner, TellsTheNegativeOfItsCells) {
  std::mt19937_64 generator = TestGenerator();
  CornerSite negative = SaddleSite();
  negative.cells = CornerCells::Ones() - negative.cells;
  const CornerFit fit = FitCorner(ImageOf(negative, generator), SaddleSite());
  EXPECT_EQ(fit.status, CornerStatus::kFitted);
  EXPECT_NEAR(fit.contrast, -190, 5);
}

TEST(FitCorner, SaysWhyThereIsNoCorner) {
  std::mt19937_64 generator = TestGenerator();
  const GrayImage image = ImageOf(SaddleSite(), generator);
  CornerSite site = SaddleSite();
  for (Eigen::Vector2d& edge : site.edges_px) edge *= 0.39;
  site.knows_beyond = false;
  EXPECT_EQ(FitCorner(image, site).status, CornerStatus::kTooSmall);
  site.knows_beyond = true;  // enough for the fit, which then sees no lines where it expects them
  EXPECT_NE(FitCorner(image, site).status, CornerStatus::kTooSmall);
  site = SaddleSite();
  site.pixel.x() = 5;
  EXPECT_EQ(FitCorner(image, site).status, CornerStatus::kOutsideImage);
  site = SaddleSite();
  site.cells = DarkWedge();
  EXPECT_EQ(FitCorner(image, site).status, CornerStatus::kUnlike);
  const GrayImage grey{33, 33, std::vector<std::uint8_t>(33 * 33, 100)};
  EXPECT_EQ(FitCorner(grey, SaddleSite()).status, CornerStatus::kNoContrast);
  site.edges_px[1] = 2 * site.edges_px[0];
  EXPECT_EQ(FitCorner(image, site).status, CornerStatus::kTooSmall);  // parallel edges
}

}  // namespace
}  // namespace legible
