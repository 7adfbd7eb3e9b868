// Whether estimates scatter as the reported covariance says, and no more than the observations force them to.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iostream>
#include <thread>
#include <unsupported/Eigen/SpecialFunctions>

#include "calib/leg_calibration.h"
#include "tests/calib/synthetic_tags.h"
#include "tests/calib/truth_problem.h"

namespace legible {
namespace {

constexpr double kTwoSidedNormal95 = 1.959963984540054;

// Orthonormal columns of the displacements (relative to `scales`) of the free parameters that obey the
// platform gauge: the covariance has full rank on them.
Eigen::MatrixXd GaugeBasis(const EstimationProblem& problem, const std::vector<int>& free,
                           const Eigen::VectorXd& scales) {
  Eigen::MatrixXd gauge = Eigen::MatrixXd::Zero(6, kSharedParameterCount);
  const Eigen::Matrix<double, 6, 18> of_joints = PlatformGauge(problem.drawn_platform_joints);
  for (int leg = 0; leg < kLegCount; ++leg)
    gauge.middleCols<3>(FirstParameterOfLeg(leg) + leg_parameter::kPlatformJoint) =
        of_joints.middleCols<3>(3 * leg);
  const Eigen::MatrixXd constraint = (gauge(Eigen::all, free) * scales.asDiagonal()).transpose();
  const Eigen::Index count = scales.size();
  const Eigen::MatrixXd q =
      constraint.householderQr().householderQ() * Eigen::MatrixXd::Identity(count, count);
  return q.rightCols(count - 6);
}

// One estimate from one draw of the noise; of the free parameters, in the order of their indices.
struct Estimate {
  bool converged = false;
  Eigen::VectorXd error;     // estimate - truth, SI units and px
  Eigen::VectorXd sigma;     // as reported with the estimate
  double squared_error = 0;  // error^T covariance^-1 error in the gauge, with the reported covariance
};

// A session whose noise is drawn again and again.
class Experiment {
 public:
  explicit Experiment(const SyntheticOptions& options,
                      const std::optional<SyntheticTagOptions>& tags = std::nullopt)
      : options_(options),
        tags_(tags),
        session_(GenerateSession(options)),
        problem_(ProblemAtTruth(session_, session_.exact_observations,
                                {.lasting_shading_px = options.lasting_shading_px})),
        free_(FreeIndices(problem_)) {
    if (tags) AddTagsToProblem(DrawTags(session_, *tags), tags->corner_sigma_px, problem_);
    const Eigen::MatrixXd covariance = AnalyseObservability(problem_).covariance;
    bound_ = covariance.diagonal()(free_).cwiseSqrt();
    basis_ = GaugeBasis(problem_, free_, bound_);
  }

  // Cramér-Rao bound of each free parameter's standard deviation.
  const Eigen::VectorXd& bound() const { return bound_; }
  // Free parameters less the gauge.
  Eigen::Index rank() const { return basis_.cols(); }
  std::string Name(Eigen::Index i) const {
    return ParameterName(problem_.camera.lens, free_[static_cast<size_t>(i)]);
  }

  std::vector<Estimate> Run(int count) const {
    std::vector<Estimate> estimates(static_cast<size_t>(count));
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int i = next++; i < count; i = next++) estimates[static_cast<size_t>(i)] = RunOnce(i + 1);
    };
    std::thread other(work);
    work();
    other.join();
    return estimates;
  }

 private:
  Estimate RunOnce(int noise_seed) const {
    LegCalibrationInput input{session_.nominal_robot,
                              session_.nominal_camera,
                              session_.nominal_camera_from_base,
                              DrawObservations(session_, options_, static_cast<std::uint64_t>(noise_seed)),
                              {},
                              {}};
    input.known.joint_reading_m = options_.joint_reading_sigma_m;
    if (tags_) {
      SyntheticTagOptions drawn = *tags_;
      drawn.noise_seed = static_cast<std::uint64_t>(noise_seed);
      input.tags = DrawTags(session_, drawn);
    }
    LegCalibrationOptions calibration_options;
    calibration_options.threads = 1;
    const LegCalibration found = CalibrateLegs(input, calibration_options);

    Estimate estimate;
    estimate.converged = found.status == CalibrationStatus::kConverged;
    estimate.error = (ParametersOf(found) - AsVector(Truth(noise_seed)))(free_);
    const Eigen::MatrixXd covariance = found.observability.covariance(free_, free_);
    estimate.sigma = covariance.diagonal().cwiseSqrt();
    const Eigen::MatrixXd relative =
        bound_.cwiseInverse().asDiagonal() * covariance * bound_.cwiseInverse().asDiagonal();
    const Eigen::VectorXd in_gauge = basis_.transpose() * estimate.error.cwiseQuotient(bound_);
    estimate.squared_error = in_gauge.dot((basis_.transpose() * relative * basis_).ldlt().solve(in_gauge));
    return estimate;
  }

