// The log of a servo: all that it started from and all that came in, so that it can be run again.
#pragma once

#include <filesystem>
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

// Whether the folder holds what WriteServoLog writes.
bool IsServoLog(const std::filesystem::path& folder);

// setup.json, cycles.csv and edges.csv. Numbers read back as the same bits.
void WriteServoLog(const std::filesystem::path& folder, const ServoLog& log);

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
};
// Reads result.json too. Throws InputError for what is no log, a damaged one, or one that is cut off.
RecordedServo ReadServoLog(const std::filesystem::path& folder);

}  // namespace legible
