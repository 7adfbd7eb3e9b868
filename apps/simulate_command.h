// `legible simulate`: a whole session with its truth, or a rig to play with.
#pragma once

#include "apps/console.h"
#include "apps/simulate_settings.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddSimulateCommand(CLI::App& program, SimulateSettings& settings);

// Runs it and returns the exit code. Throws InputError on bad input, having written nothing.
int RunSimulate(const SimulateSettings& settings, const Console& console);

}  // namespace legible
