#include "calib/robust_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

struct NoiseModel {
  double sample = 1;    // factor on sigma_px
  double shift_px = 0;  // standard deviations of what is common along an edge
  double tilt_px = 0;
  double common_sigma_px = 0;   // as the edges say of themselves
  double outlier_fraction = 0;  // uniform within 20 px
};

std::vector<EdgeResidualSet> DrawResiduals(std::mt19937_64& generator, int edges, int samples,
                                           const NoiseModel& model) {
  std::normal_distribution<double> normal;
  std::vector<EdgeResidualSet> sets;
  for (int e = 0; e < edges; ++e) {
    EdgeResidualSet set;
    set.leg = e % kLegCount;
    set.edge = e / kLegCount % 2;
    set.place = Eigen::VectorXd::LinSpaced(samples, -1, 1);
    set.sigma_px = set.residual_px = set.weight = Eigen::VectorXd::Ones(samples);
    set.common_sigma_px = model.common_sigma_px;
    const double shift_px = model.shift_px * normal(generator), tilt_px = model.tilt_px * normal(generator);
    for (int i = 0; i < samples; ++i) {
      set.sigma_px[i] = Uniform(generator, 0.1, 0.5);
      set.residual_px[i] =
          shift_px + tilt_px * set.place[i] + model.sample * set.sigma_px[i] * normal(generator);
      if (Uniform(generator, 0, 1) < model.outlier_fraction) set.residual_px[i] = Uniform(generator, -20, 20);
    }
    sets.push_back(set);
  }
  return sets;
}

// As the calibration does it: the median first, then weights and noise in turn.
EdgeNoise EstimateIteratively(std::vector<EdgeResidualSet>& edges) {
  NoiseByEdge noise = UniformNoise({MedianScale(edges), 1, 1});
  for (int round = 0; round < 10; ++round) {
    UpdateWeights(edges, noise);
    noise = EstimateNoise(edges, 0);
  }
  return MeanNoise(noise);
}

TEST(RobustWeight, IsOneUpToThreeSigmasAndZeroFromSix) {
  for (const double z : {0.0, 1.0, -2.9, 3.0}) EXPECT_EQ(RobustWeight(z), 1) << z;
  for (const double z : {6.0, -6.0, 100.0, std::nan("")}) EXPECT_EQ(RobustWeight(z), 0) << z;
}

TEST(RobustWeight, FallsSmoothlyBetween) {
  for (double z = 3; z < 5.98; z += 0.01) {
    EXPECT_GT(RobustWeight(z), RobustWeight(z + 0.01));
    EXPECT_LT(RobustWeight(z) - RobustWeight(z + 0.01), 0.006);
  }
  EXPECT_NEAR(RobustWeight(4.5), 0.5, 1e-12);
}

TEST(MedianScale, IsTheStandardDeviationOfNormalNoise) {
  std::mt19937_64 generator = TestGenerator();
  const auto edges = DrawResiduals(generator, 10000, 20, {.sample = 1.7});
  EXPECT_NEAR(MedianScale(edges) / 1.7, 1, 0.01);  // four of its standard deviations
}

TEST(MedianScale, HardlyMovesWithAFifthOfOutliers) {
  std::mt19937_64 generator = TestGenerator();
  const auto edges = DrawResiduals(generator, 10000, 20, {.outlier_fraction = 0.2});
  EXPECT_GT(MedianScale(edges), 1);
  EXPECT_LT(MedianScale(edges), 1.4);
}

TEST(EstimateNoise, IsUnbiasedOnNormalNoise) {
  std::mt19937_64 generator = TestGenerator();
  auto edges = DrawResiduals(generator, 10000, 20, {.sample = 1.7});
  EXPECT_NEAR(EstimateIteratively(edges).sample / 1.7, 1, 0.0065);  // four of its standard deviations
}

TEST(EstimateNoise, CountsTheParametersThatWereFitted) {
  std::mt19937_64 generator = TestGenerator();
  auto edges = DrawResiduals(generator, 100, 20, {});
  const double without = MeanNoise(EstimateNoise(edges, 0)).sample;
  EXPECT_NEAR(MeanNoise(EstimateNoise(edges, 500)).sample, without * std::sqrt(2000.0 / 1500.0), 1e-9);
}

