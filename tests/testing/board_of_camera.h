// Images of a board through a given camera, found and calibrated as a laboratory would.
#pragma once

#include <vector>

#include "calib/board/board_calibration.h"
#include "core/geometry/camera.h"
#include "core/session/board.h"
#include "core/vision/gray_image.h"

namespace legible {

struct CameraByBoard {
  BoardCalibrationInput input;
  BoardCalibrationOptions options;
  BoardCalibration result;
};

// 6 x 6 tags of tag36h11, 30 mm large and 9 mm apart, ids row by row from the top-left.
Board SixBySixTags();

// Images of it all over the image, tilted by up to 40 degrees, blur 0.8 px, noise 2 grey levels.
std::vector<GrayImage> RenderViewsOfBoard(const Camera& camera, int views);

// Finds the corners in these images, and calibrates the lens that the camera has.
CameraByBoard CalibrateByRenderedBoard(const Camera& camera, int views);

}  // namespace legible
