// Where in the image the boards were seen, and how they were tilted.
#pragma once

#include <optional>
#include <vector>

#include "calib/board/board_calibration.h"

namespace legible {

// How a board is turned against the image: the angle between its normal and the optical axis, and towards
// which side of the image its normal leans away, clockwise from the image's right (0: the board's part that
// is to the right is the farther one).
struct BoardTilt {
  double angle_rad = 0;
  double direction_rad = 0;
};
BoardTilt TiltOf(const Rigid3& camera_from_board);

struct Coverage {
  int columns = 0, rows = 0;
  std::vector<int> corners;                     // that count, of each cell of the image, row by row
  std::vector<std::optional<BoardTilt>> tilts;  // of each view; none where it has no part
  double Share() const;                         // of the cells, those with corners
  double LargestTilt() const;                   // rad
};
Coverage CoverageOf(const BoardCalibrationInput& input, const BoardCalibration& calibration, int columns,
                    int rows);

}  // namespace legible