TEST(EstimateNoise, LeavesOutOutliers) {
  std::mt19937_64 generator = TestGenerator();
  auto edges = DrawResiduals(generator, 10000, 20, {.outlier_fraction = 0.2});
  // Outliers that fall among the good samples widen them: 0.2 x (2 x 6 x 0.3 px of 40 px) = 2 % of the
  // samples.
  EXPECT_NEAR(EstimateIteratively(edges).sample, 1.0, 0.08);
  double good = 0, bad = 0;
  for (const EdgeResidualSet& edge : edges)
    for (Eigen::Index i = 0; i < edge.weight.size(); ++i)
      (std::abs(edge.residual_px[i]) > 7 * edge.sigma_px[i] ? bad : good) += edge.weight[i];
  EXPECT_EQ(bad, 0);
  EXPECT_GT(good, 0.79 * 10000 * 20);
}

TEST(EstimateNoise, TellsTheCommonErrorsFromTheSamples) {
  std::mt19937_64 generator = TestGenerator();
  auto edges = DrawResiduals(generator, 10000, 8,
                             {.sample = 1.2, .shift_px = 0.6, .tilt_px = 0.3, .common_sigma_px = 0.4});
  const EdgeNoise noise = EstimateIteratively(edges);
  EXPECT_NEAR(noise.sample / 1.2, 1, 0.02);
  EXPECT_NEAR(noise.shift / (0.6 / 0.4), 1, 0.04);
  EXPECT_NEAR(noise.tilt / (0.3 / 0.4), 1, 0.08);
}

// Free legs take up what their two edges have in common: little in the residuals does not mean little noise.
TEST(EstimateNoise, DoesNotBelieveLittleCommonErrorWhereMostOfItWasFittedAway) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kEdges = 400;
  const auto edges = DrawResiduals(generator, kEdges, 20, {.common_sigma_px = 0.4});
  EXPECT_LT(MeanNoise(EstimateNoise(edges, 0)).shift, 0.3);
  EXPECT_GE(MeanNoise(EstimateNoise(edges, 2 * kEdges * 0.5)).shift, 1);
}

// An edge whose samples scatter more than the others' has no more in common along it for that.
TEST(EstimateNoise, TellsTheEdgesApart) {
  std::mt19937_64 generator = TestGenerator();
  auto edges =
      DrawResiduals(generator, 12 * 400, 8, {.shift_px = 0.4, .tilt_px = 0.4, .common_sigma_px = 0.4});
  const auto noisy = DrawResiduals(generator, 12 * 400, 8,
                                   {.sample = 3, .shift_px = 0.4, .tilt_px = 0.4, .common_sigma_px = 0.4});
  for (size_t i = 0; i < edges.size(); ++i)
    if (edges[i].leg == 4 && edges[i].edge == 1) edges[i] = noisy[i];
  NoiseByEdge noise = UniformNoise({MedianScale(edges), 1, 1});
  for (int round = 0; round < 10; ++round) {
    UpdateWeights(edges, noise);
    noise = EstimateNoise(edges, 0);
  }
  // A 40th of the mean over all edges is in each.
  EXPECT_NEAR(noise[4][1].sample / 3, 1, 0.05);
  EXPECT_NEAR(noise[4][1].shift, 1, 0.2);
  EXPECT_NEAR(noise[4][1].tilt, 1, 0.35);
  EXPECT_NEAR(noise[0][0].sample, 1, 0.1);
  EXPECT_NEAR(noise[0][0].shift, 1, 0.15);
  EXPECT_NEAR(noise[0][0].tilt, 1, 0.15);
}

TEST(UpdateWeights, DoesNotBlameSamplesForWhatIsCommonAlongTheirEdge) {
  std::mt19937_64 generator = TestGenerator();
  auto edges = DrawResiduals(generator, 100, 20, {.common_sigma_px = 2});
  for (EdgeResidualSet& edge : edges) edge.residual_px.array() += 5;
  UpdateWeights(edges, UniformNoise({}));
  double weight = 0;
  for (const EdgeResidualSet& edge : edges) weight += edge.weight.mean() / 100;
  EXPECT_GT(weight, 0.99);
}

TEST(UpdateWeights, DoesNotTrustAnEdgeThatLiesFarOffAsAWhole) {
  std::mt19937_64 generator = TestGenerator();
  const NoiseModel model{.sample = 1.2, .shift_px = 0.4, .tilt_px = 0.4, .common_sigma_px = 0.4};
  auto edges = DrawResiduals(generator, 1000, 8, model);
  for (size_t i = 0; i < edges.size(); i += 20) edges[i].residual_px.array() += 5;
  const EdgeNoise noise = EstimateIteratively(edges);
  EXPECT_NEAR(noise.shift, 1, 0.15);
  for (size_t i = 0; i < edges.size(); ++i)
    if (i % 20 == 0) {
      EXPECT_LT(edges[i].common_weight, 0.01) << i;
      EXPECT_GT(edges[i].weight.mean(), 0.9) << i;  // its samples agree with each other
    }
}

}  // namespace
}  // namespace legible
