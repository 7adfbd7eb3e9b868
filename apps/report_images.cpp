#include "apps/report_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/report_pictures.h"
#include "core/vision/predicted_legs.h"

namespace legible {
namespace {

using nlohmann::json;
using Residuals = std::vector<const EdgeResidualSet*>;

constexpr double kOutlineStep_px = 24;  // lenses bend an edge by less than 0.01 px over this
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Short texts keep the page small.
double Rounded(double value, double steps_per_unit = 1e3) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

struct ResidualSummary {
  double rms_px = kUnknown, mean_px = kUnknown;
};

// Weighted, as the estimation weighs them.
ResidualSummary Summarise(const Residuals& edges) {
  double weight = 0, sum = 0, squares = 0;
  for (const EdgeResidualSet* edge : edges) {
    const Eigen::VectorXd counted = edge->CountedWeight();
    weight += counted.sum();
    sum += counted.dot(edge->residual_px);
    squares += counted.dot(edge->residual_px.cwiseAbs2());
  }
  return weight > 0 ? ResidualSummary{std::sqrt(squares / weight), sum / weight} : ResidualSummary{};
}

// Where along the leg a point next to its edge lies, 0 at A and 1 at B.
double PlaceAlongLeg(const std::vector<PredictedEdgePoint>& outline, const Eigen::Vector2d& point_px) {
  double least = std::numeric_limits<double>::infinity(), place = kUnknown;
  for (size_t i = 1; i < outline.size(); ++i) {
    const PredictedEdgePoint &from = outline[i - 1], &to = outline[i];
    const Eigen::Vector2d step = to.point_px - from.point_px;
    const double share = std::clamp(step.dot(point_px - from.point_px) / step.squaredNorm(), 0.0, 1.0);
    const double distance = (from.point_px + share * step - point_px).norm();
    if (!(distance < least)) continue;
    least = distance;
    place = from.share + share * (to.share - from.share);
  }
  return place;
}

json OutlineJson(const std::vector<PredictedEdgePoint>& outline) {
  json points = json::array();
  for (const PredictedEdgePoint& point : outline)
    points.push_back({Rounded(point.point_px.x()), Rounded(point.point_px.y())});
  return points;
}

json SamplesJson(const LegEdge& edge, const EdgeResidualSet* residuals,
                 const std::vector<PredictedEdgePoint>& outline) {
  json samples = json::array();
  const Eigen::VectorXd weights = residuals ? residuals->CountedWeight() : Eigen::VectorXd();
  for (size_t i = 0; i < edge.observation.samples.size(); ++i) {
    const Eigen::Vector2d& point = edge.observation.samples[i].point_px;
    const auto row = static_cast<Eigen::Index>(i);
    const double residual_px = residuals ? residuals->residual_px[row] : kUnknown;
    const double weight = residuals ? weights[row] : kUnknown;
    samples.push_back({Rounded(point.x()), Rounded(point.y()), Rounded(residual_px, 1e4), Rounded(weight),
                       Rounded(PlaceAlongLeg(outline, point))});
  }
  return samples;
}

json EdgeJson(const LegEdge& edge, double blur_px, const Residuals& residuals_of_image,
              const PredictedEdges& predicted) {
  const auto own = std::find_if(
      residuals_of_image.begin(), residuals_of_image.end(),
      [&](const EdgeResidualSet* set) { return set->leg == edge.leg && set->edge == edge.edge; });
  const EdgeResidualSet* residuals = own == residuals_of_image.end() ? nullptr : *own;
  const auto& outline = predicted[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)].points;
  const ResidualSummary summary = residuals ? Summarise({residuals}) : ResidualSummary{};
  return {{"leg", edge.leg + 1},
          {"edge", edge.edge + 1},
          {"left_out", edge.left_out.empty() ? json() : json(edge.left_out)},
          {"rms_px", Rounded(summary.rms_px, 1e4)},
          {"shift_px", Rounded(summary.mean_px, 1e4)},
          {"blur_px", edge.left_out.empty() ? Rounded(blur_px) : kUnknown},
          {"samples", SamplesJson(edge, residuals, outline)},
          {"predicted", OutlineJson(outline)}};
}

PredictedEdges Predict(const LegCalibration& calibration, const std::optional<Rigid3>& camera_from_platform) {
  if (!camera_from_platform) return {};
  VisibilityOptions options;
  options.step_px = kOutlineStep_px;
  const Rigid3 base_from_platform = Inverse(calibration.camera_from_base) * *camera_from_platform;
  return PredictEdges(PlaceLegs(calibration.robot, calibration.camera_from_base, base_from_platform),
                      calibration.camera, options);
}

json ImageJson(const ImageOutcome& image, const Residuals& residuals, const PredictedEdges& predicted) {
  const std::string left_out = image.left_out;
  json edges = json::array();
  for (const LegEdge& edge : image.edges.edges)
    edges.push_back(EdgeJson(edge, image.edges.blur_px, residuals, predicted));
  return {{"name", image.name},
          {"left_out", left_out.empty() ? json() : json(left_out)},
          {"rms_px", Summarise(residuals).rms_px},
          {"held_out_rms_px", image.held_out_rms_px ? json(*image.held_out_rms_px) : json()},
          {"edges", edges}};
}

void AddPictures(const CalibrationRun& run, json& images) {
  std::vector<std::filesystem::path> files;
  for (const SessionImage& image : run.session.images) files.push_back(image.file);
  const std::vector<std::string> pictures = EmbedPictures(files, run.options.threads);
  for (size_t i = 0; i < pictures.size(); ++i)
    if (!pictures[i].empty()) images[i]["picture"] = pictures[i];
}

}  // namespace

json ReportImages(const CalibrationRun& run) {
  const auto residuals = ResidualsByImage(run.result);
  const auto platform = PlatformByImage(run);
  json images = json::array();
  for (size_t i = 0; i < run.result.images.size(); ++i) {
    const PredictedEdges predicted = Predict(run.result.calibration, platform[i]);
    images.push_back(ImageJson(run.result.images[i], residuals[i], predicted));
    images.back()["width"] = run.session.camera.width_px;
    images.back()["height"] = run.session.camera.height_px;
  }
  if (run.settings.embeds_pictures) AddPictures(run, images);
  return images;
}

}  // namespace legible
