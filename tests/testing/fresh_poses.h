// How far off a robot's model is in poses that no calibration has seen.
#pragma once

#include <random>

#include "core/robots/gough_stewart.h"

namespace legible {

struct PoseError {
  double position_m = 0, rotation_rad = 0;  // root mean square over the poses
};

struct FreshPoseOptions {
  int poses = 300;
  double reading_sigma_m = 2e-5;
  double shift_m = 0.05;  // about home, to either side along x and y
  double least_height_m = 0.28, largest_height_m = 0.40;
  double tilt_rad = 0.12;  // standard deviation about each axis
};

// The same mechanism with its joints in the truth's frames, by rigid fits of the joints: frames are a matter
// of convention.
GoughStewart LaidOnto(const GoughStewart& truth, GoughStewart model);

// Poses predicted from joint readings alone by forward kinematics through `model`, against where `truth` then
// is. They are drawn about home such that every leg's length is in the drawing's joint range.
PoseError ErrorInFreshPoses(const GoughStewart& truth, const GoughStewart& model, const GoughStewart& drawing,
                            const FreshPoseOptions& options, std::mt19937_64& generator);

}  // namespace legible
