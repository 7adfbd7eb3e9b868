// `legible calibrate`: from a session's files to a model, a report, and a summary.
#pragma once

#include "apps/calibrate_settings.h"
#include "apps/console.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddCalibrateCommand(CLI::App& program, CalibrateSettings& settings);

// Runs it and returns the exit code. Throws InputError on bad input, having written nothing.
int RunCalibrate(const CalibrateSettings& settings, const Console& console);

}  // namespace legible
