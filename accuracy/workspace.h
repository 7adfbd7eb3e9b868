// Statistics over a workspace by sampling, with an honest error estimate. The vocabulary (box, statistic,
// enclosure) is that of any evaluator, also of one that certifies what it says.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace legible {

// Ranges of coordinates, in the measure dx dy … of these coordinates; one of no width is held.
struct Box {
  Eigen::VectorXd low, high;

  std::vector<Eigen::Index> FreeCoordinates() const;
  void Check()
      const;  // throws std::invalid_argument: sizes differ, a range reversed, nothing free, not finite
};

// A value and how far the truth may lie from it, with the certainty that the whole result names.
struct Enclosure {
  double value = 0;
  double half_width = 0;

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

enum class Certainty {
  kStatistical95,  // the truth lies in the enclosure with 95 %: Student's t of independent randomised
                   // replicates
  kRefinement,     // half width = change from half as many panels: an estimate, good where the integrand is
                   // smooth
};

enum class SamplingRule {
  kGrid,        // midpoints of equal cells, moved as a whole by a random shift in each replicate
  kMonteCarlo,  // independent uniform points
  kSobol,       // Sobol's sequence, digitally shifted at random in each replicate
  kGauss,       // products of Gauss-Legendre panels: exact to many digits where the integrand is smooth
};
const char* ToString(SamplingRule rule);  // "grid", "monte-carlo", "sobol", "gauss"

struct Sampling {
  SamplingRule rule = SamplingRule::kSobol;
  // Points in all, split among the replicates; rounded to what the rule can do (a power of 2 a replicate for
  // Sobol, a power of the dimension for grids).
  size_t samples = 1 << 16;
  std::uint64_t seed = 1;

  // Throws std::invalid_argument for fewer than 16 or more than kMostSamples, and where Gauss' rule, which
  // takes 20 nodes along each axis at least, would need more of them than that.
  void Check(int dimension) const;
};
inline constexpr int kReplicates = 16;
inline constexpr size_t kMostSamples = 10'000'000;  // they are kept, for quantiles

// Points inside that each replicate needs for any statistics, and beyond a quantile on either side for that.
inline constexpr size_t kLeastInside = 10;
inline constexpr double kLeastBeyondQuantile = 10;

// What is known of each point of a batch.
enum class PointState {
  kInside,        // counts
  kNearSingular,  // counts, but its errors are very large
  kSingular,      // in the set, but without finite errors
  kOutside,       // not in the set, such as beyond a joint's range
};
struct BatchValues {
  Eigen::MatrixXd values;  // a row a quantity, a column a point; read only where the point counts
  std::vector<PointState> states;
};
// Called with points a column each, of all coordinates of the box.
using BatchEvaluator = std::function<BatchValues(const Eigen::MatrixXd& points)>;

// Its enclosure is NaN where too few points tell: see kLeastBeyondQuantile.
struct Quantile {
  double part = 0;
  Enclosure at;
};

struct QuantityStatistics {
  Enclosure mean, variance;
  std::vector<Quantile> quantiles;
  double smallest_seen = 0, largest_seen = 0;
};

struct WorkspaceStatistics {
  Certainty certainty = Certainty::kStatistical95;
  size_t samples = 0, inside = 0, near_singular = 0, singular = 0;  // near singular ones are inside
  int replicates = 0;
  Enclosure allowed_fraction;  // of the box's volume that is in the set, singular points included
  std::vector<QuantityStatistics> quantities;  // empty where some replicate has hardly a point inside
};

struct StatisticsOptions {
  Sampling sampling;
  std::vector<double> quantiles = {0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
  std::function<void(int done, int total)> progress;
};

// Values are those of all replicates' points together, half widths follow from how they differ between
// replicates. Means are over the inside of the set. Throws std::invalid_argument for a box or a sampling that
// does not pass Check.
WorkspaceStatistics SampleWorkspace(const Box& box, const StatisticsOptions& options,
                                    const BatchEvaluator& evaluate);

// Points of one replicate in the unit cube of `dimension`, a column each, with weights that add up to 1.
struct WeightedPoints {
  Eigen::MatrixXd points;
  Eigen::VectorXd weights;
};
WeightedPoints UnitCubePoints(const Sampling& sampling, int dimension, int replicate);

// The points of a unit cube taken to the box; what the box holds is filled in.
Eigen::MatrixXd InBox(const Box& box, const Eigen::MatrixXd& unit_points);

}  // namespace legible
