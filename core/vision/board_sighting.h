// What is found of a board in one image, and what is not.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/session/board.h"

namespace legible {

// Something of the board that is in the image, or ought to be, without being among the corners.
struct LeftOut {
  std::string what;                      // "tag 17", "the top-left corner of tag 5", "the board", …
  std::string reason;                    // goes on: "is not among the board's tags"
  std::vector<int> points;               // of PointsOf(board) that are missing by it; none for a foreign tag
  std::optional<Eigen::Vector2d> pixel;  // where it is, or ought to be
  bool contradicts = false;              // it was read, and is not where the board has it
};

struct BoardSighting {
  std::vector<BoardCorner> corners;  // by point
  std::vector<LeftOut> left_out;
};

}  // namespace legible
