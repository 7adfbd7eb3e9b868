// How far off the image of a point is, all over the image, because the camera is not known better.
#pragma once

#include <optional>
#include <vector>

#include "calib/board/board_information.h"
#include "calib/board/image_grid.h"

namespace legible {

struct UncertaintyMap {
  ImageGrid grid;
  // Row by row: one standard deviation in the direction in the image in which it is largest, px; none where
  // the lens model does not reach.
  std::vector<std::optional<double>> sigma_px;
  double rms_px = 0, worst_px = 0;
};

// Of a point that stands still before the boards: part of what the camera is not known to shows as a motion
// of everything before it, which whoever estimates poses with this camera will not notice. (As in mrcal,
// "projection uncertainty".)
UncertaintyMap PixelUncertainty(const Camera& camera, const BoardInformation& information,
                                const ImageGrid& grid);

}  // namespace legible
