#include "apps/calibration_json.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/camera_json.h"
#include "apps/intrinsics_judgement.h"
#include "apps/json_text.h"
#include "apps/judgement.h"
#include "apps/program.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

ordered_json OrNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json PlacementJson(const std::optional<Rigid3>& camera_from_base) {
  Eigen::Vector4d rotation_xyzw = Eigen::Vector4d::Constant(kUnknown);
  Eigen::Vector3d translation_m = Eigen::Vector3d::Constant(kUnknown);
  if (camera_from_base) {
    rotation_xyzw = camera_from_base->rotation.coeffs();
    translation_m = camera_from_base->translation;
  }
  return {{"rotation_xyzw", List(rotation_xyzw)}, {"translation_m", List(translation_m)}};
}

// Of a FoundLeg or its LegSigma.
template <typename Values>
ordered_json LegValues(const Values& leg) {
  return {{"base_joint_m", List(leg.base_joint_m)},
          {"base_joint_in_camera_m", List(leg.base_joint_in_camera_m)},
          {"platform_joint_m", List(leg.platform_joint_m)},
          {"radius_m", leg.radius_m},
          {"joint_offset_m", leg.joint_offset_m}};
}

ordered_json LegsJson(const FoundParameters& found) {
  ordered_json legs = ordered_json::array();
  for (const FoundLeg& leg : found.legs) {
    legs.push_back(LegValues(leg));
    legs.back()["sigma"] = LegValues(leg.sigma);
  }
  return legs;
}

ordered_json LeftOutJson(const CalibrationRun& run) {
  ordered_json left_out = ordered_json::array();
  for (const ImageOutcome& image : run.result.images)
    if (const std::string reason = image.left_out; !reason.empty())
      left_out.push_back({{"name", image.name}, {"reason", reason}});
  for (const std::string& name : run.session.unlisted_images)
    left_out.push_back({{"name", name}, {"reason", "has no row in joints.csv"}});
  return left_out;
}

ordered_json SentencesOf(const std::vector<WeakDirection>& directions) {
  ordered_json sentences = ordered_json::array();
  for (const WeakDirection& direction : directions) sentences.push_back(direction.description);
  return sentences;
}

ordered_json WeakJson(const std::vector<WeakDirection>& directions) {
  ordered_json weak = ordered_json::array();
  for (const WeakDirection& direction : directions)
    weak.push_back({{"description", direction.description}, {"relative_sigma", direction.relative_sigma}});
  return weak;
}

ordered_json HeldOutJson(const CalibrationRun& run) {
  ordered_json images = ordered_json::array();
  for (const ImageOutcome& image : run.result.images)
    if (image.held_out_rms_px) images.push_back({{"name", image.name}, {"rms_px", *image.held_out_rms_px}});
  return {{"rms_px", OrNull(run.result.held_out_rms_px)},
          {"folds", run.result.held_out_folds},
          {"folds_failed", run.result.held_out_folds_failed},
          {"images", images}};
}

ordered_json TagChecksJson(const std::vector<TagCheck>& checks) {
  ordered_json json = ordered_json::array();
  for (const TagCheck& check : checks)
    json.push_back({{"group", check.group},
                    {"took_part", check.took_part},
                    {"held_out", check.held_out},
                    {"images", check.images},
                    {"rms_px", check.rms_px},
                    {"rms_m", check.rms_m}});
  return json;
}

// Of the groups that counted as observations.
ordered_json TagFitsJson(const LegCalibration& calibration) {
  ordered_json json = ordered_json::array();
  for (const TagGroupFit& fit : calibration.tags)
    json.push_back({{"group", fit.group},
                    {"tags", fit.tags},
                    {"tags_left_out", fit.tags_left_out},
                    {"rms_px", fit.rms_px},
                    {"sigma_px", calibration.tag_sigma_px},
                    {"placement_sigmas", fit.placement_sigmas},
                    {"carrier_from_group", PlacementJson(fit.carrier_from_group)}});
  return json;
}

ordered_json TimesJson(const CalibrationRun& run) {
  const StageTimes& times = run.result.times;
  return {{"read", times.read_s},         {"detect", times.detect_s},
          {"solve", times.solve_s},       {"covariance", times.covariance_s},
          {"held_out", times.held_out_s}, {"report", run.report_s},
          {"total", times.total_s}};
}

