// `legible intrinsics`: from images of a calibration board to a camera, a report, and a summary.
#pragma once

#include "apps/console.h"
#include "apps/intrinsics_settings.h"

namespace CLI {
class App;
}

namespace legible {

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddIntrinsicsCommand(CLI::App& program, IntrinsicsSettings& settings);

// Runs it and returns the exit code: 1, with nothing written, where the views lead to no camera. Throws
// InputError on bad input, having written nothing.
int RunIntrinsics(const IntrinsicsSettings& settings, const Console& console);

}  // namespace legible