  // Shading is drawn with the noise.
  SharedParameters Truth(int noise_seed) const {
    SharedParameters truth = problem_.shared;
    const auto shading = DrawLastingShading(options_, static_cast<std::uint64_t>(noise_seed));
    for (size_t i = 0; i < kLegCount; ++i) truth.legs[i].segment<4>(leg_parameter::kShading) = shading[i];
    return truth;
  }

  static Eigen::VectorXd AsVector(const SharedParameters& shared) {
    Eigen::VectorXd all(kSharedParameterCount);
    for (int i = 0; i < kSharedParameterCount; ++i) all[i] = Parameter(shared, i);
    return all;
  }

  static Eigen::VectorXd ParametersOf(const LegCalibration& found) {
    SharedParameters shared;
    shared.camera = legible::ParametersOf(found.camera);
    for (size_t i = 0; i < kLegCount; ++i) {
      const Leg& leg = found.robot.legs[i];
      shared.legs[i] << found.base_joints_in_camera_m[i], leg.platform_joint_m, leg.radius_m,
          leg.joint_offset_m, found.shading_px[i];
    }
    return AsVector(shared);
  }

  SyntheticOptions options_;
  std::optional<SyntheticTagOptions> tags_;
  SyntheticSession session_;
  EstimationProblem problem_;
  std::vector<int> free_;
  Eigen::VectorXd bound_;
  Eigen::MatrixXd basis_;
};

// Root mean square error over the bound: of each parameter, and pooled over all.
struct Scatter {
  Eigen::VectorXd of_parameter;
  double pooled = 0;
};

Scatter ScatterOverBound(const std::vector<Estimate>& estimates, const Eigen::VectorXd& bound) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(bound.size());
  for (const Estimate& estimate : estimates) squares += estimate.error.cwiseQuotient(bound).cwiseAbs2();
  squares /= static_cast<double>(estimates.size());
  return {squares.cwiseSqrt(), std::sqrt(squares.mean())};
}

double ChiSquaredCdf(double x, double degrees_of_freedom) {
  return Eigen::numext::igamma(degrees_of_freedom / 2, x / 2);
}

// Chance that a sample of this size departs further from its distribution than by `distance` (Kolmogorov's
// series with Stephens' correction for small samples, 1970).
double KolmogorovSmirnovP(double distance, double count) {
  const double lambda = (std::sqrt(count) + 0.12 + 0.11 / std::sqrt(count)) * distance;
  double sum = 0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
  return std::clamp(sum, 0.0, 1.0);
}

// The same, of values against the chi-squared distribution.
double ChiSquaredP(std::vector<double> values, double degrees_of_freedom) {
  std::sort(values.begin(), values.end());
  const double count = static_cast<double>(values.size());
  double distance = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double cdf = ChiSquaredCdf(values[i], degrees_of_freedom), below = static_cast<double>(i) / count;
    distance = std::max({distance, cdf - below, below + 1 / count - cdf});
  }
  return KolmogorovSmirnovP(distance, count);
}

double Coverage(const std::vector<Estimate>& estimates) {
  double covered = 0, all = 0;
  for (const Estimate& estimate : estimates) {
    covered += static_cast<double>(
        (estimate.error.array().abs() <= kTwoSidedNormal95 * estimate.sigma.array()).count());
    all += static_cast<double>(estimate.error.size());
  }
  return covered / all;
}

int ConvergedCount(const std::vector<Estimate>& estimates) {
  return static_cast<int>(
      std::count_if(estimates.begin(), estimates.end(), [](const Estimate& e) { return e.converged; }));
}

TEST(Statistics, ChiSquaredDistributionMatchesItsTable) {
  EXPECT_NEAR(ChiSquaredCdf(3.841458820694124, 1), 0.95, 1e-12);
  EXPECT_NEAR(ChiSquaredCdf(67.50480654954, 50), 0.95, 1e-10);
}

