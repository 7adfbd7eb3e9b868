#include "core/vision/edge_line.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "core/vision/edge_curve.h"
#include "tests/core/vision/scene.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

// Samples on the edge of a leg as the lens shows it, each moved along its normal by noise of sigma_px.
std::vector<EdgeSample> SamplesOn(const PredictedEdge& edge, double sigma_px, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0, sigma_px);
  std::vector<EdgeSample> samples;
  for (size_t i = 5; i + 5 < edge.points.size(); i += 8) {
    const PredictedEdgePoint& point = edge.points[i];
    samples.push_back({point.point_px + noise(generator) * point.normal_px, point.normal_px, sigma_px});
  }
  return samples;
}

class EdgeLineThroughLens : public testing::TestWithParam<bool> {
 protected:
  EdgeLineThroughLens() : scene_(GetParam()), edge_(PredictEdges(scene_.Legs(), scene_.camera, {})[0][0]) {}

  const Scene scene_;
  const PredictedEdge edge_;
};

TEST_P(EdgeLineThroughLens, IsTheOutlineThatTheSamplesLieOn) {
  std::mt19937_64 generator = TestGenerator();
  const auto samples = SamplesOn(edge_, 1e-9, generator);
  const Eigen::Vector3d start = (edge_.normal + UniformVector(generator, -1e-3, 1e-3)).normalized();
  const EdgeLine line = FitEdgeLine(scene_.camera, start, samples);
  EXPECT_LT((line.normal - edge_.normal).norm(), 1e-9);
  EXPECT_EQ(line.samples.size(), samples.size());
  EXPECT_LT(line.rms_px, 1e-6);
}

TEST_P(EdgeLineThroughLens, DropsASampleThatStandsOut) {
  std::mt19937_64 generator = TestGenerator();
  auto samples = SamplesOn(edge_, 0.02, generator);
  samples[2].point_px += 3 * samples[2].normal_px;
  const EdgeLine line = FitEdgeLine(scene_.camera, edge_.normal, samples);
  EXPECT_EQ(line.samples.size(), samples.size() - 1);
  EXPECT_LT((line.normal - edge_.normal).norm() * scene_.camera.fx_px, 0.1);
}

TEST_P(EdgeLineThroughLens, CovarianceIsTheScatterOverTheNoise) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kDraws = 2000;
  double squares = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const EdgeLine line = FitEdgeLine(scene_.camera, edge_.normal, SamplesOn(edge_, 0.05, generator));
    // Rank 2: nothing is said along the normal itself.
    const Eigen::Matrix3d full = line.normal_covariance + edge_.normal * edge_.normal.transpose();
    const Eigen::Vector3d error = line.normal - edge_.normal;
    squares += error.dot(full.inverse() * error) / kDraws;
  }
  EXPECT_NEAR(squares, 2,
              4 * 2 / std::sqrt(kDraws));  // chi2 of two freedoms: four standard deviations of the mean
}

INSTANTIATE_TEST_SUITE_P(Lenses, EdgeLineThroughLens, testing::Values(false, true));

TEST(ShiftEnds, MovesAnEdgeAcrossItself) {
  const Scene scene(true);
  const LegsInCamera legs = scene.Legs();
  const PredictedEdge before = PredictEdges(legs, scene.camera, {})[0][0];
  PredictedEdge after = before;
  ShiftEnds(scene.camera, legs[0], 2, -1, after);
  const auto moved = [&](size_t i) {
    return before.points[i].normal_px.dot(after.points[i].point_px - before.points[i].point_px);
  };
  EXPECT_NEAR(moved(0), 2, 0.02);
  EXPECT_NEAR(moved(before.points.size() - 1), -1, 0.02);
}

}  // namespace
}  // namespace legible
