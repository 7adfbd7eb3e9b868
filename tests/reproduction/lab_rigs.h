// DeltaLab rigs that differ from what is known of them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rig/simulation_options.h"
#include "core/vision/edge_observation.h"

namespace legible {

struct LabRig {
  SimulationTruth truth;
  SimulationTruth nominal;                // the drawing; the camera by data sheet and tape measure
  std::vector<ImageObservation> session;  // edges and readings of a calibration session held on it
};

// Joints off the drawing by up to 2 mm a coordinate, joint offsets by 1.5 mm, radii by 0.6 mm; the camera
// known to 8 px in focal lengths and principal point, 3 cm and 0.05 rad (3 degrees) a coordinate. The session
// has 20 images of random poses, 20 points an edge with noise of 0.05 px, readings with noise of 20 um.
LabRig DrawLabRig(std::uint64_t seed);

// The model that the session leads to; throws std::runtime_error where it leads to none.
SimulationTruth Calibrated(const LabRig& rig);

}  // namespace legible
