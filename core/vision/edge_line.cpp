#include "core/vision/edge_line.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "core/geometry/edge_distance.h"
#include "core/geometry/tangents.h"

namespace legible {
namespace {

constexpr int kRounds = 4;
constexpr double kOutlierSigmas = 4, kOutlierFloor_px = 0.1;

// Distances of the samples from the line, infinite where there is none, and the weighted normal equations of
// the change of the normal along the tangents.
struct LineEquations {
  std::vector<double> residuals_px;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
};

LineEquations EquationsAt(const Camera& camera, const Eigen::Vector3d& normal,
                          const Eigen::Matrix<double, 3, 2>& tangents,
                          const std::vector<EdgeSample>& samples) {
  LineEquations equations;
  for (const EdgeSample& sample : samples) {
    const auto distance = DistanceToEdge(camera, normal, sample.point_px, sample.normal_px);
    equations.residuals_px.push_back(distance ? distance->distance_px
                                              : std::numeric_limits<double>::infinity());
    if (!distance) continue;
    const Eigen::RowVector2d row = distance->d_distance_d_normal * tangents / sample.sigma_px;
    const double standardised = distance->distance_px / std::hypot(sample.sigma_px, kOutlierFloor_px);
    const double weight = 1 / (1 + std::pow(standardised / 2, 4));
    equations.information += weight * row.transpose() * row;
    equations.moment -= weight * row.transpose() * (distance->distance_px / sample.sigma_px);
  }
  return equations;
}

void KeepWhatLiesOnIt(const std::vector<EdgeSample>& samples, const std::vector<double>& residuals_px,
                      EdgeLine& line) {
  double squares = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (std::abs(residuals_px[i]) > std::max(kOutlierSigmas * samples[i].sigma_px, kOutlierFloor_px))
      continue;
    line.samples.push_back(samples[i]);
    squares += residuals_px[i] * residuals_px[i];
  }
  if (!line.samples.empty()) line.rms_px = std::sqrt(squares / static_cast<double>(line.samples.size()));
}

}  // namespace

EdgeLine FitEdgeLine(const Camera& camera, const Eigen::Vector3d& start_normal,
                     const std::vector<EdgeSample>& samples) {
  EdgeLine line;
  line.normal = start_normal;
  if (samples.size() < 2) {
    line.samples = samples;
    return line;
  }
  LineEquations equations;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(line.normal);
    equations = EquationsAt(camera, line.normal, tangents, samples);
    line.normal =
        (line.normal + tangents * equations.information.ldlt().solve(equations.moment)).normalized();
    line.normal_covariance = tangents * equations.information.inverse() * tangents.transpose();
  }
  KeepWhatLiesOnIt(samples, equations.residuals_px, line);
  return line;
}

}  // namespace legible
