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
#include "apps/watched_legs.h"
#include "apps/wording.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

const std::vector<std::string> kLogFiles = {"setup.json", "cycles.csv", "edges.csv", "report.html",
                                            "result.json"};

std::vector<std::string> AllOfALog() {
  std::vector<std::string> names = {kFrameFolder};
  names.insert(names.end(), kLogFiles.begin(), kLogFiles.end());
  return names;
}

// An earlier log is replaced with its frames; a folder that holds something else of these names is left
// alone.
void DemandNothingElseThere(const std::filesystem::path& folder) {
  if (IsServoLog(folder)) return;
  for (const std::string& name : AllOfALog())
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

std::string UnfinishedText(const std::filesystem::path& folder) {
  return fmt::format(
      "{} holds the log of a servo that has not come to its end: look at it with `legible "
      "replay`, then remove it",
      folder.string());
}

// Drives and writes; the log grows in a folder of its own, and replaces an earlier one when all is there.
struct Servoed {
  FinishedServo finished;
  nlohmann::ordered_json document;
};
Servoed ServoAndWrite(PreparedServo& prepared, const std::filesystem::path& folder, ProgressLine& progress) {
  Servoed servoed;
  const Interruption interruption;  // a second one must not keep the log from being written
  servoed.finished = DriveServo(prepared, folder, interruption, progress);
  servoed.document = ServoJson(prepared, servoed.finished);
  WriteFileAtomically(folder / "report.html",
                      RenderServoPage(ServoReportData(prepared, servoed.finished, servoed.document)));
  WriteFileAtomically(folder / "result.json", JsonText(servoed.document));
  MoveTogether(folder, prepared.settings.log, AllOfALog());
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
  for (const std::filesystem::path& unfinished : UnfinishedLogs(settings.log))
    prepared.warnings.push_back(UnfinishedText(unfinished));
  ProgressLine progress(console);
  SettleWatchedLegs(prepared, progress);
  console.err << WarningsText(prepared.warnings);  // before anything moves
  const std::filesystem::path folder = MakeNumberedFolder(settings.log, kUnfinishedLog);
  Servoed servoed;
  try {
    servoed = ServoAndWrite(prepared, folder, progress);
  } catch (const InputError& error) {  // what was driven is no bad input any more
    progress.Clear();
    console.err << fmt::format("legible: the log cannot be written; what there is of it is in {}: {}\n",
                               folder.string(), error.what());
    return kExitNoResult;
  }
  progress.Clear();
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
