#include "accuracy/workspace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "accuracy/gauss_legendre.h"

namespace legible {
namespace {

constexpr double kStudent95Of15 = 2.1314495455593;  // two-sided, kReplicates - 1 degrees of freedom
constexpr Eigen::Index kBatch = 1 << 14;            // points that are evaluated at a time
static_assert(kReplicates == 16);
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// The points of one replicate that count.
struct Replicate {
  size_t points = 0, inside = 0, near_singular = 0, singular = 0;
  double allowed = 0;      // weight of all in the set
  Eigen::MatrixXd values;  // a row a quantity, a column a point inside
  Eigen::VectorXd weights;
};

// One quantity over points, whose weights add up to 1.
struct Summary {
  double mean = 0, variance = 0;
  std::vector<double> quantiles;
};

// The values of a quantity at which the weights of the smaller ones reach each part.
std::vector<double> WeightedQuantiles(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                                      const std::vector<double>& parts) {
  std::vector<Eigen::Index> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return values[a] < values[b]; });
  std::vector<double> quantiles(parts.size());
  for (size_t k = 0; k < parts.size(); ++k) {
    double reached = 0;
    size_t i = 0;
    while (i + 1 < order.size() && reached + weights[order[i]] < parts[k]) reached += weights[order[i++]];
    quantiles[k] = values[order[i]];
  }
  return quantiles;
}

Summary Summarise(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                  const std::vector<double>& parts) {
  Summary summary;
  const auto count = static_cast<double>(values.size());
  summary.mean = weights.dot(values);
  summary.variance = weights.dot((values.array() - summary.mean).square().matrix()) * count / (count - 1);
  summary.quantiles = WeightedQuantiles(values, weights, parts);
  return summary;
}

Replicate Evaluate(const Box& box, const WeightedPoints& unit, const BatchEvaluator& evaluate) {
  Replicate replicate;
  replicate.points = static_cast<size_t>(unit.weights.size());
  replicate.weights.resize(unit.weights.size());
  Eigen::Index next = 0;
  for (Eigen::Index first = 0; first < unit.weights.size(); first += kBatch) {
    const Eigen::Index count = std::min(kBatch, unit.weights.size() - first);
    const BatchValues batch = evaluate(InBox(box, unit.points.middleCols(first, count)));
    if (replicate.values.size() == 0) replicate.values.resize(batch.values.rows(), unit.weights.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      const PointState state = batch.states[static_cast<size_t>(i)];
      if (state == PointState::kOutside) continue;
      replicate.allowed += unit.weights[first + i];
      replicate.near_singular += state == PointState::kNearSingular;
      replicate.singular += state == PointState::kSingular;
      if (state == PointState::kSingular) continue;
      replicate.weights[next] = unit.weights[first + i];
      replicate.values.col(next++) = batch.values.col(i);
    }
  }
  replicate.inside = static_cast<size_t>(next);
  replicate.values.conservativeResize(Eigen::NoChange, next);
  replicate.weights.conservativeResize(next);
  return replicate;
}

// How a value of all points together, and the same of each replicate, enclose the truth.
Enclosure Enclose(double together, const std::vector<double>& of_replicates, Certainty certainty) {
  if (certainty == Certainty::kRefinement)
    return {of_replicates.back(), std::abs(of_replicates.back() - of_replicates.front())};
  const double count = static_cast<double>(of_replicates.size());
  const double mean = std::accumulate(of_replicates.begin(), of_replicates.end(), 0.0) / count;
  double squares = 0;
  for (const double value : of_replicates) squares += (value - mean) * (value - mean);
  return {together, kStudent95Of15 * std::sqrt(squares / (count - 1) / count)};
}

// `of(summary)` gives the statistic.
template <typename F>
Enclosure Over(const Summary& together, const std::vector<Summary>& of_replicates, Certainty certainty,
               const F& of) {
  std::vector<double> values(of_replicates.size());
  std::transform(of_replicates.begin(), of_replicates.end(), values.begin(), of);
  return Enclose(of(together), values, certainty);
}

// The points of all replicates that make up the value: of Gauss' rule the finer ones only.
struct Pool {
  Eigen::Index first_replicate = 0, points = 0;
};
Pool PoolOf(const std::vector<Replicate>& replicates, Certainty certainty) {
  Pool pool;
  if (certainty == Certainty::kRefinement)
    pool.first_replicate = static_cast<Eigen::Index>(replicates.size()) - 1;
  for (auto i = static_cast<size_t>(pool.first_replicate); i < replicates.size(); ++i)
    pool.points += static_cast<Eigen::Index>(replicates[i].inside);
  return pool;
}

