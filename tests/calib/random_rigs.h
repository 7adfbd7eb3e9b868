// Desktop hexapods that differ from their drawings, each watched by a camera somewhere around it.
#pragma once

#include <random>

#include "calib/expected_observation.h"

namespace legible {

struct RandomRig {
  GoughStewart drawing;
  RigModel truth;
  RigModel guess;  // the drawing, and the camera by data sheet and tape measure
};

// Joints of the drawing are off a regular hexapod's by up to 1 cm, those of the truth off the drawing's by up
// to 2 mm; the camera stands 0.85 to 1.15 m from the robot, anywhere around it, up to 0.5 m above its base,
// and is known to 3 cm and 3 degrees.
RandomRig DrawRig(std::mt19937_64& generator);

// The platform driven to the joint readings that the guess has for the pose, and what the true camera then
// sees of it, without noise.
ImageObservation SeenIn(const RandomRig& rig, const Rigid3& base_from_platform,
                        const ExpectedEdgeOptions& options);

}  // namespace legible
