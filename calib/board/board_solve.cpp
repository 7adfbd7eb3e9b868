// The only file of this folder that knows the solver.
#include <ceres/ceres.h>

#include <memory>

#include "calib/board/board_problem.h"

namespace legible {
namespace {

void CopyRows(const ViewResiduals::Rows& rows, double* to) {
  if (to != nullptr) std::copy_n(rows.data(), rows.size(), to);
}

// One view: blocks camera, pose (6) and, where it is estimated, the bend of the board (2).
class ViewCost final : public ceres::CostFunction {
 public:
  ViewCost(const BoardProblem& problem, const ViewObservation& view) : problem_(problem), view_(view) {
    *mutable_parameter_block_sizes() = {problem.CameraUnknowns(), 6};
    if (problem.estimates_warp) mutable_parameter_block_sizes()->push_back(2);
    set_num_residuals(2 * static_cast<int>(view.pixels.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Camera camera = WithUnknowns(
        problem_.camera, Eigen::Map<const Eigen::VectorXd>(parameters[0], problem_.CameraUnknowns()));
    const Vector6d displacement = Eigen::Map<const Vector6d>(parameters[1]);
    BoardWarp warp = problem_.warp;
    if (problem_.estimates_warp) warp.bend_m = Eigen::Map<const Eigen::Vector2d>(parameters[2]);
    Eigen::Map<Eigen::VectorXd> to(residuals, num_residuals());
    if (jacobians == nullptr) {
      const auto errors = ViewErrors(camera, warp, view_, displacement);
      if (errors) to = *errors;
      return errors.has_value();
    }
    const auto found = EvaluateView(camera, warp, view_, displacement);
    if (!found) return false;
    to = found->residual;
    CopyRows(found->d_camera, jacobians[0]);
    CopyRows(found->d_pose, jacobians[1]);
    if (problem_.estimates_warp) CopyRows(found->d_warp, jacobians[2]);
    return true;
  }

 private:
  const BoardProblem& problem_;
  const ViewObservation& view_;
};

class ProgressCallback final : public ceres::IterationCallback {
 public:
  explicit ProgressCallback(const std::function<void(int, double)>& report) : report_(report) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    report_(summary.iteration, summary.cost);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void(int, double)>& report_;
};

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
    ceres_problem.AddResidualBlock(new ViewCost(problem, problem.views[i]), nullptr, blocks);
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