Summary SummariseTogether(const std::vector<Replicate>& replicates, Eigen::Index quantity, const Pool& pool,
                          const std::vector<double>& parts) {
  Eigen::VectorXd values(pool.points), weights(pool.points);
  Eigen::Index next = 0;
  for (auto i = static_cast<size_t>(pool.first_replicate); i < replicates.size(); ++i) {
    const Eigen::Index count = replicates[i].weights.size();
    values.segment(next, count) = replicates[i].values.row(quantity).transpose();
    weights.segment(next, count) = replicates[i].weights;
    next += count;
  }
  return Summarise(values, weights / weights.sum(), parts);
}

size_t LeastInside(const std::vector<Replicate>& replicates) {
  return std::min_element(replicates.begin(), replicates.end(),
                          [](const Replicate& a, const Replicate& b) { return a.inside < b.inside; })
      ->inside;
}

QuantityStatistics StatisticsOf(const std::vector<Replicate>& replicates, Eigen::Index quantity,
                                Certainty certainty, const std::vector<double>& parts) {
  const Summary together = SummariseTogether(replicates, quantity, PoolOf(replicates, certainty), parts);
  std::vector<Summary> each;
  each.reserve(replicates.size());
  QuantityStatistics statistics;
  statistics.smallest_seen = std::numeric_limits<double>::infinity();
  statistics.largest_seen = -statistics.smallest_seen;
  for (const Replicate& replicate : replicates) {
    const Eigen::VectorXd values = replicate.values.row(quantity).transpose();
    each.push_back(Summarise(values, replicate.weights / replicate.weights.sum(), parts));
    statistics.smallest_seen = std::min(statistics.smallest_seen, values.minCoeff());
    statistics.largest_seen = std::max(statistics.largest_seen, values.maxCoeff());
  }
  statistics.mean = Over(together, each, certainty, [](const Summary& s) { return s.mean; });
  statistics.variance = Over(together, each, certainty, [](const Summary& s) { return s.variance; });
  for (size_t i = 0; i < parts.size(); ++i) {
    // Where few points lie beyond it a replicate's quantile is no estimate of it, and its scatter none of the
    // error.
    const double beyond = static_cast<double>(LeastInside(replicates)) * std::min(parts[i], 1 - parts[i]);
    const bool is_told = beyond >= kLeastBeyondQuantile;
    statistics.quantiles.push_back(
        {parts[i], is_told ? Over(together, each, certainty, [i](const Summary& s) { return s.quantiles[i]; })
                           : Enclosure{kUnknown, kUnknown}});
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

void Sampling::Check(int dimension) const {
  if (samples < kReplicates) throw std::invalid_argument("at least 16 samples are needed");
  if (samples > kMostSamples) throw std::invalid_argument("more than 10000000 samples do not fit");
  const double fewest = std::pow(2 * kNodesPerPanel, dimension);
  if (rule == SamplingRule::kGauss && fewest > static_cast<double>(samples))
    throw std::invalid_argument("gauss takes 20 nodes along each axis at least, " +
                                std::to_string(static_cast<std::int64_t>(fewest)) +
                                " in all: give as many samples, or sobol");
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
  const int dimension = static_cast<int>(box.FreeCoordinates().size());
  options.sampling.Check(dimension);
  const bool is_gauss = options.sampling.rule == SamplingRule::kGauss;
  WorkspaceStatistics statistics;
  statistics.certainty = is_gauss ? Certainty::kRefinement : Certainty::kStatistical95;
  statistics.replicates = is_gauss ? 2 : kReplicates;
  std::vector<Replicate> replicates;
  std::vector<double> allowed;
  for (int i = 0; i < statistics.replicates; ++i) {
    replicates.push_back(Evaluate(box, UnitCubePoints(options.sampling, dimension, i), evaluate));
    statistics.samples += replicates.back().points;
    statistics.inside += replicates.back().inside;
    statistics.near_singular += replicates.back().near_singular;
    statistics.singular += replicates.back().singular;
    allowed.push_back(replicates.back().allowed);
    if (options.progress) options.progress(i + 1, statistics.replicates);
  }
  const double mean_allowed =
      std::accumulate(allowed.begin(), allowed.end(), 0.0) / static_cast<double>(allowed.size());
  statistics.allowed_fraction = Enclose(mean_allowed, allowed, statistics.certainty);
  if (LeastInside(replicates) < kLeastInside) return statistics;
  for (Eigen::Index quantity = 0; quantity < replicates.front().values.rows(); ++quantity)
    statistics.quantities.push_back(
        StatisticsOf(replicates, quantity, statistics.certainty, options.quantiles));
  return statistics;
}

}  // namespace legible
