// What shading leaves of the edges' places on the shipped ray-traced session, against what the renderer knew.
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "core/geometry/edge_distance.h"
#include "core/stopwatch.h"
#include "core/vision/leg_edges.h"
#include "tests/bench/bench_table.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

// Mean distance of an edge's samples from the true outline, px outward.
double MeanOffset(const LegEdge& edge, const LegsInCamera& legs, const Camera& camera) {
  const LegInCamera& leg = legs[static_cast<size_t>(edge.leg)];
  const Eigen::Vector3d normal = CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera),
                                                 leg.radius_m)[static_cast<size_t>(edge.edge)];
  double sum = 0;
  for (const EdgeSample& sample : edge.observation.samples)
    sum += DistanceToEdge(camera, normal, sample.point_px, sample.normal_px).value().distance_px;
  return sum / static_cast<double>(edge.observation.samples.size());
}

// Offsets of one edge of one leg, or of all of them, over the images.
struct Offsets {
  double count = 0, sum = 0, squares = 0, expected_squares = 0;

  void Add(double offset_px, double sigma_px) {
    count += 1;
    sum += offset_px;
    squares += offset_px * offset_px;
    expected_squares += sigma_px * sigma_px;
  }
  BenchTable::Row Row(const std::string& label) const {
    const double mean_px = sum / count;
    return {label,
            {{"edges", count},
             {"mean_px", mean_px},
             {"rms_px", std::sqrt(squares / count)},
             {"rms_about_mean_px", std::sqrt(std::max(squares / count - mean_px * mean_px, 0.0))},
             {"stated_sigma_px", std::sqrt(expected_squares / count)}}};
  }
};

std::vector<BenchTable> MeasureSession(const std::string& folder) {
  const RenderedTruth truth = ReadRenderedTruth(folder + "/truth.json");
  std::array<Offsets, 12> by_edge;
  Offsets pooled;
  double time_s = 0;
  for (const auto& [name, base_from_platform] : truth.images) {
    const std::filesystem::path file = std::filesystem::path(folder) / "images" / name;
    const auto image = ReadGrayImage(file);
    if (!image) throw std::runtime_error(file.string() + " cannot be read");
    const LegsInCamera legs = PlaceLegs(truth.robot, truth.camera_from_base, base_from_platform);
    const Stopwatch measuring;
    const LegEdges found = MeasureLegEdges(*image, legs, truth.camera, {});
    time_s += measuring.Seconds();
    for (size_t i = 0; i < by_edge.size(); ++i) {
      if (!found.edges[i].left_out.empty()) continue;
      const double offset_px = MeanOffset(found.edges[i], legs, truth.camera);
      by_edge[i].Add(offset_px, found.edges[i].observation.common_sigma_px);
      pooled.Add(offset_px, found.edges[i].observation.common_sigma_px);
    }
  }
  BenchTable table{"offsets of the edges of datasets/hexapod from the truth", {}};
  for (size_t i = 0; i < by_edge.size(); ++i)
    if (by_edge[i].count > 0)
      table.rows.push_back(
          by_edge[i].Row("leg " + std::to_string(i / 2 + 1) + " edge " + std::to_string(i % 2 + 1)));
  table.rows.push_back(pooled.Row("all"));
  const double images = static_cast<double>(truth.images.size());
  return {table, {"time of the edges of datasets/hexapod", {{"an image", {{"ms", 1e3 * time_s / images}}}}}};
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) {
  return legible::Report(legible::MeasureSession(LEGIBLE_SOURCE_DIR "/datasets/hexapod"), argc, argv);
}
