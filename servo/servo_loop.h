// Runs a servo on a rig until it ends.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/rig/edge_source.h"
#include "core/rig/rig.h"
#include "servo/servo_controller.h"

namespace legible {

struct ServoLoopOptions {
  // So that a few late cycles let no command lapse.
  static constexpr double kLongestPeriod_s = Rig::kCommandHolds_s / 5;

  double period_s = 0.02;  // from command to command
  // For which the camera's first image is waited for, at rest.
  double first_image_s = 1;
  // Asked in each cycle; true: the user wants it stopped.
  std::function<bool()> is_stopped = [] { return false; };

  void Check() const;  // throws std::invalid_argument
};

struct ServoCycle {
  CycleInput input;
  CycleOutput output;
  double look_s = 0;  // time that it took to get the edges, and
  double law_s = 0;   // from there to the command
};

struct ServoRun {
  ServoEnd end = ServoEnd::kRunning;
  std::string reason;
  int cycles = 0;
  double time_s = 0;  // of the rig's clock
};

// Has a first look at rest, however long it takes, and waits for the first image if the law needs images;
// then, cycle by cycle: readings, edges, command. The rig is told to rest when this returns or throws; a rig
// that does not answer ends the run as any other reason does. `record` is called after each command.
ServoRun RunServo(Rig& rig, EdgeSource& source, ServoController& controller, const ServoLoopOptions& options,
                  const std::function<void(const ServoCycle&)>& record);

}  // namespace legible
