// How far what is seen is from the goal, whatever a law does about it.
#pragma once

#include <optional>

#include "servo/servo_goal.h"
#include "servo/servo_model.h"

namespace legible {

// An error and what of it noise alone leaves, that of what is seen and that of the goal: mean squares.
struct SquaredError {
  double squares = 0, noise_squares = 0;
};

// Distance of the goal's edge, at both its ends, from the line seen, px of the undistorted image.
SquaredError EdgeError(const ServoModel& model, const SeenEdge& seen, const SeenEdge& goal);

// Angle between the direction of a leg, by both its edges, and the goal's, which must have one, rad.
SquaredError DirectionError(const ServoGoal& goal, const SeenEdge& edge_1, const SeenEdge& edge_2);

// Root mean squares: over all edges that both have, over all legs that show both edges and have a goal. NaN
// where there are none.
struct ImageErrors {
  double edge_px, edge_noise_px, direction_rad, direction_noise_rad;
};
ImageErrors MeasureImageErrors(const ServoModel& model, const EdgesByLeg& seen, const ServoGoal& goal);

}  // namespace legible
