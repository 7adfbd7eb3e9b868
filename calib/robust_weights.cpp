#include "calib/robust_weights.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vision/median.h"

namespace legible {
namespace {

constexpr double kFullUpTo = 3;
constexpr double kZeroFrom = 6;
constexpr double kLeastScale =
    1e-3;  // residuals this far below the samples' own sigmas are rounding, not noise

// E[w z^2] / E[w] of standard normal z: what the weighted mean square is short of 1.
double WeightedVarianceOfStandardNormal() {
  static const double value = [] {
    double sum_w = 0, sum_wzz = 0;
    for (double z = 0; z <= kZeroFrom; z += 1e-3) {
      const double density = std::exp(-z * z / 2);
      sum_w += RobustWeight(z) * density;
      sum_wzz += RobustWeight(z) * z * z * density;
    }
    return sum_wzz / sum_w;
  }();
  return value;
}

// E[w z^2] / E[w] of that for two standard normal values: their mean square is exponential, so (1 - 1/e) over
// (1 - 1/e + E1(1)).
constexpr double kCommonVarianceOfStandardNormal = 0.6321206 / (0.6321206 + 0.2193839);

// Weighted fit of shift + tilt * place to one edge's residuals: the two values, their noise and what is left.
struct LineThroughResiduals {
  Eigen::Vector2d value_px;
  Eigen::Matrix2d information;  // 1 / px^2, for samples of exactly sigma_px
  double weighted_squares = 0;  // of what is left, in sigmas
};

LineThroughResiduals FitLine(const EdgeResidualSet& edge, const Eigen::Matrix2d& prior_information) {
  const Eigen::VectorXd weights = edge.weight.array() / edge.sigma_px.array().square();
  Eigen::MatrixXd basis(edge.place.size(), 2);
  basis << Eigen::VectorXd::Ones(edge.place.size()), edge.place;
  LineThroughResiduals line;
  line.information = basis.transpose() * weights.asDiagonal() * basis;
  line.value_px = (line.information + prior_information)
                      .ldlt()
                      .solve(basis.transpose() * weights.asDiagonal() * edge.residual_px);
  const Eigen::VectorXd left = edge.residual_px - basis * line.value_px;
  line.weighted_squares = left.dot(weights.asDiagonal() * left);
  return line;
}

// Weight of an edge's shift and tilt: full while they are 1 sigma off, then such that they count as 1 sigma
// off, and next to nothing from 6 on. Shading that is misunderstood moves whole edges.
void WeighAsAWhole(const Eigen::Vector2d& common_variance, double sample_noise, EdgeResidualSet& edge) {
  constexpr double kLeast = 1e-4;
  const LineThroughResiduals line = FitLine(edge, Eigen::Matrix2d::Zero());
  Eigen::Matrix2d covariance = sample_noise * sample_noise * line.information.inverse();
  covariance.diagonal() += common_variance;
  const double square = line.value_px.dot(covariance.inverse() * line.value_px) / 2;
  edge.trust = RobustWeight(std::sqrt(square));
  edge.common_weight = std::max(edge.trust / std::max(square, 1.0), kLeast);
}

// Method of moments: values of known noise variance and of a further variance known up to a common factor.
struct VarianceFactor {
  double excess = 0, noise = 0, count = 0;

