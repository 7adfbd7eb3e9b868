// The only file that knows the solver.
#include <ceres/ceres.h>

#include <memory>

#include "calib/estimation_problem.h"

namespace legible {
namespace {

// One leg in one image: blocks camera (12), leg (10), pose of the unit (6 or 2).
class LegCost final : public ceres::CostFunction {
 public:
  LegCost(const PoseUnit& unit, const LegObservation& observation) : unit_(unit), observation_(observation) {
    *mutable_parameter_block_sizes() = {kCameraParameterCount, kLegParameterCount, unit.size()};
    set_num_residuals(static_cast<int>(RowCount(observation)));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const CameraParameters camera = Eigen::Map<const CameraParameters>(parameters[0]);
    const LegParameters leg = Eigen::Map<const LegParameters>(parameters[1]);
    const auto r = EvaluateLeg(camera, leg, TipOf(unit_, leg, parameters[2]), observation_);
    if (!r) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = r->residual;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) Copy(r->d_camera, jacobians[0]);
    if (jacobians[1] != nullptr) Copy(r->d_leg, jacobians[1]);
    if (jacobians[2] != nullptr) Copy(r->d_pose, jacobians[2]);
    return true;
  }

 private:
  static void Copy(const Eigen::MatrixXd& jacobian, double* to) {
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        to, jacobian.rows(), jacobian.cols()) = jacobian;
  }

  const PoseUnit& unit_;
  const LegObservation& observation_;
};

// (parameter - value) / sigma for one entry of a block.
class PriorCost final : public ceres::CostFunction {
 public:
  PriorCost(int block_size, int entry, double value, double sigma)
      : entry_(entry), value_(value), sigma_(sigma) {
    *mutable_parameter_block_sizes() = {block_size};
    set_num_residuals(1);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = (parameters[0][entry_] - value_) / sigma_;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    std::fill_n(jacobians[0], parameter_block_sizes()[0], 0.0);
    jacobians[0][entry_] = 1 / sigma_;
    return true;
  }

 private:
  int entry_;
  double value_, sigma_;
};

// Costs on three numbers of every leg at once: `rows` residuals, each leg's derivatives in columns 3 i … 3 i
// + 2.
class AllLegsCost : public ceres::CostFunction {
 public:
  AllLegsCost(int rows, int first_entry) : first_entry_(first_entry) {
    mutable_parameter_block_sizes()->assign(kLegCount, kLegParameterCount);
    set_num_residuals(rows);
  }

 protected:
  void Scatter(const Eigen::MatrixXd& derivative, double** jacobians) const {
    if (jacobians == nullptr) return;
    for (int leg = 0; leg < kLegCount; ++leg) {
      if (jacobians[leg] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kLegParameterCount, Eigen::RowMajor>> block(
          jacobians[leg], num_residuals(), kLegParameterCount);
      block.setZero();
      block.middleCols<3>(first_entry_) = derivative.middleCols<3>(3 * leg);
    }
  }

 private:
  int first_entry_;
};

// Holds the platform frame to the rigid fit of B; no data pull against it, so any small sigma does.
class PlatformGaugeCost final : public AllLegsCost {
 public:
  explicit PlatformGaugeCost(const EstimationProblem& problem)
      : AllLegsCost(6, leg_parameter::kPlatformJoint),
        drawn_(problem.drawn_platform_joints),
        gauge_(PlatformGauge(problem.drawn_platform_joints) / kSigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Matrix<double, 18, 1> moved;
    for (int leg = 0; leg < kLegCount; ++leg)
      moved.segment<3>(3 * leg) =
          Eigen::Map<const LegParameters>(parameters[leg]).segment<3>(leg_parameter::kPlatformJoint) -
          drawn_[static_cast<size_t>(leg)];
    Eigen::Map<Vector6d>(residuals, 6) = gauge_ * moved;
    Scatter(gauge_, jacobians);
    return true;
  }

 private:
  static constexpr double kSigma_m = 1e-5;
  std::array<Eigen::Vector3d, kLegCount> drawn_;
  Eigen::Matrix<double, 6, 18> gauge_;
};

class DrawnBaseCost final : public AllLegsCost {
 public:
  explicit DrawnBaseCost(const EstimationProblem& problem)
      : AllLegsCost(18, leg_parameter::kBaseJoint), problem_(problem) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    SharedParameters shared = problem_.shared;
    for (size_t leg = 0; leg < kLegCount; ++leg)
      shared.legs[leg] = Eigen::Map<const LegParameters>(parameters[leg]);
    const DrawnBaseResidual r = EvaluateDrawnBase(problem_, shared);
    Eigen::Map<Eigen::VectorXd>(residuals, 18) = r.residual_m / problem_.base_joint_sigma_m;
    Scatter(r.d_base_joints / problem_.base_joint_sigma_m, jacobians);
    return true;
  }

