// Whether the lens model fits: two cameras from half of the views each should differ by what their
// uncertainties allow.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "calib/board/board_calibration.h"
#include "calib/board/image_grid.h"

namespace legible {

struct HalvesComparison {
  std::string why_not;  // why there is no comparison; empty: there is
  ImageGrid grid;
  // Row by row: what one half's camera has elsewhere than the other's, px, after the motion of what stands
  // before the camera that suits best; none where a lens model does not reach.
  std::vector<std::optional<Eigen::Vector2d>> difference_px;
  std::vector<std::optional<double>> expected_px;  // of its length, rms, by both covariances
  double difference_rms_px = 0;                    // of the lengths
  double expected_rms_px = 0;                      // by both covariances
  double ratio = 1;  // differences in units of what is expected of each, rms; 1 where the model is right
  double ratio_limit = 1;  // that a right model stays below 999 times in 1000
  // By how much the halves' parameters differ more than the noise of their own residuals lets expect, which a
  // misfit enlarges: rms over all directions of the parameters. It counts what a motion of the boards hides
  // in the image too, for the legs' calibration has the camera's parameters from the board.
  double ratio_to_stated = 1;
  bool HasMisfit() const { return why_not.empty() && ratio > ratio_limit; }
  // By which the sigmas of the whole calibration have to be larger (see Widened) so as not to claim more than
  // its halves bear out; 1 where the lens model fits.
  double Widening() const { return HasMisfit() ? std::max(1.0, ratio_to_stated) : 1; }
};

// `whole` is a calibration of the input by these options. The halves are every other view that took part.
HalvesComparison CompareHalves(const BoardCalibrationInput& input, const BoardCalibration& whole,
                               const BoardCalibrationOptions& options, const ImageGrid& grid);

}  // namespace legible
