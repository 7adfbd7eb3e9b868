// What views of a board are worth before anything is estimated from them.
#pragma once

#include <cstddef>
#include <vector>

#include "calib/board/board_calibration.h"
#include "calib/board/board_problem.h"

namespace legible {

// Whether the corners do not span the board's plane, or the image's.
bool AreOnOneLine(const ViewObservation& view);

// How many places of the board these of the input's views show. Two views of one place have 70 % of their
// corners, of those of the one with fewer, in common, and these differ by less than 0.5 % of the image's
// diagonal (rms).
int CountDistinctViews(const BoardCalibrationInput& input, const std::vector<size_t>& views);

}  // namespace legible
