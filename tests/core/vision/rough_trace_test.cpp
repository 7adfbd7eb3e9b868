#include "core/vision/rough_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kLength_px = 240, kBlur_px = 0.8, kNoise = 2;

// An edge that leaves the middle of the image at an angle, blurred, with noise: the leg is bright.
class EdgeAtAngle : public testing::TestWithParam<double> {
 protected:
  EdgeAtAngle() : generator_(TestGenerator()) {
    const double angle = GetParam() * std::numbers::pi / 180;
    along_ = {std::cos(angle), std::sin(angle)};
    normal_ = {-along_.y(), along_.x()};
    middle_ = Eigen::Vector2d(150, 150) + UniformVector(generator_, -0.5, 0.5).head<2>();
    std::normal_distribution<double> noise(0, kNoise);
    for (int y = 0; y < image_.height; ++y)
      for (int x = 0; x < image_.width; ++x) {
        const double inside = -normal_.dot(Eigen::Vector2d(x, y) - middle_);
        const double grey =
            60 + 60 * std::erfc(-inside / (kBlur_px * std::numbers::sqrt2)) + noise(generator_);
        image_.pixels.push_back(static_cast<std::uint8_t>(std::lround(grey)));
      }
  }

  // Predicted outward of the true edge by so much at its two ends.
  PredictedEdge PredictionOff(double at_a_px, double at_b_px) const {
    PredictedEdge edge;
    edge.half_width_px = 10;
    for (int i = 0; i <= 40; ++i) {
      PredictedEdgePoint point;
      point.share = i / 40.0;
      const double off_px = at_a_px + (at_b_px - at_a_px) * point.share;
      point.point_px = middle_ + (point.share - 0.5) * kLength_px * along_ + off_px * normal_;
      point.normal_px = normal_;
      edge.points.push_back(point);
    }
    return edge;
  }

  std::mt19937_64 generator_;
  Eigen::Vector2d along_, normal_, middle_;
  GrayImage image_{300, 300, {}};
};

TEST_P(EdgeAtAngle, IsTracedToAFewTenthsOfAPixel) {
  const auto trace = TraceRoughly(image_, PredictionOff(1.7, -0.8), {});
  ASSERT_TRUE(trace);
  EXPECT_NEAR(trace->at_a_px, -1.7, 0.3);
  EXPECT_NEAR(trace->at_b_px, 0.8, 0.3);
  EXPECT_GE(trace->samples.size(), 10);
}

// Bright where the light falls, dark at the predicted edge: the other edge is by far the stronger step.
TEST(RoughTrace, TakesADimEdgeOfAThinLegNotItsOtherOne) {
  constexpr double kWidth_px = 10, kBackground = 40;
  std::mt19937_64 generator = TestGenerator();
  std::normal_distribution<double> noise(0, kNoise);
  GrayImage image{300, 100, {}};
  const double edge_y = 60 + Uniform(generator, -0.5, 0.5);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double inside = edge_y - y;
      const double grey = inside > 0 && inside < kWidth_px ? kBackground + 45 + 12 * inside : kBackground;
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(grey + noise(generator))));
    }
  const double off_px = Uniform(generator, -3, 3);
  PredictedEdge edge;
  edge.half_width_px = kWidth_px / 2;
  for (int i = 0; i <= 40; ++i) {
    PredictedEdgePoint point;
    point.share = i / 40.0;
    point.point_px = {30 + 6.0 * i, edge_y + off_px};
    point.normal_px = {0, 1};
    edge.points.push_back(point);
  }
  const auto trace = TraceRoughly(image, edge, {.search_px = 12, .bend_px = 12});
  ASSERT_TRUE(trace);
  for (const EdgeSample& sample : trace->samples) EXPECT_NEAR(sample.point_px.y(), edge_y, 1);
}

// Along rows, columns and a hair off them, where the pixels' distances crowd, and between.
INSTANTIATE_TEST_SUITE_P(Degrees, EdgeAtAngle,
                         testing::Values(0, 0.2, 0.5, 1, 1.5, 2, 20, 45, 70, 89, 89.7, 90, 180));

}  // namespace
}  // namespace legible
