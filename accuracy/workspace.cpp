#include "accuracy/workspace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace legible {
namespace {

constexpr double kStudent95Of15 = 2.1314495455593;  // two-sided, kReplicates - 1 degrees of freedom
constexpr Eigen::Index kBatch = 1 << 14;            // points that are evaluated at a time
static_assert(kReplicates == 16);

// One quantity over the inside of one replicate.
struct QuantityOfReplicate {
  double mean = 0, variance = 0;
  std::vector<double> quantiles;
  double smallest = 0, largest = 0;
};

struct Replicate {
  size_t points = 0, inside = 0, singular = 0;
  double allowed = 0;  // weight of inside and singular points
  std::vector<QuantityOfReplicate> quantities;
};

// The values of a quantity at which the weights of the smaller ones reach each part.
std::vector<double> WeightedQuantiles(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                                      const std::vector<double>& parts) {
  std::vector<Eigen::Index> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return values[a] < values[b]; });
  std::vector<double> quantiles;
  for (const double part : parts) {
    double reached = 0;
    size_t i = 0;
    while (i + 1 < order.size() && reached + weights[order[i]] < part) reached += weights[order[i++]];
    quantiles.push_back(values[order[i]]);
  }
  return quantiles;
}

// `weights` add up to 1.
QuantityOfReplicate Summarise(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                              const std::vector<double>& parts) {
  QuantityOfReplicate quantity;
  quantity.mean = weights.dot(values);
  quantity.variance = weights.dot((values.array() - quantity.mean).square().matrix());
  quantity.quantiles = WeightedQuantiles(values, weights, parts);
  quantity.smallest = values.minCoeff();
  quantity.largest = values.maxCoeff();
  return quantity;
}

Replicate Evaluate(const Box& box, const WeightedPoints& unit, const std::vector<double>& parts,
                   const BatchEvaluator& evaluate) {
  Replicate replicate;
  replicate.points = static_cast<size_t>(unit.weights.size());
  std::vector<double> weights;
  Eigen::MatrixXd inside;
  for (Eigen::Index first = 0; first < unit.weights.size(); first += kBatch) {
    const Eigen::Index count = std::min(kBatch, unit.weights.size() - first);
    const BatchValues batch = evaluate(InBox(box, unit.points.middleCols(first, count)));
    if (inside.size() == 0) inside.resize(batch.values.rows(), unit.weights.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      const PointState state = batch.states[static_cast<size_t>(i)];
      if (state == PointState::kOutside) continue;
      replicate.allowed += unit.weights[first + i];
      replicate.singular += state == PointState::kSingular;
      if (state == PointState::kSingular) continue;
      inside.col(static_cast<Eigen::Index>(replicate.inside++)) = batch.values.col(i);
      weights.push_back(unit.weights[first + i]);
    }
  }
  if (replicate.inside == 0) return replicate;
  Eigen::VectorXd normalised =
      Eigen::Map<Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  normalised /= normalised.sum();
  for (Eigen::Index row = 0; row < inside.rows(); ++row)
    replicate.quantities.push_back(
        Summarise(inside.row(row).head(normalised.size()).transpose(), normalised, parts));
  return replicate;
}

// Of one statistic over the replicates.
Enclosure Combine(const std::vector<double>& values, Certainty certainty) {
  if (certainty == Certainty::kRefinement) return {values.back(), std::abs(values.back() - values.front())};
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, kStudent95Of15 * std::sqrt(squares / (count - 1) / count)};
}

// `of(replicate)` gives the statistic.
template <typename F>
Enclosure Over(const std::vector<Replicate>& replicates, Certainty certainty, const F& of) {
  std::vector<double> values(replicates.size());
  std::transform(replicates.begin(), replicates.end(), values.begin(), of);
  return Combine(values, certainty);
}

QuantityStatistics CombineQuantity(const std::vector<Replicate>& replicates, size_t quantity,
                                   Certainty certainty, const std::vector<double>& parts) {
  const auto over = [&](const auto& member) {
    return Over(replicates, certainty, [&](const Replicate& r) { return member(r.quantities[quantity]); });
  };
  QuantityStatistics statistics;
  statistics.mean = over([](const QuantityOfReplicate& q) { return q.mean; });
  statistics.variance = over([](const QuantityOfReplicate& q) { return q.variance; });
  for (size_t i = 0; i < parts.size(); ++i)
    statistics.quantiles.push_back(
        {parts[i], over([i](const QuantityOfReplicate& q) { return q.quantiles[i]; })});
  statistics.smallest_seen = std::numeric_limits<double>::infinity();
  statistics.largest_seen = -statistics.smallest_seen;
  for (const Replicate& replicate : replicates) {
    statistics.smallest_seen = std::min(statistics.smallest_seen, replicate.quantities[quantity].smallest);
    statistics.largest_seen = std::max(statistics.largest_seen, replicate.quantities[quantity].largest);
  }
  return statistics;
}

}  // namespace

std::vector<Eigen::Index> Box::FreeCoordinates() const {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < low.size(); ++i)
    if (low[i] < high[i]) free.push_back(i);
  return free;
}

void Box::Check() const {
  if (low.size() != high.size() || !low.allFinite() || !high.allFinite() ||
      (low.array() > high.array()).any() || FreeCoordinates().empty())
    throw std::invalid_argument(
        "Box: give every coordinate a range that is not reversed, and one that is not empty");
}

void Sampling::Check() const {
  if (samples < kReplicates) throw std::invalid_argument("Sampling: at least 16 samples are needed");
}

const char* ToString(SamplingRule rule) {
  switch (rule) {
    case SamplingRule::kGrid:
      return "grid";
    case SamplingRule::kMonteCarlo:
      return "monte-carlo";
    case SamplingRule::kSobol:
      return "sobol";
    case SamplingRule::kGauss:
      return "gauss";
  }
  throw std::invalid_argument("ToString: not a SamplingRule");
}

WorkspaceStatistics SampleWorkspace(const Box& box, const StatisticsOptions& options,
                                    const BatchEvaluator& evaluate) {
  box.Check();
  options.sampling.Check();
  const bool is_gauss = options.sampling.rule == SamplingRule::kGauss;
  WorkspaceStatistics statistics;
  statistics.certainty = is_gauss ? Certainty::kRefinement : Certainty::kStatistical95;
  statistics.replicates = is_gauss ? 2 : kReplicates;
  const int dimension = static_cast<int>(box.FreeCoordinates().size());
  std::vector<Replicate> replicates;
  bool has_inside = true;
  for (int i = 0; i < statistics.replicates; ++i) {
    replicates.push_back(
        Evaluate(box, UnitCubePoints(options.sampling, dimension, i), options.quantiles, evaluate));
    statistics.samples += replicates.back().points;
    statistics.inside += replicates.back().inside;
    statistics.singular += replicates.back().singular;
    has_inside &= replicates.back().inside > 0;
    if (options.progress) options.progress(i + 1, statistics.replicates);
  }
  statistics.allowed_fraction =
      Over(replicates, statistics.certainty, [](const Replicate& r) { return r.allowed; });
  if (!has_inside) return statistics;
  for (size_t quantity = 0; quantity < replicates.front().quantities.size(); ++quantity)
    statistics.quantities.push_back(
        CombineQuantity(replicates, quantity, statistics.certainty, options.quantiles));
  return statistics;
}

}  // namespace legible
