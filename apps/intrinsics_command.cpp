#include "apps/intrinsics_command.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/intrinsics_json.h"
#include "apps/intrinsics_judgement.h"
#include "apps/intrinsics_layout.h"
#include "apps/intrinsics_report.h"
#include "apps/intrinsics_run.h"
#include "apps/intrinsics_text.h"
#include "apps/json_text.h"
#include "apps/output_folder.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report_page.h"
#include "apps/wording.h"
#include "core/stopwatch.h"
#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"

namespace legible {
namespace {

const std::vector<std::string> kFiles = {"camera.yaml", "intrinsics.json", "report.html"};

// Why views had no part, as far as that is the same for some; the first three reasons.
std::string ReasonsText(const IntrinsicsRun& run) {
  std::string text;
  int told = 0;
  for (size_t i = 0; i < run.input.views.size() && told < 3; ++i) {
    if (!run.input.views[i].corners.empty() || run.left_out[i].empty()) continue;
    text += fmt::format("  {}: {} {}\n", run.input.views[i].name, run.left_out[i].front().what,
                        run.left_out[i].front().reason);
    ++told;
  }
  const std::string other = OtherTagsSeen(run);
  return other.empty() ? text : text + "  " + other + "\n";
}

std::string CameraText(const IntrinsicsRun& run) {
  std::string text = CameraInfoText({run.result.camera, std::nullopt, run.result.information.information});
  if (!run.halves.HasMisfit()) return text;
  return fmt::format("# The lens model does not fit: `information` is {:.4g} of what the residuals give.\n{}",
                     1 / std::pow(run.result.widening, 2), text);
}

void Write(const IntrinsicsRun& run, const std::string& json, const std::string& page) {
  WriteTogether(run.settings.out, kFiles, [&](const std::filesystem::path& folder) {
    WriteFileAtomically(folder / "camera.yaml", CameraText(run));
    WriteFileAtomically(folder / "intrinsics.json", json);
    WriteFileAtomically(folder / "report.html", page);
  });
}

int SayThereIsNone(const IntrinsicsRun& run, const Console& console) {
  console.err << fmt::format("legible: no camera: {}\n", run.result.message) << ReasonsText(run);
  if (run.settings.prints_json) console.out << JsonText(FailureJson(run));
  return kExitNoResult;
}

}  // namespace

int RunIntrinsics(const IntrinsicsSettings& settings, const Console& console) {
  const Stopwatch total;
  DemandWritable(settings.out, kFiles);
  ProgressLine progress(console);
  IntrinsicsRun run = LoadViews(settings, progress);
  Calibrate(run, progress);
  if (run.result.status != BoardCalibrationStatus::kConverged) {
    progress.Clear();
    run.seconds = total.Seconds();
    return SayThereIsNone(run, console);
  }
  WorkOutUncertainty(run, progress);
  progress.Show("writing the report");
  run.seconds = total.Seconds();
  const std::vector<std::string> warnings = Warnings(run);
  const nlohmann::ordered_json document = IntrinsicsJson(run, warnings);
  const std::string json = JsonText(document);
  Write(run, json, RenderIntrinsicsPage(IntrinsicsReportData(run, document)));
  progress.Clear();
  console.err << WarningsText(warnings);
  console.out << (settings.prints_json ? json : SummaryText(run));
  return kExitSuccess;
}

}  // namespace legible
