// `legible legs`: which legs to watch on the way from one pose to another, and where a servo of leg
// directions may end instead.
#pragma once

#include "apps/console.h"
#include "apps/legs_settings.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddLegsCommand(CLI::App& program, LegsSettings& settings);

// Runs it and returns the exit code: 1 where no set of legs leads to the goal. Throws InputError on bad
// input, having written nothing.
int RunLegs(const LegsSettings& settings, const Console& console);

}  // namespace legible
