// The rig that a command is to drive, by its name: the one place that knows which rigs there are.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/geometry/camera.h"
#include "core/rig/simulated_rig.h"

namespace legible {

// What only a simulated rig has.
struct Simulation {
  std::filesystem::path truth_file;
  SimulatedRig* rig = nullptr;  // the opened one itself
};

// A rig with its camera. Commands drive it through `rig` alone, whatever it is.
struct OpenedRig {
  std::unique_ptr<Rig> rig;
  int width_px = 0, height_px = 0;  // of its images
  // What its papers say: drawings of the robot and of the camera, with its place; σ of a joint reading, m.
  std::optional<std::filesystem::path> drawing_robot, drawing_camera;
  std::optional<double> reading_sigma_m;
  std::optional<Simulation> simulation;  // for logs and tests, and for edges without images
};

// "sim:TRUTH". Throws InputError for other rigs and for what is wrong with TRUTH.
OpenedRig OpenRig(const std::string& name);

// Throws InputError, naming the file that describes the camera, unless its images are of the rig's size.
void DemandSameImageSize(const std::filesystem::path& file, const Camera& camera, const OpenedRig& rig);

}  // namespace legible
