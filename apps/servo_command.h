// `legible servo`: drives a rig to a goal by what the camera sees of its legs.
#pragma once

#include "apps/console.h"
#include "apps/rig_opening.h"
#include "apps/servo_settings.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddServoCommand(CLI::App& program, ServoSettings& settings);

// Runs it and returns the exit code. Throws InputError on bad input, having written and moved nothing.
int RunServoCommand(const ServoSettings& settings, const Console& console);
// With a rig that is open already.
int RunServoCommand(const ServoSettings& settings, OpenedRig rig, const Console& console);

}  // namespace legible
