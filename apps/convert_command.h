// `legible convert`: a camera or a robot in the formats of other tools.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/console.h"
#include "datasets/linuxcnc_file.h"

namespace CLI {
class App;
}

namespace legible {

struct ConvertSettings {
  std::filesystem::path input;
  std::string to;                            // one of ConvertTargets()
  std::optional<std::filesystem::path> out;  // none: standard output
  double accepted_error_px = 0.1;            // at most, over the image
  LengthUnit unit = LengthUnit::kMillimetre;
};

// "opencv", "ros", "kalibr", "visp", "mrcal", "linuxcnc"
std::vector<std::string> ConvertTargets();

// Adds the command with its options, which fill `settings` when the command line is parsed.
const CLI::App* AddConvertCommand(CLI::App& program, ConvertSettings& settings);

// Runs it and returns the exit code: 1, with nothing written, where the format comes no nearer to the camera
// than what is accepted. Throws InputError on bad input, having written nothing.
int RunConvert(const ConvertSettings& settings, const Console& console);

}  // namespace legible
