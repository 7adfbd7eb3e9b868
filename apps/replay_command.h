// `legible replay`: runs the law of a servo's log again.
#pragma once

#include <filesystem>

#include "apps/console.h"

namespace CLI {
class App;
}

namespace legible {

struct ReplaySettings {
  std::filesystem::path log;
  bool prints_json = false;
};

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddReplayCommand(CLI::App& program, ReplaySettings& settings);

// Runs it and returns the exit code: 0 where every command comes out the same, bit for bit. Throws InputError
// for what is no log.
int RunReplay(const ReplaySettings& settings, const Console& console);

}  // namespace legible
