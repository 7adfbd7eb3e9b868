// Servos on simulated rigs with random everything: robots, models, ways, laws, noise, friction and faults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/rig/simulation_options.h"
#include "servo/servo_loop.h"

namespace legible {

struct ServoTrial {
  SimulationTruth truth;
  ServoModel model;
  double model_error = 0;  // share of the drawing's; 0: the model is the truth
  ServoGoal goal;
  Rigid3 goal_pose;              // of the model
  bool is_goal_in_range = true;  // by the model, margins included
  SimulationOptions simulation;  // with the fault
  std::optional<Fault> fault;
  ServoOptions options;

  bool Looks() const { return LooksAtImages(options.step.law); }
  bool HasFriction() const { return simulation.drives.breakaway_speed_m_per_s > 0; }
  // Whether the fault touches anything that the law uses.
  bool FaultMatters() const;
  // "run 17: edges by legs 1, 2 and 5, model error 0.30, ..."
  std::string Describe() const;
};

// Depends on the two numbers alone.
ServoTrial DrawTrial(std::uint64_t seed, int number);

// What an image of the true camera becomes for whoever believes the model's (both without distortion).
SeenEdges ThroughModel(const SeenEdges& seen, const Camera& truth, const Camera& model);

}  // namespace legible
