#include "core/vision/corner_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/render_scene.h"

namespace legible {
namespace {

Eigen::Vector2d Direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

CornerCells RandomCells(std::mt19937_64& generator) {
  CornerCells cells;
  for (double& cell : cells.reshaped()) cell = Uniform(generator, 0, 1) < 0.5 ? 0 : 1;
  return cells;
}

CornerSite SiteAt(const Eigen::Vector2d& pixel, double direction_1_rad, double direction_2_rad,
                  double pitch_px, const CornerCells& cells) {
  return {pixel, {pitch_px * Direction(direction_1_rad), pitch_px * Direction(direction_2_rad)}, cells, true};
}

// The cells as they are seen, with no formula but where each place of the image lies among them.
class CellScene : public RenderedScene {
 public:
  CellScene(const CornerSite& site, double dark, double light) : site_(site), dark_(dark), light_(light) {
    edges_ << site.edges_px[0], site.edges_px[1];
    inverse_ = edges_.inverse();
  }
  double Brightness(const Eigen::Vector2d& x) const override {
    const Eigen::Vector2d pitches = inverse_ * (x - site_.pixel);
    const auto cell = [](double at) { return std::clamp(static_cast<int>(std::floor(at)) + 2, 0, 3); };
    return dark_ + (light_ - dark_) * site_.cells(cell(pitches.y()), cell(pitches.x()));
  }
  bool VariesInPixel(const Eigen::Vector2d&, double) const override { return true; }

 private:
  CornerSite site_;
  double dark_, light_;
  Eigen::Matrix2d edges_, inverse_;
};

// Its normalised coordinates are pixels.
Camera PixelCamera(int size_px) {
  Camera camera;
  camera.width_px = camera.height_px = size_px;
  camera.fx_px = camera.fy_px = 1;
  camera.lens = LensModel::kPinhole;
  return camera;
}

CornerModel::Parameters ParametersOf(const CornerSite& site, double blur_px) {
  CornerModel::Parameters parameters;
  parameters << site.pixel, std::atan2(site.edges_px[0].y(), site.edges_px[0].x()),
      std::atan2(site.edges_px[1].y(), site.edges_px[1].x()), blur_px;
  return parameters;
}

CornerSite RandomSite(std::mt19937_64& generator, const CornerCells& cells) {
  const double direction_1 = Uniform(generator, -M_PI, M_PI);
  const double opening = Uniform(generator, 0.9, 2.2) * (Uniform(generator, -1, 1) > 0 ? 1 : -1);
  return SiteAt({Uniform(generator, -0.5, 0.5), Uniform(generator, -0.5, 0.5)}, direction_1,
                direction_1 + opening, Uniform(generator, 2.5, 6), cells);
}

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
