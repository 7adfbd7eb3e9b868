// Why the corners of a board do not lie to each other as its file says.
#pragma once

#include <string>

#include "calib/board/board_calibration.h"

namespace legible {

// A sentence on what the images show instead, as far as that can be told: the size of the tags against their
// distances, or the number of columns under which they would fit. For a calibration that ended with kNotFlat.
std::string WhyNotFlat(const Board& board, const BoardCalibrationInput& input);

}  // namespace legible
