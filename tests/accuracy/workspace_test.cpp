#include "accuracy/workspace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

#include "accuracy/conditioning.h"
#include "core/geometry/rigid3.h"
#include "core/robots/planar_2r.h"

namespace legible {
namespace {

using std::numbers::pi;

// --- Merlet's warning (2006, section 6): the planar 2R with equal links.

// (8 sqrt 2 ln(1 + sqrt 2) - 5 ln 5) / (2 pi).
const double kExactGci = (8 * std::sqrt(2.0) * std::log(1 + std::sqrt(2.0)) - 5 * std::log(5.0)) / (2 * pi);

// 1 / kappa_2, which does not depend on the first joint; 0 where the arm is stretched or folded.
double InverseCondition(double second_angle_rad) {
  const double condition = ConditionNumbersOf(Jacobian(Planar2R{}, {0, second_angle_rad})).two;
  return std::isfinite(condition) ? 1 / condition : 0;
}

// The usual way: m steps over the whole turn, both ends among the nodes, a plain mean.
double GciOverNodes(int m) {
  double sum = 0;
  for (int i = 0; i <= m; ++i) sum += InverseCondition(2 * pi * i / m);
  return sum / (m + 1);
}

const BatchEvaluator kInverseConditions = [](const Eigen::MatrixXd& points) {
  BatchValues batch{Eigen::MatrixXd(1, points.cols()),
                    std::vector<PointState>(static_cast<size_t>(points.cols()), PointState::kInside)};
  for (Eigen::Index i = 0; i < points.cols(); ++i) batch.values(0, i) = InverseCondition(points(0, i));
  return batch;
};

Box WholeTurn() { return {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 2 * pi)}; }

WorkspaceStatistics Sample2R(SamplingRule rule, size_t samples, std::uint64_t seed = 1) {
  StatisticsOptions options;
  options.sampling = {rule, samples, seed};
  return SampleWorkspace(WholeTurn(), options, kInverseConditions);
}

TEST(Merlets2R, TheUsualStoppingRuleStopsWhereTheErrorIsStillFourTimesItsStep) {
  const double at_50 = GciOverNodes(50), at_60 = GciOverNodes(60);
  const double step = std::abs(at_60 - at_50) / at_60, error = std::abs(at_60 - kExactGci) / kExactGci;
  std::cout << "2R: step " << 100 * step << " %, error " << 100 * error << " %" << std::endl;
  EXPECT_NEAR(100 * step, 0.377, 0.0005);
  EXPECT_NEAR(100 * error, 1.751, 0.0005);
  for (int m = 10; m < 50; m += 10)  // and does not stop before
    EXPECT_GT(std::abs(GciOverNodes(m + 10) - GciOverNodes(m)) / GciOverNodes(m + 10), 0.005);
}

TEST(Merlets2R, TheBestRuleFindsTheExactIndexToABillionth) {
  const WorkspaceStatistics found = Sample2R(SamplingRule::kGauss, 160);
  EXPECT_NEAR(found.quantities[0].mean.value, kExactGci, 1e-9);
  EXPECT_NEAR(found.quantities[0].mean.value, 0.3062800452302787, 1e-9);
  EXPECT_LE(found.quantities[0].mean.half_width, 1e-9);
  EXPECT_EQ(found.certainty, Certainty::kRefinement);
}

// 95 % intervals of each rule hold the truth in about 95 % of 200 runs: the standard error is 1.5 %.
TEST(Sampling, IntervalsHoldTheExactIndexAsOftenAsTheySay) {
  constexpr int kRuns = 200;
  for (const SamplingRule rule : {SamplingRule::kGrid, SamplingRule::kMonteCarlo, SamplingRule::kSobol}) {
    int held = 0;
    for (int seed = 1; seed <= kRuns; ++seed) {
      const Enclosure mean = Sample2R(rule, 1024, static_cast<std::uint64_t>(seed)).quantities[0].mean;
      held += mean.low() <= kExactGci && kExactGci <= mean.high();
    }
    std::cout << ToString(rule) << ": " << held << " of " << kRuns << std::endl;
    EXPECT_GE(held, 0.89 * kRuns) << ToString(rule);
  }
}

TEST(Sampling, SobolAndGridsComeCloserThanMonteCarloWithAsManyPoints) {
  const auto half_width = [](SamplingRule rule) {
    return Sample2R(rule, 1 << 14).quantities[0].mean.half_width;
  };
  EXPECT_LT(10 * half_width(SamplingRule::kSobol), half_width(SamplingRule::kMonteCarlo));
  EXPECT_LT(10 * half_width(SamplingRule::kGrid), half_width(SamplingRule::kMonteCarlo));
}

// --- The rules themselves.

TEST(Sampling, SobolPutsOnePointIntoEveryIntervalOfEveryAxis) {
  const Eigen::MatrixXd points = UnitCubePoints({SamplingRule::kSobol, 16 * 256, 3}, 6, 2).points;
  ASSERT_EQ(points.cols(), 256);
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    std::vector<int> count(256);
    for (Eigen::Index i = 0; i < 256; ++i) ++count[static_cast<size_t>(points(axis, i) * 256)];
    EXPECT_EQ(*std::min_element(count.begin(), count.end()), 1);
  }
}

