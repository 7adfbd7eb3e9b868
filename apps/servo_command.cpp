#include "apps/servo_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

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

// An earlier log's frames are replaced; a folder of this name that is no log's is left alone.
void DemandFramesAreOurs(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / kFrames) && !std::filesystem::exists(folder / "setup.json"))
    throw InputError(folder / kFrames, 0, "is there already, and is no log's",
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
  const LawResult last =
      finished.log.cycles.empty() ? LawResult() : finished.log.cycles.back().cycle.output.step.law;
  return fmt::format(
      "{}: {}\n"
      "  {} cycles, {:.2f} s; edges {:.3f} px rms from the goal's, directions {:.3f} mrad\n"
      "{}"
      "  {} are in {}\n",
      ToString(finished.run.end), finished.run.reason, finished.run.cycles, finished.run.time_s,
      last.edge_error_px, 1e3 * last.direction_error_rad, PoseErrorText(document.at("final_pose_error")),
      "result.json, setup.json, cycles.csv, edges.csv and report.html", settings.log.string());
}

}  // namespace

int RunServoCommand(const ServoSettings& settings, const Console& console) {
  DemandWritable(settings.log, kLogFiles);
  DemandFramesAreOurs(settings.log);
  PreparedServo prepared = PrepareServo(settings);
  std::vector<std::string> names = kLogFiles;
  names.emplace_back(kFrames);
  FinishedServo finished;
  nlohmann::ordered_json document;
  ProgressLine progress(console);
  WriteTogether(settings.log, names, [&](const std::filesystem::path& folder) {
    std::optional<std::filesystem::path> frames;
    if (settings.keeps_images) {
      frames = folder / kFrames;
      std::filesystem::create_directory(*frames);
    }
    finished = DriveServo(prepared, frames, progress);
    document = ServoJson(prepared, finished);
    WriteServoLog(folder, finished.log);
    WriteFileAtomically(folder / "result.json", JsonText(document));
    WriteFileAtomically(folder / "report.html",
                        RenderServoPage(ServoReportData(prepared, finished, document)));
  });
  progress.Clear();
  console.err << WarningsText(prepared.warnings);
  const bool has_converged = finished.run.end == ServoEnd::kConverged;
  if (settings.prints_json)
    console.out << JsonText(document);
  else
    console.out << Summary(settings, finished, document);
  if (!has_converged) console.err << "legible: stopped: " << finished.run.reason << "\n";
  return has_converged ? kExitSuccess : kExitNoResult;
}

}  // namespace legible
