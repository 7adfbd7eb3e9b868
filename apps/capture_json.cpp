#include "apps/capture_json.h"

#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/program.h"

namespace legible {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json ExpectedJson(const ExpectedSigma& sigma) {
  return {{"position_m", OrNull(sigma.position_m)},
          {"rotation_rad", OrNull(sigma.rotation_rad)},
          {"focal_length_px", OrNull(sigma.focal_length_px)},
          {"principal_point_px", OrNull(sigma.principal_point_px)},
          {"base_joint_m", OrNull(sigma.base_joint_m)},
          {"platform_joint_m", OrNull(sigma.platform_joint_m)},
          {"radius_m", OrNull(sigma.radius_m)},
          {"joint_offset_m", OrNull(sigma.joint_offset_m)}};
}

Json PoseJson(const Rigid3& pose) {
  return {{"rotation_xyzw", List(pose.rotation.coeffs())}, {"translation_m", List(pose.translation)}};
}

Json TimesJson(const CaptureTimes& times) {
  return {{"propose", times.propose_s}, {"drive", times.drive_s}, {"image", times.image_s},
          {"look", times.look_s},       {"store", times.store_s}, {"outlook", times.outlook_s}};
}

Json ImageJson(const CapturedImage& image) {
  Json json = {{"name", image.name},
               {"base_from_platform", PoseJson(image.base_from_platform)},
               {"joint_readings_m", List(image.joint_readings_m)},
               {"edges", image.edges},
               {"expected_sigma", ExpectedJson(image.expected)},
               {"time_s", TimesJson(image.times)}};
  if (!image.unusable.empty()) json["unusable"] = image.unusable;
  return json;
}

}  // namespace

Json CaptureJson(const PreparedCapture& prepared, const CaptureRun& run) {
  Json taken = Json::array(), rejected = Json::array();
  for (const CapturedImage& image : run.images) taken.push_back(ImageJson(image));
  std::vector<std::string> warnings = prepared.warnings;
  warnings.insert(warnings.end(), run.warnings.begin(), run.warnings.end());
  for (const RejectedPose& pose : run.rejected)
    rejected.push_back({{"name", pose.name},
                        {"base_from_platform", PoseJson(pose.base_from_platform)},
                        {"reason", pose.reason}});
  return {{"status", run.is_complete ? "complete" : "stopped"},
          {"reason", run.reason},
          {"images", prepared.session->session().images.size()},
          {"images_before", run.images_before},
          {"expected_sigma", ExpectedJson(run.expected)},
          {"taken", taken},
          {"rejected", rejected},
          {"rig_time_s", run.rig_time_s},
          {"warnings", warnings},
          {"session", std::filesystem::absolute(prepared.settings.out).lexically_normal().string()},
          {"rig", prepared.settings.rig},
          {"program_version", ProgramVersion()}};
}

}  // namespace legible
