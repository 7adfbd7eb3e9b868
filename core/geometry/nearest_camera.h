// The camera of one lens model that is nearest to a camera of another.
#pragma once

#include <bitset>

#include "core/geometry/camera_parameters.h"

namespace legible {

struct NearestCamera {
  Camera camera;
  // How far the image of a sight line moves, over a grid of pixels of the image from corner to corner that
  // the original has sight lines for. Infinite where the found lens folds over within the image.
  double rms_px = 0, max_px = 0;
};

// Least squares of these distances over those parameters of the new lens that are free; of the others fx fy
// cx cy keep the camera's values, and coefficients are 0. Levenberg and Marquardt's method from the camera's
// own coefficients where those mean the same in both lenses, else from 0. Exact, and without a step, where
// nothing has to be left out. Throws std::invalid_argument for a camera without a size or without any sight
// line.
NearestCamera FindNearestCamera(const Camera& camera, LensModel lens,
                                const std::bitset<kCameraParameterCount>& free);

// fx fy cx cy and all coefficients of the lens.
std::bitset<kCameraParameterCount> AllParametersOf(LensModel lens);

}  // namespace legible
