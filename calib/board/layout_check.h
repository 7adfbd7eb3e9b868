// Why the corners of a board do not lie to each other as its file says.
#pragma once

#include <optional>
#include <string>

#include "calib/board/board_calibration.h"

namespace legible {

// A sentence on what the images show instead, as far as that can be told: the size of the tags against their
// distances, or the number of columns under which they would fit. For a calibration that ended with kNotFlat.
std::string WhyNotFlat(const Board& board, const BoardCalibrationInput& input);

// By how much larger than stated the tags of a board are, against the distances of their centres; nothing
// where too few are seen whole, or their centres do not lie as stated either. To some 0.2 %.
std::optional<double> TagSizeFactor(const TagBoard& board, const BoardCalibrationInput& input);

}  // namespace legible
