// Which view of the board to add next.
#pragma once

#include <optional>
#include <vector>

#include "calib/board/board_calibration.h"
#include "calib/board/coverage.h"
#include "calib/board/image_grid.h"

namespace legible {

struct NextView {
  Rigid3 camera_from_board;
  BoardTilt tilt;
  Eigen::Vector2d centre_px;                // of the board
  std::vector<Eigen::Vector2d> outline_px;  // of the rectangle about its points, through the lens
  double distance_m = 0;                    // of its middle
  // Standard deviation of the image of a point, rms over the image, that no motion before the camera can make
  // up for: as it is, and as it would be.
  double now_px = 0, then_px = 0;
};

struct NextViewOptions {
  ImageGrid grid;                  // over which the uncertainty is averaged
  bool needs_whole_board = false;  // a chessboard counts only where all of it is seen
};

// Of many places in the image, distances and tilts up to 45 degrees the one after which the camera is known
// best; nothing where the board fits nowhere. Noise and visibility are as in the views that there are.
std::optional<NextView> ProposeView(const BoardCalibrationInput& input, const BoardCalibration& calibration,
                                    const NextViewOptions& options);

}  // namespace legible
