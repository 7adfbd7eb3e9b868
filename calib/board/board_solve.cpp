#include <ceres/ceres.h>

#include <memory>

#include "calib/board/board_problem.h"
#include "calib/board/view_cost.h"
#include "calib/progress_callback.h"

namespace legible {
namespace {

ceres::Solver::Options SolverOptions(const BoardSolveOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.relative_tolerance;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-14;
  solver.initial_trust_region_radius = 1e6;
  solver.num_threads = options.threads;
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

BoardSolveSummary SolveBoard(BoardProblem& problem, const BoardSolveOptions& options) {
  ceres::Problem::Options problem_options;
  problem_options.disable_all_safety_checks = true;  // they cost more than some solves
  ceres::Problem ceres_problem(problem_options);
  ceres::Solver::Options solver = SolverOptions(options);

  Eigen::VectorXd camera = UnknownsOf(problem.camera);
  std::vector<Vector6d> displacements(problem.views.size(), Vector6d::Zero());
  Eigen::Vector2d bend_m = problem.warp.bend_m;
  for (size_t i = 0; i < problem.views.size(); ++i) {
    std::vector<double*> blocks = {camera.data(), displacements[i].data()};
    if (problem.estimates_warp) blocks.push_back(bend_m.data());
    ceres_problem.AddResidualBlock(new ViewCost(problem, problem.views[i], problem.CameraUnknowns()), nullptr,
                                   blocks);
    solver.linear_solver_ordering->AddElementToGroup(displacements[i].data(), 0);
  }
  solver.linear_solver_ordering->AddElementToGroup(camera.data(), 1);
  if (problem.estimates_warp) solver.linear_solver_ordering->AddElementToGroup(bend_m.data(), 1);
  ProgressCallback progress(options.progress);
  if (options.progress) solver.callbacks.push_back(&progress);

  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  problem.camera = WithUnknowns(problem.camera, camera);
  problem.warp.bend_m = bend_m;
  for (size_t i = 0; i < problem.views.size(); ++i)
    problem.views[i].camera_from_board = Displaced(problem.views[i].camera_from_board, displacements[i]);
  return {summary.termination_type == ceres::CONVERGENCE, static_cast<int>(summary.iterations.size()) - 1,
          summary.final_cost};
}

}  // namespace legible
