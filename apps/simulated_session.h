// A session that nobody held: a rig, images of it, and the truth behind both.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/simulate_settings.h"
#include "core/session/session.h"
#include "datasets/simulation_file.h"

namespace legible {

struct SimulatedSession {
  SimulatedTruth truth;                    // its drawing belongs beside it: robot.yaml and camera.yaml
  Session paper;                           // what the laboratory knows; its images as they will be rendered
  std::vector<Rigid3> base_from_platform;  // of each image
  std::vector<Vector6d> true_readings_m;
  std::vector<std::string> warnings;
};

// Everything but the pixels. Throws InputError for files and options that lead to no rig, and where hardly
// any pose is in reach and in sight.
SimulatedSession DrawSession(const SimulateSettings& settings);

// truth.yaml, robot.yaml and camera.yaml; with images also truth.json, session.yaml, joints.csv and images/.
void WriteSimulatedSession(const std::filesystem::path& folder, const SimulatedSession& session,
                           const std::function<void(int done, int total)>& progress);

}  // namespace legible
