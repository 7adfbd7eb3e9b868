#include "calib/reading_rounds.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calib/robust_weights.h"
#include "core/vision/median.h"

namespace legible {
namespace {

// Where a square that follows chi^2 stands among normal ones (Wilson and Hilferty); below the median: 0.
double AsNormal(double square, double freedom) {
  const double variance = 2 / (9 * freedom);
  return std::max((std::cbrt(square / freedom) - (1 - variance)) / std::sqrt(variance), 0.0);
}

}  // namespace

ReadingRounds::ReadingRounds(EstimationProblem& problem) : problem_(problem) {
  for (size_t unit = 0; unit < problem.units.size(); ++unit) {
    Row row{unit, {}};
    for (size_t leg = 0; leg < problem.units[unit].legs.size(); ++leg) {
      const LegObservation& observation = problem.units[unit].legs[leg];
      if (observation.reading_m) row.readings.push_back({leg, observation.reading_sigma_m});
    }
    count_ += static_cast<int>(row.readings.size());
    if (!row.readings.empty()) rows_.push_back(std::move(row));
  }
}

double ReadingRounds::Weight() const {
  double sum = 0;
  for (const Row& row : rows_) sum += row.weight * static_cast<double>(row.readings.size());
  return sum;
}

double ReadingRounds::Squares() const {
  double sum = 0;
  for (const Row& row : rows_) sum += row.weight * row.residual.squaredNorm();
  return sum;
}

double ReadingRounds::Rms() const {
  const double weight = Weight();
  return weight > 0 ? std::sqrt(Squares() / weight) : 0;
}

double ReadingRounds::MedianSquare() const {
  std::vector<double> squares;
  squares.reserve(rows_.size());
  for (const Row& row : rows_) squares.push_back(row.square / static_cast<double>(row.readings.size()));
  return MedianOf(std::move(squares));
}

double ReadingRounds::Scatter() const {
  constexpr double kMedianOfSix = 5.348 / 6;  // of chi^2 with as many freedoms, over them
  return rows_.empty() ? 0 : std::sqrt(MedianSquare() / kMedianOfSix);
}

std::vector<OutlyingReading> ReadingRounds::Outlying() const {
  constexpr double kHardlyCounts = 0.5;
  std::vector<OutlyingReading> outlying;
  for (const Row& row : rows_) {
    if (row.weight >= kHardlyCounts) continue;
    const PoseUnit& unit = problem_.units[row.unit];
    const Reading& worst = row.readings[row.worst];
    outlying.push_back({unit.image, unit.legs[worst.leg].leg, -row.worst_off * worst.sigma_m});
  }
  return outlying;
}

void ReadingRounds::Evaluate() {
  for (Row& row : rows_) {
    const Linearised at = Linearise(row);
    row.residual = at.residual;
    Predict(at, row);
  }
}

// The readings' residuals in their given sigmas, with their derivatives by the pose, and what the edges say
// of it. An image has readings of all its legs or of none; a leg that cannot be evaluated tells nothing.
ReadingRounds::Linearised ReadingRounds::Linearise(const Row& row) const {
  const double at_rest[6] = {};
  const PoseUnit& unit = problem_.units[row.unit];
  const auto count = static_cast<Eigen::Index>(row.readings.size());
  Linearised at{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, 6), Matrix6d::Zero()};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Reading& reading = row.readings[static_cast<size_t>(i)];
    const LegObservation& observation = unit.legs[reading.leg];
    const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(observation.leg)];
    const auto r = EvaluateLeg(CameraOf(problem_), leg, TipOf(unit, leg, at_rest), observation);
    if (!r) continue;
    const Eigen::Index edge_rows = r->residual.size() - 1;
    at.image.noalias() += r->d_pose.topRows(edge_rows).transpose() * r->d_pose.topRows(edge_rows);
    const double factor = observation.reading_sigma_m / reading.sigma_m;
    at.residual[i] = factor * r->residual[edge_rows];
    at.d_pose.row(i) = factor * r->d_pose.row(edge_rows);
  }
  for (const TagObservation& tag : unit.tags) {
    const auto r = EvaluateTag(CameraOf(problem_), problem_.tag_placements[tag.group], Vector6d::Zero(),
                               unit.camera_from_platform, Vector6d::Zero(), tag);
    if (r) at.image.noalias() += r->d_pose.transpose() * r->d_pose;
  }
  return at;
}

// What the image alone, without the readings, says that they should be: the pose follows them by their
// present weight, which is taken back first.
void ReadingRounds::Predict(const Linearised& at, Row& row) const {
  const PoseUnit& unit = problem_.units[row.unit];
  const Reading& first = row.readings.front();
  const double present_weight = std::pow(first.sigma_m / unit.legs[first.leg].reading_sigma_m, 2);
  const double ridge = 1e-9 * (1 + at.image.trace());
  const Eigen::MatrixXd by_image =
      at.d_pose * (at.image + ridge * Matrix6d::Identity()).ldlt().solve(at.d_pose.transpose());
  const Eigen::VectorXd off = at.residual + present_weight * by_image * at.residual;
  Eigen::MatrixXd covariance = by_image;
  covariance.diagonal().array() += 1;
  row.square = off.dot(covariance.ldlt().solve(off));
  const Eigen::VectorXd standardised = off.cwiseAbs().cwiseQuotient(covariance.diagonal().cwiseSqrt());
  Eigen::Index worst = 0;
  standardised.maxCoeff(&worst);
  row.worst = static_cast<size_t>(worst);
  row.worst_off = off[worst];
}

void ReadingRounds::Loosen(double scale) {
  constexpr double kLoose = 10;
  for (const Row& row : rows_) SetSigmas(row, kLoose * std::max(scale, 1.0));
}

double ReadingRounds::Reweight() {
  if (rows_.empty()) return 0;
  const double scale = std::max(MedianSquare(), 1.0);
  double change = 0;
  for (Row& row : rows_) {
    const double before = row.weight;
    row.weight = RobustWeight(AsNormal(row.square / scale, static_cast<double>(row.readings.size())));
    change += std::abs(row.weight - before) * static_cast<double>(row.readings.size());
    SetSigmas(row, SigmaFactor(row.weight));
  }
  return change;
}

void ReadingRounds::SetSigmas(const Row& row, double factor) {
  for (const Reading& reading : row.readings)
    problem_.units[row.unit].legs[reading.leg].reading_sigma_m = factor * reading.sigma_m;
}

}  // namespace legible
