#include "apps/calibration_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/calibration_json.h"
#include "apps/program.h"

namespace legible {
namespace {

using nlohmann::json;

constexpr const char* kAxes[] = {"x", "y", "z"};

// Of the parameters that were estimated and that a number may be given for.
json CorrelationsJson(const LegCalibration& calibration) {
  if (calibration.status != CalibrationStatus::kConverged) return {};
  const ModelCovariance model = CovarianceOfModel(calibration);
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < model.covariance.rows(); ++i)
    if (model.WasEstimated(i)) shown.push_back(i);
  json names = json::array(), matrix = json::array();
  for (const Eigen::Index i : shown) {
    names.push_back(model.names[static_cast<size_t>(i)]);
    json row = json::array();
    for (const Eigen::Index j : shown) {
      const double scale = std::sqrt(model.covariance(i, i) * model.covariance(j, j));
      row.push_back(std::round(1e4 * model.covariance(i, j) / scale) / 1e4);
    }
    matrix.push_back(row);
  }
  return {{"names", names}, {"matrix", matrix}};
}

// Collects what was said beforehand of parameters that were estimated, and what was found.
class PriorList {
 public:
  void Add(const std::string& name, double value, const std::optional<double>& sigma, double found,
           double found_sigma) {
    if (!sigma || !(found_sigma > 0)) return;  // nothing said; held, or not known
    list_.push_back({{"name", name},
                     {"value", value},
                     {"sigma", *sigma},
                     {"found", found},
                     {"pull_sigma", (found - value) / *sigma}});
  }
  void AddPoint(const std::string& name, const Eigen::Vector3d& value, const std::optional<double>& sigma,
                const Eigen::Vector3d& found, const Eigen::Vector3d& found_sigma) {
    for (int i = 0; i < 3; ++i) Add(name + "." + kAxes[i], value[i], sigma, found[i], found_sigma[i]);
  }
  json Take() { return std::move(list_); }

 private:
  json list_ = json::array();
};

void AddCameraPriors(const CalibrationRun& run, const FoundParameters& found, PriorList& priors) {
  const PriorKnowledge& known = run.session.known;
  const CameraParameters guess = ParametersOf(run.session.camera);
  for (int i = 0; i < kCameraParameterCount; ++i) {
    const auto& sigma = i < 2 ? known.focal_length_px : i < 4 ? known.principal_point_px : known.distortion;
    priors.Add(ParameterName(i), guess[i], sigma, found.camera[i], found.camera_sigma[i]);
  }
}

// The base joints are known up to where the base as a whole is, and the base frame is the rigid fit to the
// drawing: in that frame found minus drawn is what is compared with their sigma. The same holds for the
// platform.
json PriorsJson(const CalibrationRun& run, const FoundParameters& found) {
  PriorList priors;
  AddCameraPriors(run, found, priors);
  const PriorKnowledge& known = run.session.known;
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& drawn = run.session.robot.legs[i];
    const FoundLeg& leg = found.legs[i];
    const std::string name = fmt::format("legs[{}].", i + 1);
    priors.AddPoint(name + "base_joint_m", drawn.base_joint_m, known.base_joint_m, leg.base_joint_m,
                    leg.sigma.base_joint_m);
    priors.AddPoint(name + "platform_joint_m", drawn.platform_joint_m, known.platform_joint_m,
                    leg.platform_joint_m, leg.sigma.platform_joint_m);
    priors.Add(name + "radius_m", drawn.radius_m, known.radius_m, leg.radius_m, leg.sigma.radius_m);
    priors.Add(name + "joint_offset_m", drawn.joint_offset_m, known.joint_offset_m, leg.joint_offset_m,
               leg.sigma.joint_offset_m);
  }
  return priors.Take();
}

json ReadingsCheck(const CalibrationRun& run) {
  const LegCalibrationOptions& estimation = run.options.estimation;
  const double sigma_m = run.session.known.joint_reading_m.value_or(estimation.default_joint_reading_sigma_m);
  return {
      {"name", "joint readings"},
      {"text", fmt::format("they miss the model's leg lengths by {:.2f} of their σ of {:.3g} mm (they take "
                           "part in the fit; much more than 1 means that σ is too small, or a leg bends)",
                           run.result.calibration.reading_rms, 1e3 * sigma_m)},
      {"mm", 1e3 * sigma_m * run.result.calibration.reading_rms}};
}

json ChecksJson(const CalibrationRun& run) {
  json checks = json::array();
  for (const TagCheck& check : run.result.tag_checks)
    checks.push_back({{"name", "tags " + check.group},
                      {"text", TagSentence(run.session, check)},
                      {"rms_px", check.rms_px},
                      {"mm", 1e3 * check.rms_m}});
  for (const TagGroupFit& fit : run.result.calibration.tags)
    checks.push_back({{"name", "tags " + fit.group + " as observations"},
                      {"text", TagFitSentence(run.result.calibration, fit)},
                      {"rms_px", fit.rms_px}});
  const bool has_readings = run.options.estimation.use_joint_readings &&
                            run.result.calibration.status == CalibrationStatus::kConverged;
  if (has_readings) checks.push_back(ReadingsCheck(run));
  return checks;
}

json OptionsJson(const CalibrationRun& run) {
  json known = json::object();
  for (const auto& [name, sigma] : NamedKnowledge(run.session.known)) known[name] = sigma;
  return {{"options given", OptionsText(run.settings)},
          {"assumption", AssumptionText(run.settings, run.session.known)},
          {"lens", LensName(run.options.lens.value_or(run.session.camera.lens))},
          {"held", run.settings.hold},
          {"known beforehand (σ)", known},
          {"first camera pose from", run.result.first_pose_from},
          {"folds of the held-out images", run.options.folds},
          {"content hash of the session", run.content_hash}};
}

}  // namespace

json ReportData(const CalibrationRun& run, const FoundParameters& found,
                const nlohmann::ordered_json& calibration, const json& images) {
  json data = {{"title", run.session.robot.name.empty() ? "Hexapod" : run.session.robot.name},
               {"program_version", ProgramVersion()},
               {"session", SessionPath(run)},
               {"images", images},
               {"correlations", CorrelationsJson(run.result.calibration)},
               {"priors", PriorsJson(run, found)},
               {"checks", ChecksJson(run)},
               {"options", OptionsJson(run)}};
  data["calibration"] = calibration;
  data["nominal"] = NominalJson(run.session);
  data["weak"] = calibration.at("weak");
  return data;
}

}  // namespace legible
