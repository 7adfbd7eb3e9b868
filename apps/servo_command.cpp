#include "apps/servo_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/json_text.h"
#include "apps/output_folder.h"
#include "apps/program.h"
#include "apps/report_page.h"
#include "apps/servo_json.h"
#include "apps/servo_report.h"
#include "apps/servo_run.h"
#include "apps/wording.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

const std::vector<std::string> kLogFiles = {"result.json", "setup.json", "cycles.csv", "edges.csv",
                                            "report.html"};
constexpr char kFrames[] = "frames";

// An earlier log is replaced with its frames; a folder that holds something else of these names is left
// alone.
void DemandNothingElseThere(const std::filesystem::path& folder) {
  if (IsServoLog(folder)) return;
  std::vector<std::string> names = kLogFiles;
  names.emplace_back(kFrames);
  for (const std::string& name : names)
    if (std::filesystem::exists(folder / name))
      throw InputError(folder / name, 0, "is there already, and no servo's log with it",
                       "name another folder with --log");
}

std::string PoseErrorText(const nlohmann::ordered_json& error) {
  if (error.is_null()) return "";
  return fmt::format("  true pose: {:.3f} mm and {:.3f} mrad from the goal\n",
                     1e3 * error.at("position_m").get<double>(),
                     1e3 * error.at("rotation_rad").get<double>());
}

std::string Summary(const ServoSettings& settings, const FinishedServo& finished,
                    const nlohmann::ordered_json& document) {
  std::string errors;
  if (!finished.log.cycles.empty()) {
    const LawResult& last = finished.log.cycles.back().cycle.output.step.law;
    errors = fmt::format("; edges {:.3f} px rms from the goal's, directions {:.3f} mrad", last.edge_error_px,
                         1e3 * last.direction_error_rad);
  }
  return fmt::format(
      "{}: {}\n"
      "  {} cycles, {:.2f} s{}\n"
      "{}"
      "  {} are in {}\n",
      ToString(finished.run.end), finished.run.reason, finished.run.cycles, finished.run.time_s, errors,
      PoseErrorText(document.at("final_pose_error")),
      "result.json, setup.json, cycles.csv, edges.csv and report.html", settings.log.string());
}

// Drives and writes; all files come together at the end.
struct Servoed {
  FinishedServo finished;
  nlohmann::ordered_json document;
};
Servoed ServoAndWrite(PreparedServo& prepared, ProgressLine& progress) {
  const ServoSettings& settings = prepared.settings;
  std::vector<std::string> names = kLogFiles;
  names.emplace_back(kFrames);
  Servoed servoed;
  const Interruption interruption;  // a second one must not keep the log from being written
  WriteTogether(settings.log, names, [&](const std::filesystem::path& folder) {
    std::optional<std::filesystem::path> frames;
    if (settings.keeps_images) {
      frames = folder / kFrames;
      std::filesystem::create_directory(*frames);
    }
    servoed.finished = DriveServo(prepared, frames, interruption, progress);
    servoed.document = ServoJson(prepared, servoed.finished);
    WriteServoLog(folder, servoed.finished.log);
    WriteFileAtomically(folder / "result.json", JsonText(servoed.document));
    WriteFileAtomically(folder / "report.html",
                        RenderServoPage(ServoReportData(prepared, servoed.finished, servoed.document)));
  });
  return servoed;
}

}  // namespace

int RunServoCommand(const ServoSettings& settings, const Console& console) {
  return RunServoCommand(settings, OpenRig(settings.rig), console);
}

int RunServoCommand(const ServoSettings& settings, OpenedRig rig, const Console& console) {
  DemandWritable(settings.log, kLogFiles, "--log");
  DemandNothingElseThere(settings.log);
  PreparedServo prepared = PrepareServo(settings, std::move(rig));
  ProgressLine progress(console);
  Servoed servoed;
  try {
    servoed = ServoAndWrite(prepared, progress);
  } catch (const InputError& error) {  // what was driven is no bad input any more
    progress.Clear();
    console.err << "legible: the robot was driven, but its log cannot be written: " << error.what() << "\n";
    return kExitNoResult;
  }
  progress.Clear();
  console.err << WarningsText(prepared.warnings);
  const ServoRun& run = servoed.finished.run;
  const bool has_converged = run.end == ServoEnd::kConverged;
  if (settings.prints_json)
    console.out << JsonText(servoed.document);
  else
    console.out << Summary(settings, servoed.finished, servoed.document);
  if (!has_converged) console.err << "legible: stopped: " << run.reason << "\n";
  return has_converged ? kExitSuccess : kExitNoResult;
}

}  // namespace legible
