#include "apps/replay_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/option_checks.h"
#include "apps/program.h"
#include "apps/servo_log.h"
#include "apps/wording.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr char kDescription[] = "Run the law of a servo's log again, and compare its commands";
constexpr char kFooter[] =
    R"(LOG is the folder that `legible servo` wrote. The law gets what came in then, cycle by cycle, and must command
the same speeds, bit for bit, and end the same way, for the same reason; an end that came from outside (the user,
a lost link) is not its own. Of a servo that was killed the log is in LOG/unfinished-1: its cycles are run again as
far as they were written.

Exit codes:
  0  it does
  1  it does not; says where first
  2  bad usage, or no log)";

struct Comparison {
  int cycles = 0, different = 0;
  std::optional<int> first_different;
  double largest_difference_m_per_s = 0;
  Verdict end;  // the law's own
  std::string recorded_end, recorded_reason;
  bool is_cut_off = false, is_torn = false;  // the log
  bool ends_alike = true;

  bool IsSame() const { return different == 0 && ends_alike; }
};

// Whether a law that runs on can have been ended like this.
bool CameFromOutside(const RecordedServo& recorded) {
  for (const ServoEnd end : {ServoEnd::kLinkLost, ServoEnd::kStoppedByUser, ServoEnd::kFailed})
    if (recorded.end == ToString(end)) return true;
  return recorded.cycles.empty();
}

Comparison Replay(const RecordedServo& recorded) {
  ServoController controller(recorded.setup.model, recorded.setup.goal, recorded.setup.options);
  Comparison comparison;
  for (const RecordedCycle& cycle : recorded.cycles) {
    const CycleOutput output = controller.Cycle(cycle.input);
    const bool is_same = output.joint_speeds_m_per_s == cycle.joint_speeds_m_per_s &&
                         ToString(output.verdict.end) == cycle.end;
    if (!is_same && comparison.different++ == 0) comparison.first_different = comparison.cycles;
    comparison.largest_difference_m_per_s =
        std::max(comparison.largest_difference_m_per_s,
                 (output.joint_speeds_m_per_s - cycle.joint_speeds_m_per_s).cwiseAbs().maxCoeff());
    comparison.end = output.verdict;
    ++comparison.cycles;
  }
  comparison.recorded_end = recorded.end;
  comparison.recorded_reason = recorded.reason;
  comparison.is_cut_off = recorded.is_cut_off;
  comparison.is_torn = recorded.is_torn;
  if (recorded.is_cut_off) return comparison;
  const bool is_own = comparison.end.end != ServoEnd::kRunning;
  comparison.ends_alike =
      is_own ? ToString(comparison.end.end) == recorded.end && comparison.end.reason == recorded.reason
             : CameFromOutside(recorded);
  return comparison;
}

nlohmann::ordered_json ComparisonJson(const Comparison& comparison) {
  using nlohmann::ordered_json;
  return {
      {"cycles", comparison.cycles},
      {"different", comparison.different},
      {"first_different",
       comparison.first_different ? ordered_json(*comparison.first_different) : ordered_json()},
      {"largest_difference_m_per_s", comparison.largest_difference_m_per_s},
      {"status", ToString(comparison.end.end)},
      {"reason", comparison.end.reason},
      {"cut_off", comparison.is_cut_off},
      {"recorded_status", comparison.is_cut_off ? ordered_json() : ordered_json(comparison.recorded_end)},
      {"recorded_reason", comparison.is_cut_off ? ordered_json() : ordered_json(comparison.recorded_reason)},
      {"ends_alike", comparison.ends_alike}};
}

std::string ComparisonText(const Comparison& comparison) {
  const std::string recorded = fmt::format("{}: {}", comparison.recorded_end, comparison.recorded_reason);
  std::string text =
      comparison.different == 0
          ? fmt::format("{}: the same commands, bit for bit\n", Plural(comparison.cycles, "cycle"))
          : fmt::format("{} of {} differ, the first in cycle {}, by {:.3g} m/s at most\n",
                        comparison.different, Plural(comparison.cycles, "cycle"), *comparison.first_different,
                        comparison.largest_difference_m_per_s);
  if (comparison.is_cut_off)
    return text + fmt::format("cut off: no result.json; {} replayed{}\n",
                              comparison.cycles == 1 ? "1 cycle was"
                                                     : fmt::format("{} cycles were", comparison.cycles),
                              comparison.is_torn ? ", what was half written was left out" : "");
  if (!comparison.ends_alike)
    return text + fmt::format("ends otherwise: {}: {}\n  the log: {}\n", ToString(comparison.end.end),
                              comparison.end.reason, recorded);
  const bool is_own = comparison.end.end != ServoEnd::kRunning;
  return text + fmt::format("{}{}\n", is_own ? "" : "ended from outside: ", recorded);
}

// Whoever was killed before any servo here came to its end is told where the log is.
void DemandWholeLog(const std::filesystem::path& folder) {
  const auto unfinished = UnfinishedLogs(folder);
  if (unfinished.empty() || std::filesystem::exists(folder / "setup.json")) return;
  throw InputError(folder, 0, "holds no log of a servo that came to its end",
                   fmt::format("replay {}, which was cut off", unfinished.back().string()));
}

}  // namespace

const CLI::App* AddReplayCommand(CLI::App& program, ReplaySettings& settings) {
  CLI::App* command = program.add_subcommand("replay", kDescription)->group("Commands");
  command->footer(kFooter);
  command->add_option("LOG", settings.log, "Folder of a servo's log")->required()->type_name("");
  AddTableOrJson(*command, settings.prints_json,
                 "What goes to standard output: lines for people, or one\nJSON document");
  return command;
}

int RunReplay(const ReplaySettings& settings, const Console& console) {
  DemandWholeLog(settings.log);
  const Comparison comparison = Replay(ReadServoLog(settings.log));
  std::vector<std::string> warnings;
  for (const std::filesystem::path& unfinished : UnfinishedLogs(settings.log))
    warnings.push_back(fmt::format("{} is the log of another servo, which was cut off: replay that too",
                                   unfinished.string()));
  console.err << WarningsText(warnings);
  console.out << (settings.prints_json ? JsonText(ComparisonJson(comparison)) : ComparisonText(comparison));
  if (comparison.IsSame()) return kExitSuccess;
  console.err << "legible: the law commands other speeds than the log has, or ends otherwise\n";
  return kExitNoResult;
}

}  // namespace legible
