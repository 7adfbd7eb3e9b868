// Calibration boards in images: their corners to a hundredth of a pixel, and what was left out.
#pragma once

#include <memory>

#include "core/session/board.h"
#include "core/vision/board_sighting.h"
#include "core/vision/gray_image.h"

namespace legible {

// Finds one board. Not for use by two threads.
//
// Tags count one by one, so that a part of a board is enough. A tag counts as a whole: one that is partly
// outside the image is no tag. Tags of the board that are predicted to be wholly inside the image by those
// found beside them are among the corners or left out with a reason.
//
// A chessboard counts only as a whole. Where columns + rows is odd, the first point is the corner whose
// square towards the board's middle is dark; where it is even, colours do not tell one end from the other,
// nor, of a square board, one side: the points are then turned with the board, by a symmetry of the board
// that changes nothing of what a calibration finds of the camera.
class BoardDetector {
 public:
  // Throws std::invalid_argument for a board that is not exactly one of the two kinds, has no tags or fewer
  // than three inner corners a side, an unknown family of tags, or a wide border about tags that cannot be
  // read with one.
  explicit BoardDetector(const Board& board);
  ~BoardDetector();
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;

  BoardSighting Detect(const GrayImage& image) const;

 private:
  struct Kinds;
  std::unique_ptr<const Kinds> kinds_;
};

}  // namespace legible
