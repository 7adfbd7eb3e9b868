// Corners of a board that were found elsewhere.
#pragma once

#include <filesystem>
#include <vector>

#include "core/session/board.h"
#include "core/vision/board_sighting.h"

namespace legible {

struct ReadView {
  BoardView view;
  std::vector<LeftOut> left_out;  // what the file marks as wrong
};

// Reads a table with the columns view, x_px, y_px and, by the kind of the board, column and row of an inner
// corner of the chessboard (from 0, the first in the top-left), or tag (its id) and corner (0 to 3:
// bottom-left, bottom-right, top-right, top-left of the black border). Optional: sigma_px, the standard
// deviation of each coordinate up to a factor that all corners share, or weight, its inverse; a weight of 0
// or less says that the corner is wrong, and it is left out. With `counts_alike` these are not looked at.
// Views in the order of their first rows, corners by point. Throws InputError for what is no such
// table, and for corners that the board does not have or that a view has twice.
std::vector<ReadView> ReadCorners(const std::filesystem::path& file, const Board& board, bool counts_alike);

}  // namespace legible
