#include "apps/intrinsics_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/calibrate_settings.h"
#include "apps/intrinsics_judgement.h"
#include "apps/program.h"
#include "apps/report_pictures.h"

namespace legible {
namespace {

using nlohmann::json;

// Short texts keep the page small.
double Rounded(double value, double steps_per_unit = 1e3) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

json PointJson(const Eigen::Vector2d& pixel) { return {Rounded(pixel.x(), 1e2), Rounded(pixel.y(), 1e2)}; }

void AddCorners(const IntrinsicsRun& run, size_t view, json& one) {
  const ViewFit& fit = run.result.views[view];
  one["corners"] = json::array();
  one["left_out_corners"] = json::array();
  for (size_t k = 0; k < run.input.views[view].corners.size(); ++k) {
    const Eigen::Vector2d& pixel = run.input.views[view].corners[k].pixel;
    const bool has_part = k < fit.weight.size();
    const Eigen::Vector2d residual = has_part ? fit.residual_px[k] : Eigen::Vector2d::Constant(NAN);
    const double weight = has_part ? fit.weight[k] : NAN;
    one["corners"].push_back({Rounded(pixel.x()), Rounded(pixel.y()), Rounded(residual.x(), 1e4),
                              Rounded(residual.y(), 1e4), Rounded(weight)});
  }
}

// What the detection left out: with a place it is drawn, without one it is told.
void AddLeftOut(const IntrinsicsRun& run, size_t view, json& one) {
  one["unused"] = json::array();
  for (const LeftOut& part : run.left_out[view]) {
    if (part.pixel)
      one["left_out_corners"].push_back({{"x", Rounded(part.pixel->x())},
                                         {"y", Rounded(part.pixel->y())},
                                         {"what", part.what},
                                         {"why", part.reason}});
    else
      one["unused"].push_back(part.what + " " + part.reason);
  }
}

json ViewJson(const IntrinsicsRun& run, size_t view) {
  const ViewFit& fit = run.result.views[view];
  json one = {{"name", run.input.views[view].name},
              {"width", run.input.width_px},
              {"height", run.input.height_px},
              {"left_out", fit.left_out.empty() ? json() : json(fit.left_out)}};
  if (fit.left_out.empty()) {
    one["rms_px"] = fit.rms_px;
    one["distance_m"] = fit.camera_from_board.translation.norm();
    if (const auto& tilt = run.coverage.tilts[view]) {
      one["tilt_rad"] = tilt->angle_rad;
      one["tilt_direction_rad"] = tilt->direction_rad;
    }
  }
  AddCorners(run, view, one);
  AddLeftOut(run, view, one);
  return one;
}

json ViewsJson(const IntrinsicsRun& run) {
  json views = json::array();
  for (size_t i = 0; i < run.input.views.size(); ++i) views.push_back(ViewJson(run, i));
  if (!run.settings.embeds_pictures || run.settings.corners) return views;
  std::vector<std::filesystem::path> files;
  for (const BoardView& view : run.input.views) files.push_back(view.file);
  const std::vector<std::string> pictures = EmbedPictures(files, run.settings.threads);
  for (size_t i = 0; i < pictures.size(); ++i)
    if (!pictures[i].empty()) views[i]["picture"] = pictures[i];
  return views;
}

json MapsJson(const IntrinsicsRun& run) {
  if (run.maps.empty()) return {};
  json maps = json::array();
  for (const UncertaintyMap& map : run.maps) {
    json sigmas = json::array();
    for (const auto& sigma_px : map.sigma_px)
      sigmas.push_back(sigma_px ? json(Rounded(*sigma_px, 1e6)) : json());
    maps.push_back({{"distance_m", std::isfinite(map.grid.distance_m) ? json(map.grid.distance_m) : json()},
                    {"sigma_px", sigmas}});
  }
  return {{"columns", run.maps.front().grid.columns}, {"rows", run.maps.front().grid.rows}, {"maps", maps}};
}

json HalvesMapJson(const IntrinsicsRun& run) {
  if (!run.halves.why_not.empty()) return {};
  json differences = json::array(), expected = json::array();
  for (const auto& expected_px : run.halves.expected_px)
    expected.push_back(expected_px ? json(Rounded(*expected_px, 1e5)) : json());
  for (const auto& difference : run.halves.difference_px)
    differences.push_back(difference ? json({Rounded(difference->x(), 1e5), Rounded(difference->y(), 1e5)})
                                     : json());
  return {
      {"columns", run.halves.grid.columns}, {"rows", run.halves.grid.rows}, {"difference_px", differences}};
}

json NextViewOutline(const IntrinsicsRun& run) {
  if (!run.next_view) return {};
  json outline = json::array();
  for (const Eigen::Vector2d& pixel : run.next_view->outline_px) outline.push_back(PointJson(pixel));
  return {{"outline_px", outline}};
}

json CorrelationsJson(const BoardCalibration& result) {
  const Eigen::MatrixXd covariance = result.information.CameraCovariance();
  json names = json::array(), matrix = json::array();
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    names.push_back("camera." + CameraParameterName(result.camera.lens, static_cast<int>(i)));
    json row = json::array();
    for (Eigen::Index j = 0; j < covariance.cols(); ++j)
      row.push_back(Rounded(covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)), 1e4));
    matrix.push_back(row);
  }
  return {{"names", names}, {"matrix", matrix}};
}

json OptionsJson(const IntrinsicsRun& run) {
  return {{"options given", OptionsText(run.settings)},
          {"lens", LensName(run.settings.lens)},
          {"board", BoardText(run.board)},
          {"board's bend", run.settings.board_fit.estimates_warp ? "estimated" : "none assumed"},
          {"outliers", run.settings.board_fit.trusts_all ? "every corner counts alike"
                                                         : "weighed down from 3 σ, left out from 6"},
          {"content hash of board and corners or images", run.content_hash}};
}

}  // namespace

json IntrinsicsReportData(const IntrinsicsRun& run, const nlohmann::ordered_json& document) {
  json data = {
      {"title", "Camera"},
      {"program_version", ProgramVersion()},
      {"board", BoardText(run.board)},
      {"views", ViewsJson(run)},
      {"maps", MapsJson(run)},
      {"halves", HalvesMapJson(run)},
      {"coverage",
       {{"columns", run.coverage.columns}, {"rows", run.coverage.rows}, {"corners", run.coverage.corners}}},
      {"next_view", NextViewOutline(run)},
      {"correlations", CorrelationsJson(run.result)},
      {"options", OptionsJson(run)}};
  data["intrinsics"] = document;
  return data;
}

}  // namespace legible
