#include "apps/console_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "apps/judgement.h"
#include "apps/wording.h"

namespace legible {
namespace {

constexpr size_t kSentencesPrinted = 8;  // of what is open; calibration.json has all

std::string HeadLine(const CalibrationRun& run) {
  std::string status = Capitalised(ToString(run.result.calibration.status));
  for (char& letter : status)
    if (letter == '_') letter = ' ';
  return fmt::format("{}: {} of {} and {} used. {}\n", status, CountUsedImages(run.result),
                     Plural(static_cast<int>(run.result.images.size()), "image"),
                     Plural(CountEdges(run.result).used, "leg edge"),
                     AssumptionText(run.settings, run.session.known));
}

std::string FitText(const CalibrationRun& run) {
  const LegCalibration& calibration = run.result.calibration;
  if (calibration.edges.empty()) return "";
  std::string text = fmt::format("Residual {:.3f} px rms; one edge point has σ {:.3f} px.",
                                 calibration.rms_px, calibration.edge_sigma_px);
  if (run.result.held_out_rms_px)
    text += fmt::format(" On images held out: {:.3f} px rms.", *run.result.held_out_rms_px);
  text += "\n";
  for (const TagGroupFit& fit : calibration.tags)
    text += Capitalised(TagFitSentence(calibration, fit)) + ".\n";
  for (const TagCheck& check : run.result.tag_checks)
    text += Capitalised(TagSentence(run.session, check)) + ".\n";
  return text;
}

// "+1.21 ± 0.08", "held", or a dash where nothing is known.
std::string Difference(double found, double drawn, double sigma, double scale, int decimals) {
  if (std::isnan(found)) return "-";
  if (sigma == 0) return "held";
  return fmt::format("{:+.{}f} ± {:.{}f}", scale * (found - drawn), decimals, scale * sigma, decimals);
}

std::string CameraTable(const CalibrationRun& run, const FoundParameters& found) {
  const Camera& camera = run.result.guessed_camera;
  const CameraParameters guess = ParametersOf(camera);
  const int count = 4 + static_cast<int>(camera.lens);
  std::string text = fmt::format("\n{:<16}{:>12}{:>20}\n", "Camera", "first guess", "found - guess, ± σ");
  for (int i = 0; i < count; ++i) {
    const int decimals = i < 4 ? 2 : 5;
    const std::string& name = CameraParameterName(camera.lens, i);
    text += fmt::format("  {:<14}{:>12.{}f}{:>20}\n", name, guess[i], decimals,
                        Difference(found.camera[i], guess[i], found.camera_sigma[i], 1, decimals));
  }
  return text;
}

struct LegRow {
  const char* label;
  double scale;
  int decimals;
  std::function<double(const FoundLeg&)> found;
  std::function<double(const Leg&)> drawn;
  std::function<double(const LegSigma&)> sigma;
};

std::vector<LegRow> LegRows() {
  std::vector<LegRow> rows;
  rows.reserve(8);
  const char* const a_labels[] = {"A x  mm", "A y  mm", "A z  mm"};
  const char* const b_labels[] = {"B x  mm", "B y  mm", "B z  mm"};
  for (int i = 0; i < 3; ++i)
    rows.push_back({a_labels[i], 1e3, 2, [i](const FoundLeg& leg) { return leg.base_joint_m[i]; },
                    [i](const Leg& leg) { return leg.base_joint_m[i]; },
                    [i](const LegSigma& sigma) { return sigma.base_joint_m[i]; }});
  for (int i = 0; i < 3; ++i)
    rows.push_back({b_labels[i], 1e3, 2, [i](const FoundLeg& leg) { return leg.platform_joint_m[i]; },
                    [i](const Leg& leg) { return leg.platform_joint_m[i]; },
                    [i](const LegSigma& sigma) { return sigma.platform_joint_m[i]; }});
  rows.push_back({"R    µm", 1e6, 0, [](const FoundLeg& leg) { return leg.radius_m; },
                  [](const Leg& leg) { return leg.radius_m; },
                  [](const LegSigma& sigma) { return sigma.radius_m; }});
  rows.push_back({"offset mm", 1e3, 3, [](const FoundLeg& leg) { return leg.joint_offset_m; },
                  [](const Leg& leg) { return leg.joint_offset_m; },
                  [](const LegSigma& sigma) { return sigma.joint_offset_m; }});
  return rows;
}

std::string LegTable(const CalibrationRun& run, const FoundParameters& found) {
  std::string text = fmt::format("\n{:<11}", "Found - drawn");
  for (int leg = 1; leg <= kLegCount; ++leg) text += fmt::format("{:>16}", fmt::format("leg {}", leg));
  text += "\n";
  for (const LegRow& row : LegRows()) {
    text += fmt::format("  {:<11}", row.label);
    for (size_t i = 0; i < kLegCount; ++i)
      text += fmt::format("{:>16}", Difference(row.found(found.legs[i]), row.drawn(run.session.robot.legs[i]),
                                               row.sigma(found.legs[i].sigma), row.scale, row.decimals));
    text += "\n";
  }
  return text;
}

std::string OpenSentences(const std::vector<WeakDirection>& open) {
  std::string text;
  for (size_t i = 0; i < std::min(open.size(), kSentencesPrinted); ++i)
    text += fmt::format("  {}.\n", Capitalised(open[i].description));
  if (open.size() > kSentencesPrinted)
    text += fmt::format("  … and {} more, which calibration.json lists.\n", open.size() - kSentencesPrinted);
  return text;
}

}  // namespace

std::string SummaryText(const CalibrationRun& run, const FoundParameters& found) {
  const bool has_model = run.result.calibration.status == CalibrationStatus::kConverged;
  return HeadLine(run) + FitText(run) + (has_model ? CameraTable(run, found) + LegTable(run, found) : "");
}

std::string FilesText(const CalibrationRun& run) {
  const bool has_model = run.result.calibration.status == CalibrationStatus::kConverged;
  return fmt::format("\nWrote {}calibration.json and report.html to {} ({:.1f} s).\n",
                     has_model ? "model.yaml, " : "", run.settings.out.string(), run.result.times.total_s);
}

std::string FailureText(const CalibrationRun& run) {
  const std::string why = WhyThereIsNoModel(run);
  if (why.empty()) return "";
  const bool is_open = why == kParametersOpen;
  return fmt::format("legible: no model: {}.\n", why) +
         (is_open ? OpenSentences(run.result.calibration.observability.unobservable) : "");
}

}  // namespace legible
