// `legible accuracy`: from a robot or a calibrated model to its errors, pose by pose and over a workspace.
#pragma once

#include "apps/accuracy_settings.h"
#include "apps/console.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddAccuracyCommand(CLI::App& program, AccuracySettings& settings);

// Runs it and returns the exit code. Throws InputError on bad input, having written nothing.
int RunAccuracy(const AccuracySettings& settings, const Console& console);

}  // namespace legible
