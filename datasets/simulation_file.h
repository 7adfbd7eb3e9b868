// A simulated rig's truth: a model.yaml that may have a section `simulation`.
#pragma once

#include <filesystem>
#include <optional>

#include "core/rig/simulation_options.h"

namespace legible {

struct SimulatedTruth {
  SimulationTruth truth;
  SimulationOptions options;
  // What the laboratory has on paper: files of a nominal robot and camera, where the truth names them.
  std::optional<std::filesystem::path> drawing_robot, drawing_camera;
};

// Reads the truth; what the section `simulation` leaves out is as SimulationOptions has it. Paths in the file
// are relative to its folder, those returned are not. Throws InputError for what is no model with a camera
// and its place, for unknown keys, values out of their range, a drawing that is not there and a start outside
// a joint's range.
SimulatedTruth ReadTruth(const std::filesystem::path& file);

// Writes so that ReadTruth gives back the same bits (of a fault what its kind has), all options listed, paths
// relative to the file's folder. Throws InputError if the file cannot be written and std::invalid_argument if
// the options do not pass Check.
void WriteTruth(const std::filesystem::path& file, const SimulatedTruth& simulated);

}  // namespace legible