TEST(Sampling, WeightsAddUpToOneAndPointsStayInTheCube) {
  for (const SamplingRule rule :
       {SamplingRule::kGrid, SamplingRule::kMonteCarlo, SamplingRule::kSobol, SamplingRule::kGauss}) {
    const WeightedPoints drawn = UnitCubePoints({rule, 50000, 5}, 3, 1);
    EXPECT_NEAR(drawn.weights.sum(), 1, 1e-12);
    EXPECT_GE(drawn.points.minCoeff(), 0);
    EXPECT_LT(drawn.points.maxCoeff(), 1);
  }
}

TEST(Sampling, GaussIntegratesPolynomialsInThreeDimensionsExactly) {
  StatisticsOptions options;
  options.sampling = {SamplingRule::kGauss, 8000, 1};
  const Box box{Eigen::Vector3d(0, -1, 2), Eigen::Vector3d(1, 1, 4)};
  const auto found = SampleWorkspace(box, options, [](const Eigen::MatrixXd& p) {
    BatchValues batch{Eigen::MatrixXd(1, p.cols()),
                      std::vector<PointState>(static_cast<size_t>(p.cols()), PointState::kInside)};
    batch.values.row(0) = p.row(0).array().pow(9) * p.row(1).array().pow(8) * p.row(2).array().pow(3);
    return batch;
  });
  EXPECT_NEAR(found.quantities[0].mean.value, 0.1 * (1.0 / 9) * ((256.0 - 16) / 4 / 2), 1e-13);
}

// --- Sets that the box only contains.

// x and |x| on the unit disk in a square, singular in a thin ring.
BatchValues OnTheDisk(const Eigen::MatrixXd& p) {
  BatchValues batch{Eigen::MatrixXd(2, p.cols()), {}};
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const double radius = p.col(i).head<2>().norm();
    batch.values.col(i) << p(0, i), radius;
    batch.states.push_back(radius > 1       ? PointState::kOutside
                           : radius > 0.999 ? PointState::kSingular
                                            : PointState::kInside);
  }
  return batch;
}

TEST(SampleWorkspace, CountsWhatIsInsideAndGivesClosedFormsOfADisk) {
  StatisticsOptions options;
  options.sampling = {SamplingRule::kSobol, 1 << 18, 1};
  options.quantiles = {0.25, 0.5};
  const Box box{Eigen::Vector3d(-1, -1, 7), Eigen::Vector3d(1, 1, 7)};  // the third is held
  const WorkspaceStatistics found = SampleWorkspace(box, options, OnTheDisk);
  EXPECT_EQ(found.samples, size_t{1} << 18);
  EXPECT_GT(found.singular, 0u);
  EXPECT_NEAR(found.allowed_fraction.value, pi / 4, 3 * found.allowed_fraction.half_width);
  EXPECT_NEAR(found.quantities[0].mean.value, 0, 1e-3);
  EXPECT_NEAR(found.quantities[0].variance.value, 0.25, 2e-3);
  EXPECT_NEAR(found.quantities[1].mean.value, 2.0 / 3, 1e-3);
  EXPECT_NEAR(found.quantities[1].quantiles[0].at.value, 0.5, 2e-3);
  EXPECT_NEAR(found.quantities[1].quantiles[1].at.value, std::sqrt(0.5), 2e-3);
  EXPECT_LE(found.quantities[1].largest_seen, 0.999);
}

