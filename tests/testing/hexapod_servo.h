// `legible servo` on the shipped session's hexapod, simulated before the session's camera: with images, by
// the exact model, so that what is left at the end is the images' noise and the legs' doing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/rig/simulation_options.h"

namespace legible {

// The drawing, and the camera where a tape measure has it.
SimulationTruth ShippedHexapod();

struct HexapodWay {
  Rigid3 from, to;  // base_from_platform
};

inline constexpr unsigned kHexapodWaysSeed = 2016;

// So many, both ends within 60 mm a coordinate and 0.4 rad of home, every joint 3 mm within its range.
std::vector<HexapodWay> DrawHexapodWays(const GoughStewart& robot, int count);

// Whether every joint is that far within its range at the pose.
bool KeepsMargin(const GoughStewart& robot, const Rigid3& base_from_platform, double margin_m);

struct ServoedHexapod {
  int exit_code = 0;
  std::string said;       // on standard error: warnings, before it moved; why it stopped
  std::string status;     // of result.json, as the rest; empty where it was refused
  std::vector<int> legs;  // that were watched, from 0
  double time_s = 0;
  double final_error = 0;  // as it was seen, in `unit`
  std::string unit;
  Rigid3 true_end;
  double position_m = 0, rotation_rad = 0;  // of the true end, from the goal
};

// Runs the command with these options more, in the folder, which is made anew.
ServoedHexapod ServoHexapod(const std::filesystem::path& folder, const HexapodWay& way,
                            const std::vector<std::string>& options);

// The modes that the warnings name: positions alone.
std::vector<Eigen::Vector3d> WarnedPositions_m(const std::string& said);

}  // namespace legible