// How well the model explains the observations; nothing is known of that where there was no fit.
void AddFit(const CalibrationRun& run, ordered_json& json) {
  const LegCalibration& calibration = run.result.calibration;
  const bool is_fitted = !calibration.edges.empty();
  const bool has_readings = is_fitted && run.options.estimation.use_joint_readings;
  const auto if_fitted = [&](double value) { return is_fitted ? value : kUnknown; };
  json["rms_px"] = if_fitted(calibration.rms_px);
  json["edge_sigma_px"] = if_fitted(calibration.edge_sigma_px);
  json["noise_factors"] = {{"sample", if_fitted(calibration.noise.sample)},
                           {"shift", if_fitted(calibration.noise.shift)},
                           {"tilt", if_fitted(calibration.noise.tilt)}};
  json["joint_reading_rms_sigma"] = has_readings ? calibration.reading_rms : kUnknown;
  json["joint_reading_scatter"] = has_readings ? calibration.reading_scatter : kUnknown;
  json["weights_steady"] = calibration.weights_steady;
  json["joint_readings_left_out"] = OutlyingReadingSentences(run);
  json["iterations"] = calibration.iterations;
}

void AddObservations(const CalibrationRun& run, ordered_json& json) {
  json["images_used"] = CountUsedImages(run.result);
  json["images_left_out"] = LeftOutJson(run);
  json["edges_used"] = CountEdges(run.result).used;
  json["samples_used"] = run.result.calibration.samples;
}

void AddParameters(const CalibrationRun& run, const FoundParameters& found, ordered_json& json) {
  const Camera& camera = run.result.guessed_camera;
  json["camera"] = CameraJson(camera, found.camera);
  json["camera"]["sigma"] = CameraValues(found.camera_sigma, camera.lens);
  json["camera_from_base"] = PlacementJson(found.camera_from_base);
  json["legs"] = LegsJson(found);
}

// Of images of a board that were solved together with the legs.
ordered_json BoardJson(const CalibrationRun& run) {
  if (!run.board) return {};
  return {{"file", run.settings.board->string()},
          {"views_used", ViewsUsed(run.board->result)},
          {"alone", CameraJson(run.board->result.camera, ParametersOf(run.board->result.camera))},
          {"rms_px", run.board->result.rms_px},
          {"content_hash", run.board->content_hash}};
}

void AddProvenance(const CalibrationRun& run, ordered_json& json) {
  json["program_version"] = ProgramVersion();
  json["session"] = SessionPath(run);
  json["content_hash"] = run.content_hash;
  json["options"] = OptionsText(run.settings);
  json["board"] = BoardJson(run);
  json["first_camera_pose_from"] = run.result.first_pose_from;
}

}  // namespace

ordered_json CalibrationJson(const CalibrationRun& run, const FoundParameters& found,
                             const std::vector<std::string>& warnings) {
  const LegCalibration& calibration = run.result.calibration;
  ordered_json json = {{"status", ToString(calibration.status)},
                       {"message", WhyThereIsNoModel(run)},
                       {"assumption", AssumptionText(run.settings, run.session.known)}};
  json["warnings"] = warnings;
  AddFit(run, json);
  AddObservations(run, json);
  AddParameters(run, found, json);
  json["unobservable"] = SentencesOf(calibration.observability.unobservable);
  json["weak"] = WeakJson(calibration.observability.weak);
  json["held_out"] = HeldOutJson(run);
  json["tags"] = TagFitsJson(calibration);
  json["tag_checks"] = TagChecksJson(run.result.tag_checks);
  json["time_s"] = TimesJson(run);
  AddProvenance(run, json);
  return json;
}

ordered_json NominalJson(const CalibrationRun& run) {
  ordered_json legs = ordered_json::array();
  for (const Leg& leg : run.session.robot.legs)
    legs.push_back({{"base_joint_m", List(leg.base_joint_m)},
                    {"platform_joint_m", List(leg.platform_joint_m)},
                    {"radius_m", leg.radius_m},
                    {"joint_offset_m", leg.joint_offset_m}});
  const Camera& camera = run.result.guessed_camera;
  return {{"camera", CameraJson(camera, ParametersOf(camera))}, {"legs", legs}};
}

}  // namespace legible
