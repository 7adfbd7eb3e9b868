// The log of a servo: all that it started from and all that came in, so that it can be run again.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "servo/servo_loop.h"

namespace legible {

struct ServoSetup {
  ServoModel model;
  ServoGoal goal;
  ServoOptions options;
  double period_s = 0.02;
  std::map<std::string, std::string> provenance;  // model, rig, program_version
};

struct LoggedCycle {
  ServoCycle cycle;
  std::optional<Rigid3> true_base_from_platform;  // where the rig knows it; in the model's frames
};

struct ServoLog {
  ServoSetup setup;
  std::vector<LoggedCycle> cycles;
};

// Writes setup.json, cycles.csv and edges.csv as the servo runs: what was added stays, however the program
// ends. Numbers read back as the same bits.
class ServoLogWriter {
 public:
  // Into a folder that is there. Throws InputError where something cannot be written, and so does Add.
  ServoLogWriter(const std::filesystem::path& folder, const ServoSetup& setup);
  void Add(const LoggedCycle& logged);

 private:
  struct GrowingFile {
    std::filesystem::path path;
    std::ofstream stream;
    void Append(const std::string& text);
  };
  ControlLawOptions law_;
  GrowingFile cycles_, edges_;
  size_t count_ = 0;
};

// Whether the folder holds what ServoLogWriter writes.
bool IsServoLog(const std::filesystem::path& folder);

// The log of a servo grows in a folder unfinished-N in the log's folder, and is moved from there when it is
// whole. Those that a killed program has left, or that still grow, in order.
inline constexpr char kUnfinishedLog[] = "unfinished-";
std::vector<std::filesystem::path> UnfinishedLogs(const std::filesystem::path& folder);

// What a log says of a cycle: its input and the commands that followed.
struct RecordedCycle {
  CycleInput input;
  Vector6d joint_speeds_m_per_s = Vector6d::Zero();
  std::string end;  // as ToString(ServoEnd)
};
struct RecordedServo {
  ServoSetup setup;
  std::vector<RecordedCycle> cycles;
  std::string end, reason;  // by result.json
  // There is no result.json: the program was killed, or still runs. The cycles are those that were written.
  bool is_cut_off = false;
  bool is_torn = false;  // of a log that is cut off: what was half written is left out
};
// Throws InputError for what is no log, or a damaged one.
RecordedServo ReadServoLog(const std::filesystem::path& folder);

}  // namespace legible
