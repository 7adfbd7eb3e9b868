// Images of a board through a given camera, found and calibrated as a laboratory would.
#pragma once

#include "calib/board/board_calibration.h"
#include "core/geometry/camera.h"

namespace legible {

struct CameraByBoard {
  BoardCalibrationInput input;
  BoardCalibrationOptions options;
  BoardCalibration result;
};

// Renders `views` images of a board of 6 x 6 tags all over the image, tilted by up to 40 degrees, blur 0.8
// px, noise 2 grey levels; finds its corners in them; calibrates the lens that the camera has.
CameraByBoard CalibrateByRenderedBoard(const Camera& camera, int views);

}  // namespace legible
