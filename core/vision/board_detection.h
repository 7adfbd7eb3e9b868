// Calibration boards in images: their corners to a hundredth of a pixel, and what was left out.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/session/board.h"
#include "core/vision/gray_image.h"

namespace legible {

// Something of the board that is in the image, or ought to be, without being among the corners.
struct LeftOut {
  std::string what;                      // "tag 17", "the top-left corner of tag 5", "the board", …
  std::string reason;                    // goes on: "is not among the board's tags"
  std::vector<int> points;               // of PointsOf(board) that are missing by it; none for a foreign tag
  std::optional<Eigen::Vector2d> pixel;  // where it is, or ought to be
};

struct BoardSighting {
  std::vector<BoardCorner> corners;  // by point
  std::vector<LeftOut> left_out;
};

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
  // Throws std::invalid_argument for a board that is not exactly one of the two kinds, has no points, an
  // unknown family of tags, or a wide border about tags that cannot be read with one.
  explicit BoardDetector(const Board& board);
  ~BoardDetector();
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;

  BoardSighting Detect(const GrayImage& image) const;

 private:
  class Kind;
  class Tags;
  class Chess;
  std::unique_ptr<const Kind> kind_;
};

}  // namespace legible