TEST(SampleWorkspace, OfASetThatNoPointHitsHasNoStatistics) {
  StatisticsOptions options;
  const auto found = SampleWorkspace(WholeTurn(), options, [](const Eigen::MatrixXd& p) {
    return BatchValues{Eigen::MatrixXd(1, p.cols()),
                       std::vector<PointState>(static_cast<size_t>(p.cols()), PointState::kOutside)};
  });
  EXPECT_EQ(found.inside, 0u);
  EXPECT_TRUE(found.quantities.empty());
  EXPECT_EQ(found.allowed_fraction.value, 0);
}

// Half widths of every statistic on a set that the box only contains, with few points inside: each holds the
// truth in about 95 % of 200 runs (standard error 1.5 %), or none is given.
TEST(SampleWorkspace, IntervalsOfASetThatIsCutHoldTheTruthOrAreNotGiven) {
  constexpr int kRuns = 200;
  const Box box{Eigen::Vector3d(-2, -2, 7), Eigen::Vector3d(2, 2, 7)};  // the disk takes a fifth of it
  std::map<std::string, int> held, given;
  for (const size_t samples : {2048, 32768})
    for (int seed = 1; seed <= kRuns; ++seed) {
      StatisticsOptions options;
      options.sampling = {SamplingRule::kSobol, samples, static_cast<std::uint64_t>(seed)};
      options.quantiles = {0.05, 0.5, 0.95, 0.99};
      const WorkspaceStatistics found = SampleWorkspace(box, options, OnTheDisk);
      const auto count = [&](const std::string& name, const Enclosure& enclosure, double truth) {
        if (std::isnan(enclosure.half_width)) return;
        ++given[std::to_string(samples) + " " + name];
        held[std::to_string(samples) + " " + name] += enclosure.low() <= truth && truth <= enclosure.high();
      };
      const double edge = 0.999;  // of what counts: radius by the square root of a uniform number
      count("mean", found.quantities[1].mean, edge * 2 / 3);
      count("variance", found.quantities[1].variance, edge * edge * (0.5 - 4.0 / 9));
      for (const Quantile& quantile : found.quantities[1].quantiles)
        count("quantile " + std::to_string(quantile.part), quantile.at, edge * std::sqrt(quantile.part));
    }
  for (const auto& [name, count] : given) {
    std::cout << name << ": " << held[name] << " of " << count << std::endl;
    EXPECT_GE(held[name], 0.88 * count) << name;
  }
  EXPECT_EQ(given.count("2048 quantile 0.990000"), 0u);
  EXPECT_EQ(given.count("2048 quantile 0.500000"), 1u);
  EXPECT_EQ(given.count("32768 quantile 0.950000"), 1u);
}

TEST(SampleWorkspace, RefusesBoxesAndSamplingsThatMeanNothing) {
  StatisticsOptions options;
  const auto run = [&](const Box& box) { SampleWorkspace(box, options, kInverseConditions); };
  EXPECT_THROW(run({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}), std::invalid_argument);
  EXPECT_THROW(run({Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1)}), std::invalid_argument);
  EXPECT_THROW(run({Eigen::VectorXd::Zero(2), Eigen::VectorXd::Ones(1)}), std::invalid_argument);
  options.sampling.samples = 3;
  EXPECT_THROW(run(WholeTurn()), std::invalid_argument);
  options.sampling.samples = 2 * kMostSamples;
  EXPECT_THROW(run(WholeTurn()), std::invalid_argument);
  options.sampling = {SamplingRule::kGauss, 100000, 1};  // 20^6 nodes at least
  EXPECT_THROW(run({Vector6d::Zero(), Vector6d::Ones()}), std::invalid_argument);
}

}  // namespace
}  // namespace legible
