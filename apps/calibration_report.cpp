#include "apps/calibration_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/calibration_json.h"
#include "apps/intrinsics_judgement.h"
#include "apps/prior_pulls.h"
#include "apps/program.h"
#include "apps/wording.h"

namespace legible {
namespace {

using nlohmann::json;

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

json PriorsJson(const std::vector<PriorPull>& pulls) {
  json list = json::array();
  for (const PriorPull& one : pulls)
    list.push_back({{"name", one.name},
                    {"value", one.value},
                    {"sigma", one.sigma},
                    {"found", one.found},
                    {"pull_sigma", one.pull}});
  return list;
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
  if (run.session.known.camera_information.size() > 0) known["camera"] = "as a board told it";
  return {
      {"options given", OptionsText(run.settings)},
      {"assumption", AssumptionText(run.settings, run.session.known)},
      {"lens", LensName(run.result.guessed_camera.lens)},
      {"held", run.settings.hold},
      {"known beforehand (σ)", known},
      {"board", run.board ? fmt::format("{}, {} of {}, solved together", BoardText(run.board->board),
                                        Plural(ViewsUsed(run.board->result), "view"), run.board->board.name)
                          : std::string("none")},
      {"first camera pose from", run.result.first_pose_from},
      {"folds of the held-out images", run.options.folds},
      {run.board ? "content hash of session and board" : "content hash of the session", run.content_hash}};
}

}  // namespace

json ReportData(const CalibrationRun& run, const FoundParameters& found,
                const nlohmann::ordered_json& calibration, const json& images) {
  json data = {{"title", run.session.robot.name.empty() ? "Hexapod" : run.session.robot.name},
               {"program_version", ProgramVersion()},
               {"session", SessionPath(run)},
               {"images", images},
               {"correlations", CorrelationsJson(run.result.calibration)},
               {"priors", PriorsJson(PriorPulls(run, found))},
               {"contradicting_pull_sigma", kContradicting_sigma},
               {"checks", ChecksJson(run)},
               {"options", OptionsJson(run)}};
  data["calibration"] = calibration;
  data["nominal"] = NominalJson(run);
  data["weak"] = calibration.at("weak");
  return data;
}

}  // namespace legible
