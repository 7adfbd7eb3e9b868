#include "apps/simulate_command.h"

#include <fmt/format.h>

#include "apps/output_folder.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/simulated_session.h"
#include "apps/wording.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

const std::vector<std::string> kFiles = {"truth.yaml", "robot.yaml",   "camera.yaml",
                                         "truth.json", "session.yaml", "joints.csv"};
constexpr char kImages[] = "images";

// An earlier simulation is replaced; a session that somebody held, or anything else, is left alone.
void DemandOurs(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder) || std::filesystem::is_empty(folder)) return;
  if (std::filesystem::exists(folder / "truth.yaml")) return;
  throw InputError(folder, 0, "is there already, and is no simulation's", "name another folder with --out");
}

std::string Summary(const SimulateSettings& settings) {
  const std::string folder = settings.out.string();
  if (settings.images == 0)
    return fmt::format(
        "A rig is in {}: truth.yaml, and on paper robot.yaml and camera.yaml\n"
        "  next: legible capture --rig sim:{} --out my-session\n",
        folder, (settings.out / "truth.yaml").string());
  return fmt::format(
      "A session with {} is in {}, its truth in truth.yaml and truth.json there\n"
      "  next: legible calibrate {}\n",
      Plural(settings.images, "image"), folder, folder);
}

}  // namespace

int RunSimulate(const SimulateSettings& settings, const Console& console) {
  DemandOurs(settings.out);
  DemandWritable(settings.out, kFiles);
  const SimulatedSession session = DrawSession(settings);
  ProgressLine progress(console);
  std::vector<std::string> names = kFiles;
  names.emplace_back(kImages);
  try {
    WriteTogether(settings.out, names, [&](const std::filesystem::path& folder) {
      WriteSimulatedSession(folder, session, [&](int done, int total) {
        progress.Show(StageText("rendering", done + 1, total));
      });
    });
  } catch (const std::invalid_argument& error) {
    throw InputError(settings.truth.value_or(settings.out), 0, "cannot be simulated", error.what());
  }
  progress.Clear();
  console.err << WarningsText(session.warnings);
  console.out << Summary(settings);
  return kExitSuccess;
}

}  // namespace legible
