// How far corners scatter among their neighbours, whatever the lens model makes of them all.
#pragma once

#include <optional>

#include "calib/board/board_calibration.h"

namespace legible {

// The factor on the corners' own sigmas as BoardCalibration::noise_factor has it, but of what is left of each
// view's residuals once a cubic polynomial over the board has taken out what is smooth. A lens model that
// does not fit, or a board that is not flat, errs smoothly: it enlarges noise_factor and not this. Nothing
// where no view has enough corners. trusts_all: as the calibration's options.
std::optional<double> NeighbourScatter(const BoardCalibrationInput& input,
                                       const BoardCalibration& calibration, bool trusts_all);

}  // namespace legible
