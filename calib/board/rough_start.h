// The first camera and the boards' first poses, from views alone.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "calib/board/board_start.h"

namespace legible {

// The camera of that lens and the poses of all views that a few steps from several focal lengths lead to: the
// best by the median of what is left on some views. `more_focal_lengths`: to be tried besides, in units of
// half the image's diagonal. `report`: the median error of each, px. Nothing where none leads to a camera.
std::optional<BoardProblem> RoughStart(const StraightenedViews& straightened, LensModel lens, int width_px,
                                       int height_px, const std::vector<ViewObservation>& views,
                                       const std::vector<double>& more_focal_lengths,
                                       const std::function<void(double error_px)>& report);

// Views whose corners are mostly not where the problem puts them, ascending: behind the camera, or off by a
// quarter of the way to their neighbours.
// With trusts_all only the former.
std::vector<size_t> UnexplainedViews(const BoardProblem& problem, bool trusts_all);

}  // namespace legible
