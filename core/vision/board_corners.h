// The corners of one board in one image, fitted together.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/vision/board_sighting.h"
#include "core/vision/corner_fit.h"
#include "core/vision/gray_image.h"

namespace legible {

// A corner of the board as it is expected in the image.
struct ExpectedCorner {
  int point = 0;  // of PointsOf(board)
  CornerSite site;
  std::array<double, 2> sides_px;  // to the corners that edges 1 and 2 are drawn to
};

// How well corners between which edges are drawn are known: as a detector finds them, and fitted.
inline constexpr double kDetectedSigma_px = 0.5, kFittedSigma_px = 0.05;

// One by one; corner_sigma_px and the lens's bend say how well the edges' directions are known.
std::vector<CornerFit> FitCorners(const GrayImage& image, const std::vector<ExpectedCorner>& corners,
                                  double corner_sigma_px, CornerExpectations expected);

// What all corners of an image say of its blur and noise; nothing where none was fitted.
CornerExpectations ExpectationsFrom(const std::vector<CornerFit>& fits);

// The fitted corners by point, the others left out by what `name` calls the point.
BoardSighting SightingOf(const std::vector<ExpectedCorner>& corners, const std::vector<CornerFit>& fits,
                         const std::function<std::string(int)>& name);

// The board, left out as a whole.
LeftOut WholeBoard(int points, const std::string& reason);

}  // namespace legible
