#include "calib/expected_observation.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/vision/edge_curve.h"

namespace legible {
namespace {

constexpr size_t kLeastSamples = 3;  // MeasureLegEdges leaves out an edge with fewer

// Runs [first, last) of the edge's points that nothing hides.
std::vector<std::pair<size_t, size_t>> VisibleRuns(const PredictedEdge& edge) {
  std::vector<std::pair<size_t, size_t>> runs;
  for (size_t first = 0, last = 0; first < edge.points.size(); first = last + 1) {
    last = first;
    while (last < edge.points.size() && edge.points[last].obstacle == EdgeObstacle::kNone) ++last;
    if (last - first >= 2) runs.emplace_back(first, last);
  }
  return runs;
}

EdgeObservation ExpectEdge(const PredictedEdge& predicted, int leg, int edge,
                           const ExpectedEdgeOptions& options) {
  EdgeObservation observation{leg, edge, {}, options.common_sigma_px};
  const double points_a_sample = options.measured.sample_length_px / options.measured.visibility.step_px;
  for (const auto& [first, last] : VisibleRuns(predicted)) {
    const auto count = static_cast<double>(last - first);
    const auto samples = std::max(1.0, std::round(count / points_a_sample));
    for (double i = 0; i < samples; ++i) {
      const auto middle = first + static_cast<size_t>((i + 0.5) * count / samples);
      const PredictedEdgePoint& point = predicted.points[middle];
      observation.samples.push_back({point.point_px, point.normal_px, options.sample_sigma_px});
    }
  }
  return observation;
}

}  // namespace

void ExpectedEdgeOptions::Check() const {
  measured.Check();
  if (!(sample_sigma_px > 0)) throw std::invalid_argument("sample_sigma_px must be positive");
  if (!(common_sigma_px >= 0)) throw std::invalid_argument("common_sigma_px must not be negative");
}

ImageObservation ExpectObservation(const RigModel& model, const Rigid3& base_from_platform,
                                   const ExpectedEdgeOptions& options) {
  ImageObservation observation{"", InverseKinematics(model.robot, base_from_platform), {}};
  const LegsInCamera legs = PlaceLegs(model.robot, model.camera_from_base, base_from_platform);
  const PredictedEdges predicted = PredictEdges(legs, model.camera, options.measured.visibility);
  for (int leg = 0; leg < kLegCount; ++leg)
    for (int edge = 0; edge < 2; ++edge) {
      const PredictedEdge& of_leg = predicted[static_cast<size_t>(leg)][static_cast<size_t>(edge)];
      if (VisibleLength(of_leg) < options.measured.least_length_px) continue;
      EdgeObservation expected = ExpectEdge(of_leg, leg, edge, options);
      if (expected.samples.size() >= kLeastSamples) observation.edges.push_back(std::move(expected));
    }
  return observation;
}

}  // namespace legible
