// A view of a board as the solver takes it; for this project's .cpp files that know the solver.
#pragma once

#include <ceres/cost_function.h>

#include "calib/board/board_problem.h"

namespace legible {

// Blocks: the camera (its first CameraUnknowns() parameters, the block may be longer), the displacement of
// the view's pose (6) and, where the problem estimates it, the bend of the board (2).
class ViewCost final : public ceres::CostFunction {
 public:
  ViewCost(const BoardProblem& problem, const ViewObservation& view, int camera_block);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const BoardProblem& problem_;
  const ViewObservation& view_;
  int camera_block_;
};

}  // namespace legible