TEST(Statistics, KolmogorovSmirnovDistributionMatchesItsTable) {
  // Critical values of D sqrt(n) for large n.
  EXPECT_NEAR(KolmogorovSmirnovP(1.3581 / 1000, 1e6), 0.05, 1e-4);
  EXPECT_NEAR(KolmogorovSmirnovP(1.6276 / 1000, 1e6), 0.01, 1e-4);
}

// The bars of a correct estimator: no worse than the bound, and the reported covariance that of the errors.
void ExpectEfficientAndHonest(const Experiment& experiment, int runs, double each) {
  const std::vector<Estimate> estimates = experiment.Run(runs);
  ASSERT_EQ(ConvergedCount(estimates), runs);
  const Scatter scatter = ScatterOverBound(estimates, experiment.bound());
  EXPECT_GE(scatter.pooled, 0.95);
  EXPECT_LE(scatter.pooled, 1.05);
  for (Eigen::Index i = 0; i < scatter.of_parameter.size(); ++i)
    EXPECT_NEAR(scatter.of_parameter[i], 1, each) << experiment.Name(i);

  std::vector<double> squared_errors;
  double mean = 0;
  for (const Estimate& estimate : estimates) {
    squared_errors.push_back(estimate.squared_error);
    mean += estimate.squared_error / runs;
  }
  const double degrees_of_freedom = static_cast<double>(experiment.rank());
  const double p = ChiSquaredP(squared_errors, degrees_of_freedom);
  EXPECT_NEAR(mean / degrees_of_freedom, 1, 0.05);
  EXPECT_GT(p, 0.01);

  const double coverage = Coverage(estimates);
  EXPECT_GE(coverage, 0.94);
  EXPECT_LE(coverage, 0.96);
  std::cout << "scatter / bound: pooled " << scatter.pooled << ", each " << scatter.of_parameter.minCoeff()
            << " to " << scatter.of_parameter.maxCoeff() << "\nsquared error: mean " << mean << " of "
            << degrees_of_freedom << ", Kolmogorov-Smirnov p " << p << "\n95 % intervals cover " << coverage
            << std::endl;
}

TEST(CalibrationStatistics, EstimatesReachTheCramerRaoBoundAndReportIt) {
  ExpectEfficientAndHonest(Experiment{SyntheticOptions()}, 400, 0.15);
}

// Of half as many images; a standard deviation from 150 runs is good to 6 %, the largest of 60 to some 20 %.
TEST(CalibrationStatistics, EstimatesReachTheBoundWhereShadingMovesWholeEdges) {
  SyntheticOptions options;
  options.image_count = 20;
  options.edge_sigma_px = 0.1;
  options.common_edge_sigma_px = 0.03;
  options.lasting_shading_px = 0.03;
  ExpectEfficientAndHonest(Experiment{options}, 150, 0.2);
}

TEST(CalibrationStatistics, EstimatesReachTheBoundWithTagsAsObservations) {
  SyntheticOptions options;
  options.image_count = 20;
  ExpectEfficientAndHonest(Experiment(options, SyntheticTagOptions()), 150, 0.2);
}

// Edges as well measured as in images: by ones of 0.3 px, k3 and k4 are not told apart.
TEST(CalibrationStatistics, EstimatesReachTheBoundThroughAFisheye) {
  SyntheticOptions options;
  options.image_count = 25;
  options.edge_sigma_px = 0.02;
  options.camera = DesktopFisheye();
  options.camera_from_base = LookAt({0.52, 0.074, 0.3}, {0, 0, 0.13});
  ExpectEfficientAndHonest(Experiment{options}, 150, 0.2);
}

TEST(CalibrationStatistics, OutliersInAFifthOfTheSamplesCostLessThanHalfTheBound) {
  constexpr int kRuns = 100;
  SyntheticOptions options;
  options.outlier_fraction = 0.2;
  const Experiment experiment{options};
  const std::vector<Estimate> estimates = experiment.Run(kRuns);
  ASSERT_EQ(ConvergedCount(estimates), kRuns);
  const Scatter scatter = ScatterOverBound(estimates, experiment.bound());
  EXPECT_LE(scatter.pooled, 1.5);
  EXPECT_LE(scatter.of_parameter.maxCoeff(), 1.5);
  std::cout << "scatter / bound with 20 % outliers: pooled " << scatter.pooled << ", largest "
            << scatter.of_parameter.maxCoeff() << std::endl;
}

}  // namespace
}  // namespace legible