  void Add(double value, double noise_variance, double expected_sigma, double weight) {
    const double expected = expected_sigma * expected_sigma;
    excess += weight * value * value / expected;
    noise += weight * noise_variance / expected;
    count += weight;
  }
  void Add(const VarianceFactor& other, double weight) {
    excess += weight * other.excess;
    noise += weight * other.noise;
    count += weight * other.count;
  }
  // Square root of the factor; `share`: of the values' squares that the fitted parameters left in the
  // residuals. Where that is little, it is not an even share (a leg whose direction is free takes up what
  // its two edges have in common), and the factor is less and less believed to be below what the edges say of
  // themselves.
  double Sigma(double share) const {
    constexpr double kEnoughLeft = 0.75, kTooLittleLeft = 0.5, kLeastFactor = 0.04;
    const double least =
        std::clamp((kEnoughLeft - share) / (kEnoughLeft - kTooLittleLeft), kLeastFactor, 1.0);
    const double values = excess / share / kCommonVarianceOfStandardNormal;
    return count > 0 ? std::sqrt(std::max(values / count - noise / count, least)) : 1;
  }
};

// Sums over the edges of one kind that tell its noise.
struct NoiseSums {
  double squares = 0, freedom = 0, edges = 0;
  VarianceFactor shift, tilt;

