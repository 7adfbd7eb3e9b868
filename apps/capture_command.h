// `legible capture`: holds a calibration session with a rig.
#pragma once

#include "apps/capture_settings.h"
#include "apps/console.h"
#include "apps/rig_opening.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddCaptureCommand(CLI::App& program, CaptureSettings& settings);

// Runs it and returns the exit code: 0 where the session holds what was asked for. Throws InputError on bad
// input, having written and moved nothing.
int RunCapture(const CaptureSettings& settings, const Console& console);
// With a rig that is open already.
int RunCapture(const CaptureSettings& settings, OpenedRig rig, const Console& console);

}  // namespace legible