 private:
  const EstimationProblem& problem_;
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

// Marks the entries [first, first + size) of the shared parameters that are not free as constant in their
// block.
void HoldFixedEntries(const EstimationProblem& estimation, int first, int size, double* block,
                      ceres::Problem& problem) {
  std::vector<int> held;
  for (int i = 0; i < size; ++i)
    if (!estimation.free[static_cast<size_t>(first + i)]) held.push_back(i);
  if (static_cast<int>(held.size()) == size)
    problem.SetParameterBlockConstant(block);
  else if (!held.empty())
    problem.SetManifold(block, new ceres::SubsetManifold(size, held));
}

class CeresProblem {
 public:
  explicit CeresProblem(EstimationProblem& estimation)
      : estimation_(estimation),
        displacements_(6 * estimation.units.size(), 0.0),
        problem_(ProblemOptions()) {
    for (double* block : SharedBlocks()) problem_.AddParameterBlock(block, BlockSize(block));
    for (size_t i = 0; i < estimation.units.size(); ++i)
      for (const LegObservation& observation : estimation.units[i].legs) AddLeg(i, observation);
    for (const ParameterPrior& prior : estimation.priors) AddPrior(prior);
    if (estimation.HasPlatformGauge()) AddAllLegs(new PlatformGaugeCost(estimation));
    if (estimation.base_joint_sigma_m > 0) AddAllLegs(new DrawnBaseCost(estimation));
    HoldFixedEntries(estimation, 0, kCameraParameterCount, Camera(), problem_);
    for (int leg = 0; leg < kLegCount; ++leg)
      HoldFixedEntries(estimation, FirstParameterOfLeg(leg), kLegParameterCount, Leg(leg), problem_);
  }

  SolveSummary Solve(const SolveOptions& options) {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (size_t i = 0; i < estimation_.units.size(); ++i)
      if (problem_.HasParameterBlock(&displacements_[6 * i]))
        solver.linear_solver_ordering->AddElementToGroup(&displacements_[6 * i], 0);
    for (double* block : SharedBlocks()) solver.linear_solver_ordering->AddElementToGroup(block, 1);
    solver.max_num_iterations = options.max_iterations;
    solver.function_tolerance = options.relative_tolerance;
    solver.parameter_tolerance = 1e-12;
    solver.gradient_tolerance = 1e-14;
    solver.num_threads = options.threads;
    solver.logging_type = ceres::SILENT;
    ProgressCallback progress(options.progress);
    if (options.progress) solver.callbacks.push_back(&progress);

    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    for (size_t i = 0; i < estimation_.units.size(); ++i)
      Displace(estimation_.units[i], &displacements_[6 * i]);
    return {summary.termination_type == ceres::CONVERGENCE, static_cast<int>(summary.iterations.size()) - 1,
            summary.final_cost};
  }

 private:
  static ceres::Problem::Options ProblemOptions() {
    ceres::Problem::Options options;
    options.disable_all_safety_checks =
        true;  // the blocks are laid out here; the checks cost more than the solve
    return options;
  }
  double* Camera() { return estimation_.shared.camera.data(); }
  double* Leg(int leg) { return estimation_.shared.legs[static_cast<size_t>(leg)].data(); }
  std::vector<double*> SharedBlocks() {
    std::vector<double*> blocks = {Camera()};
    for (int leg = 0; leg < kLegCount; ++leg) blocks.push_back(Leg(leg));
    return blocks;
  }
  int BlockSize(const double* block) {
    return block == Camera() ? kCameraParameterCount : kLegParameterCount;
  }

  void AddLeg(size_t unit, const LegObservation& observation) {
    if (RowCount(observation) == 0) return;
    problem_.AddResidualBlock(new LegCost(estimation_.units[unit], observation), nullptr, Camera(),
                              Leg(observation.leg), &displacements_[6 * unit]);
  }
  void AddPrior(const ParameterPrior& prior) {
    const bool of_camera = prior.parameter < kCameraParameterCount;
    const int of_leg = prior.parameter - kCameraParameterCount;
    double* block = of_camera ? Camera() : Leg(of_leg / kLegParameterCount);
    const int entry = of_camera ? prior.parameter : of_leg % kLegParameterCount;
    problem_.AddResidualBlock(new PriorCost(BlockSize(block), entry, prior.value, prior.sigma), nullptr,
                              block);
  }
  void AddAllLegs(ceres::CostFunction* cost) {
    std::vector<double*> blocks = SharedBlocks();
    blocks.erase(blocks.begin());
    problem_.AddResidualBlock(cost, nullptr, blocks);
  }

  EstimationProblem& estimation_;
  std::vector<double> displacements_;
  ceres::Problem problem_;
};

}  // namespace

SolveSummary Solve(EstimationProblem& problem, const SolveOptions& options) {
  return CeresProblem(problem).Solve(options);
}

}  // namespace legible