  void Add(const NoiseSums& other, double weight) {
    squares += weight * other.squares;
    freedom += weight * other.freedom;
    edges += weight * other.edges;
    shift.Add(other.shift, weight);
    tilt.Add(other.tilt, weight);
  }
};

constexpr int kFewestSamplesForALine = 3;

bool HasLine(const EdgeResidualSet& edge) { return edge.weight.sum() >= kFewestSamplesForALine; }

double WithinVariance(const NoiseSums& sums) {
  if (sums.freedom <= 0) return 1;
  return std::max(sums.squares / sums.freedom / WeightedVarianceOfStandardNormal(),
                  kLeastScale * kLeastScale);
}

using SumsByEdge = std::array<std::array<NoiseSums, 2>, kLegCount>;
constexpr double kImagesOfTheMean = 10;  // that the mean over all edges counts for in each

// Each edge's sums with those of all edges added as if from a few images.
SumsByEdge DrawnTowardsTheMean(const SumsByEdge& sums) {
  NoiseSums all;
  for (const auto& of_leg : sums)
    for (const NoiseSums& of_edge : of_leg) all.Add(of_edge, 1);
  SumsByEdge drawn = sums;
  for (auto& of_leg : drawn)
    for (NoiseSums& of_edge : of_leg) of_edge.Add(all, kImagesOfTheMean / std::max(all.edges, 1.0));
  return drawn;
}

NoiseSums& At(SumsByEdge& sums, const EdgeResidualSet& edge) {
  return sums[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
}

// Noise of samples, shift and tilt, told apart by fitting a line through each edge's residuals.
NoiseByEdge NoiseByLines(const std::vector<EdgeResidualSet>& edges, double parameters) {
  SumsByEdge sums;
  double lines = 0;
  for (const EdgeResidualSet& edge : edges) {
    if (!HasLine(edge)) continue;
    At(sums, edge).squares += FitLine(edge, Eigen::Matrix2d::Zero()).weighted_squares;
    At(sums, edge).freedom += edge.weight.sum() - 2;
    At(sums, edge).edges += 1;
    lines += 2;
  }
  const SumsByEdge within = DrawnTowardsTheMean(sums);
  for (const EdgeResidualSet& edge : edges) {
    if (!HasLine(edge) || edge.common_sigma_px == 0) continue;
    const LineThroughResiduals line = FitLine(edge, Eigen::Matrix2d::Zero());
    const NoiseSums& own = within[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
    const Eigen::Matrix2d covariance = WithinVariance(own) * line.information.inverse();
    At(sums, edge).shift.Add(line.value_px[0], covariance(0, 0), edge.common_sigma_px, edge.common_weight);
    At(sums, edge).tilt.Add(line.value_px[1], covariance(1, 1), edge.common_sigma_px, edge.common_weight);
  }
  const double share = std::max(1 - parameters / std::max(lines, 1.0), 0.1);
  NoiseByEdge noise;
  const SumsByEdge drawn = DrawnTowardsTheMean(sums);
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (size_t j = 0; j < 2; ++j)
      noise[leg][j] = {std::sqrt(WithinVariance(drawn[leg][j])), drawn[leg][j].shift.Sigma(share),
                       drawn[leg][j].tilt.Sigma(share)};
  return noise;
}

// Root mean square of all residuals, as if nothing were common along the edges.
double SampleScale(const std::vector<EdgeResidualSet>& edges, double parameters) {
  double squares = 0, weight = 0;
  for (const EdgeResidualSet& edge : edges) {
    squares += (edge.weight.array() * (edge.residual_px.array() / edge.sigma_px.array()).square()).sum();
    weight += edge.weight.sum();
  }
  return std::max(
      std::sqrt(squares / std::max(weight - parameters, 1.0) / WeightedVarianceOfStandardNormal()),
      kLeastScale);
}

}  // namespace

double RobustWeight(double normalised) {
  const double size = std::abs(normalised);
  if (size <= kFullUpTo) return 1;
  if (!(size < kZeroFrom)) return 0;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * (size - kFullUpTo) / (kZeroFrom - kFullUpTo));
}

double SigmaFactor(double weight) {
  constexpr double kLeastWeight = 1e-8;
  return 1 / std::sqrt(std::max(weight, kLeastWeight));
}

double MedianScale(const std::vector<EdgeResidualSet>& edges) {
  std::vector<double> sizes;
  for (const EdgeResidualSet& edge : edges)
    for (Eigen::Index i = 0; i < edge.residual_px.size(); ++i)
      sizes.push_back(std::abs(edge.residual_px[i] / edge.sigma_px[i]));
  if (sizes.empty()) return 1;
  return std::max(kSigmaOfMedian * MedianOf(std::move(sizes)), kLeastScale);
}

NoiseByEdge EstimateNoise(const std::vector<EdgeResidualSet>& edges, double parameters) {
  const bool have_common = std::any_of(edges.begin(), edges.end(),
                                       [](const EdgeResidualSet& edge) { return edge.common_sigma_px > 0; });
  return have_common ? NoiseByLines(edges, parameters) : UniformNoise({SampleScale(edges, parameters), 1, 1});
}

void UpdateWeights(std::vector<EdgeResidualSet>& edges, const NoiseByEdge& noise) {
  for (EdgeResidualSet& edge : edges) {
    const EdgeNoise& own = noise[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
    Eigen::ArrayXd left = edge.residual_px;
    edge.common_weight = edge.trust = 1;
    if (edge.common_sigma_px > 0 && HasLine(edge)) {
      const Eigen::Vector2d common =
          Eigen::Array2d(own.shift, own.tilt).square() * std::pow(edge.common_sigma_px, 2);
      WeighAsAWhole(common, own.sample, edge);
      // FitLine counts in units of each sample's sigma: so must what is known of shift and tilt.
      const Eigen::Matrix2d prior =
          (std::pow(own.sample, 2) * edge.common_weight * common.cwiseInverse()).asDiagonal();
      const Eigen::Vector2d line = FitLine(edge, prior).value_px;
      left -= line[0] + line[1] * edge.place.array();
    }
    left /= own.sample * edge.sigma_px.array();
    edge.weight = left.unaryExpr([](double z) { return RobustWeight(z); });
  }
}

NoiseByEdge UniformNoise(const EdgeNoise& noise) {
  NoiseByEdge all;
  for (auto& of_leg : all) of_leg.fill(noise);
  return all;
}

EdgeNoise MeanNoise(const NoiseByEdge& noise) {
  double sample = 0, shift = 0, tilt = 0;
  for (const auto& of_leg : noise)
    for (const EdgeNoise& of_edge : of_leg) {
      sample += of_edge.sample * of_edge.sample / (2 * kLegCount);
      shift += of_edge.shift * of_edge.shift / (2 * kLegCount);
      tilt += of_edge.tilt * of_edge.tilt / (2 * kLegCount);
    }
  return {std::sqrt(sample), std::sqrt(shift), std::sqrt(tilt)};
}

}  // namespace legible
