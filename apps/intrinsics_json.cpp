#include "apps/intrinsics_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/camera_json.h"
#include "apps/intrinsics_judgement.h"
#include "apps/json_text.h"
#include "apps/program.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

// Distances that are infinite have no number in JSON.
ordered_json FiniteOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json OrNull(const std::string& text) { return text.empty() ? ordered_json() : ordered_json(text); }

CameraParameters SigmasOf(const BoardCalibration& result) {
  CameraParameters sigmas = CameraParameters::Zero();
  const Eigen::VectorXd variances = result.information.CameraCovariance().diagonal();
  sigmas.head(variances.size()) = variances.cwiseSqrt();
  return sigmas;
}

ordered_json CovarianceJson(const BoardCalibration& result) {
  const Eigen::MatrixXd covariance = result.information.CameraCovariance();
  ordered_json names = ordered_json::array(), rows = ordered_json::array();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    names.push_back(CameraParameterName(result.camera.lens, static_cast<int>(i)));
    rows.push_back(List(covariance.row(i).transpose()));
  }
  return {{"parameters", names}, {"rows", rows}};
}

ordered_json ViewsLeftOut(const IntrinsicsRun& run) {
  ordered_json list = ordered_json::array();
  for (size_t i = 0; i < run.result.views.size(); ++i)
    if (!run.result.views[i].left_out.empty())
      list.push_back({{"name", run.input.views[i].name}, {"why", run.result.views[i].left_out}});
  return list;
}

ordered_json UncertaintyJson(const IntrinsicsRun& run) {
  ordered_json list = ordered_json::array();
  for (const UncertaintyMap& map : run.maps)
    list.push_back({{"distance_m", FiniteOrNull(map.grid.distance_m)},
                    {"rms_px", map.rms_px},
                    {"worst_px", map.worst_px}});
  return list;
}

ordered_json HalvesJson(const IntrinsicsRun& run) {
  const HalvesComparison& halves = run.halves;
  const bool is_done = halves.why_not.empty();
  return {{"why_not", OrNull(halves.why_not)},
          {"difference_rms_px", is_done ? ordered_json(halves.difference_rms_px) : ordered_json()},
          {"expected_rms_px", is_done ? ordered_json(halves.expected_rms_px) : ordered_json()},
          {"ratio", is_done ? ordered_json(halves.ratio) : ordered_json()},
          {"ratio_limit", is_done ? ordered_json(halves.ratio_limit) : ordered_json()},
          {"misfit", halves.HasMisfit()},
          {"sigma_factor", run.result.widening},
          {"sentence", HalvesSentence(run)}};
}

ordered_json NextViewJson(const IntrinsicsRun& run) {
  if (!run.next_view) return {};
  const NextView& next = *run.next_view;
  return {{"sentence", NextViewSentence(run)},
          {"centre_px", List(next.centre_px)},
          {"tilt_rad", next.tilt.angle_rad},
          {"tilt_direction_rad", next.tilt.direction_rad},
          {"distance_m", next.distance_m},
          {"now_px", next.now_px},
          {"then_px", next.then_px}};
}

void AddFit(const IntrinsicsRun& run, ordered_json& json) {
  const BoardCalibration& result = run.result;
  const auto neighbours_px = run.NeighbourSigma_px();
  json["rms_px"] = result.rms_px;
  json["noise_px"] = result.corner_sigma_px;
  json["neighbour_noise_px"] = neighbours_px ? ordered_json(*neighbours_px) : ordered_json();
  json["views_used"] = ViewsUsed(result);
  json["views_left_out"] = ViewsLeftOut(run);
  json["corners_used"] = CornersOf(result) - result.corners_left_out;
  json["corners_left_out"] = result.corners_left_out;
  json["corners_not_measured"] = CornersNotMeasured(run);
  json["corners_weighed_down"] = CornersWeighedDown(result);
  json["board_warp_m"] = run.settings.board_fit.estimates_warp ? List(result.warp.bend_m) : ordered_json();
}

void AddProvenance(const IntrinsicsRun& run, ordered_json& json) {
  json["iterations"] = run.result.iterations;
  json["time_s"] = run.seconds;
  json["program_version"] = ProgramVersion();
  json["options"] = OptionsText(run.settings);
  json["content_hash"] = run.content_hash;
}

}  // namespace

ordered_json IntrinsicsJson(const IntrinsicsRun& run, const std::vector<std::string>& warnings) {
  const BoardCalibration& result = run.result;
  ordered_json json = {
      {"status", ToString(result.status)}, {"message", result.message}, {"warnings", warnings}};
  json["camera"] = CameraJson(result.camera, ParametersOf(result.camera));
  json["camera"]["sigma"] = CameraValues(SigmasOf(result), result.camera.lens);
  json["covariance"] = CovarianceJson(result);
  AddFit(run, json);
  json["uncertainty"] = UncertaintyJson(run);
  json["cross_validation"] = HalvesJson(run);
  json["coverage"] = {{"share", run.coverage.Share()},
                      {"largest_tilt_rad", run.coverage.LargestTilt()},
                      {"sentence", CoverageSentence(run)}};
  json["next_view"] = NextViewJson(run);
  AddProvenance(run, json);
  return json;
}

ordered_json FailureJson(const IntrinsicsRun& run) {
  ordered_json json = {{"status", ToString(run.result.status)},
                       {"message", run.result.message},
                       {"warnings", ordered_json::array()},
                       {"views_used", 0},
                       {"views_left_out", ViewsLeftOut(run)}};
  AddProvenance(run, json);
  return json;
}

}  // namespace legible
