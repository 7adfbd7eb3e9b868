// The rig that a command is to drive, by its name.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/rig/simulated_rig.h"
#include "datasets/simulation_file.h"

namespace legible {

// A simulated rig with its camera, and the truth behind it.
struct OpenedRig {
  std::filesystem::path truth_file;
  SimulatedTruth truth;
  std::unique_ptr<SimulatedRig> rig;
};

// "sim:TRUTH". Throws InputError for other rigs and for what is wrong with TRUTH.
OpenedRig OpenRig(const std::string& name);

}  // namespace legible
