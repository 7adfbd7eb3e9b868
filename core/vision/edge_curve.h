// A predicted edge on its way to where the image has it.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/geometry/camera.h"
#include "core/vision/predicted_legs.h"

namespace legible {

// Moves the curve of the leg's edge by `at_a_px` and `at_b_px` outward at the leg's two ends, to a straight
// edge; its points keep their visibility. Leaves it where the lens folds over.
void ShiftEnds(const Camera& camera, const LegInCamera& leg, double at_a_px, double at_b_px,
               PredictedEdge& edge);

// Of what can be seen, px.
double VisibleLength(const PredictedEdge& edge);

// What keeps most of the edge from being seen, in words.
std::string MainObstacle(const PredictedEdge& edge);

}  // namespace legible
