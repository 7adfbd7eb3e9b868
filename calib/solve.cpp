// Least squares by Ceres.
#include <ceres/ceres.h>

#include <memory>
#include <optional>

#include "calib/board/view_cost.h"
#include "calib/estimation_problem.h"
#include "calib/progress_callback.h"

namespace legible {
namespace {

void CopyRowMajor(const Eigen::MatrixXd& jacobian, double* to) {
  if (to == nullptr) return;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      to, jacobian.rows(), jacobian.cols()) = jacobian;
}

// One leg in one image: blocks camera (12), leg (12), pose of the unit (6 or 2).
class LegCost final : public ceres::CostFunction {
 public:
  LegCost(const Camera& lens, const PoseUnit& unit, const LegObservation& observation)
      : lens_(lens), unit_(unit), observation_(observation) {
    *mutable_parameter_block_sizes() = {kCameraParameterCount, kLegParameterCount, unit.size()};
    set_num_residuals(static_cast<int>(RowCount(observation)));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Camera camera = WithParameters(lens_, Eigen::Map<const CameraParameters>(parameters[0]));
    const LegParameters leg = Eigen::Map<const LegParameters>(parameters[1]);
    const auto r = EvaluateLeg(camera, leg, TipOf(unit_, leg, parameters[2]), observation_);
    if (!r) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = r->residual;
    if (jacobians == nullptr) return true;
    CopyRowMajor(r->d_camera, jacobians[0]);
    CopyRowMajor(r->d_leg, jacobians[1]);
    CopyRowMajor(r->d_pose, jacobians[2]);
    return true;
  }

 private:
  const Camera& lens_;
  const PoseUnit& unit_;
  const LegObservation& observation_;
};

// One tag: blocks camera (12), placement of its group (6) and, on the platform, the pose of the unit (6).
class TagCost final : public ceres::CostFunction {
 public:
  TagCost(const Camera& lens, const TagPlacement& placement, const PoseUnit* unit,
          const TagObservation& observation)
      : lens_(lens), placement_(placement), unit_(unit), observation_(observation) {
    *mutable_parameter_block_sizes() = {kCameraParameterCount, 6};
    if (unit != nullptr) mutable_parameter_block_sizes()->push_back(6);
    set_num_residuals(kTagRows);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Camera camera = WithParameters(lens_, Eigen::Map<const CameraParameters>(parameters[0]));
    const Vector6d placed = Eigen::Map<const Vector6d>(parameters[1]);
    const Vector6d posed =
        unit_ != nullptr ? Vector6d(Eigen::Map<const Vector6d>(parameters[2])) : Vector6d::Zero();
    const Rigid3 platform = unit_ != nullptr ? unit_->camera_from_platform : Rigid3();
    const auto r = EvaluateTag(camera, placement_, placed, platform, posed, observation_);
    if (!r) return false;
    Eigen::Map<Eigen::Matrix<double, kTagRows, 1>> rows(residuals);
    rows = r->residual;
    if (jacobians == nullptr) return true;
    CopyRowMajor(r->d_camera, jacobians[0]);
    CopyRowMajor(r->d_placement, jacobians[1]);
    if (unit_ != nullptr) CopyRowMajor(r->d_pose, jacobians[2]);
    return true;
  }

 private:
  const Camera& lens_;
  const TagPlacement& placement_;
  const PoseUnit* unit_;  // none on the base
  const TagObservation& observation_;
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

// What a board has told of the camera.
class CameraPriorCost final : public ceres::CostFunction {
 public:
  explicit CameraPriorCost(const CameraPrior& prior) : prior_(prior) {
    *mutable_parameter_block_sizes() = {kCameraParameterCount};
    set_num_residuals(static_cast<int>(prior.root.rows()));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
        prior_.Residual(Eigen::Map<const CameraParameters>(parameters[0]));
    if (jacobians != nullptr) CopyRowMajor(prior_.root, jacobians[0]);
    return true;
  }

 private:
  const CameraPrior& prior_;
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
  // With the legs' blocks; the camera is not looked at.
  static SharedParameters SharedFrom(double const* const* parameters) {
    SharedParameters shared{CameraParameters::Zero(), {}};
    for (size_t leg = 0; leg < kLegCount; ++leg)
      shared.legs[leg] = Eigen::Map<const LegParameters>(parameters[leg]);
    return shared;
  }
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
    const DrawnBaseResidual r = EvaluateDrawnBase(problem_, SharedFrom(parameters));
    Eigen::Map<Eigen::VectorXd>(residuals, 18) = r.residual_m / problem_.base_joint_sigma_m;
    Scatter(r.d_base_joints / problem_.base_joint_sigma_m, jacobians);
    return true;
  }

 private:
  const EstimationProblem& problem_;
};

// What is known of a group's placement: blocks of all legs, then the placement (6).
class PlacementCost final : public AllLegsCost {
 public:
  PlacementCost(const EstimationProblem& problem, const TagPlacement& placement)
      : AllLegsCost(6, leg_parameter::kBaseJoint), problem_(problem), placement_(placement) {
    mutable_parameter_block_sizes()->push_back(6);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Vector6d placed = Eigen::Map<const Vector6d>(parameters[kLegCount]);
    const PlacementResiduals r = EvaluatePlacement(
        placement_, placed,
        FitBaseFrame(BaseJointsInCamera(SharedFrom(parameters)), problem_.drawn_base_joints));
    Eigen::Map<Vector6d>(residuals, 6) = r.residual;
    Scatter(r.d_base_joints, jacobians);
    if (jacobians != nullptr) CopyRowMajor(r.d_placement, jacobians[kLegCount]);
    return true;
  }

 private:
  const EstimationProblem& problem_;
  const TagPlacement& placement_;
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
        placements_(6 * estimation.tag_placements.size(), 0.0),
        problem_(ProblemOptions()) {
    for (double* block : SharedBlocks()) problem_.AddParameterBlock(block, BlockSize(block));
    for (size_t i = 0; i < estimation.units.size(); ++i) {
      for (const LegObservation& observation : estimation.units[i].legs) AddLeg(i, observation);
      for (const TagObservation& tag : estimation.units[i].tags) AddTag(i, tag);
    }
    for (const TagObservation& tag : estimation.base_tags) AddTag(std::nullopt, tag);
    for (size_t i = 0; i < estimation.tag_placements.size(); ++i)
      AddAllLegs(new PlacementCost(estimation, estimation.tag_placements[i]), {&placements_[6 * i]});
    if (estimation.board) AddBoard(*estimation.board);
    for (const ParameterPrior& prior : estimation.priors) AddPrior(prior);
    if (estimation.camera_prior.root.rows() > 0)
      problem_.AddResidualBlock(new CameraPriorCost(estimation.camera_prior), nullptr, Camera());
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
    for (Vector6d& displacement : board_displacements_)
      solver.linear_solver_ordering->AddElementToGroup(displacement.data(), 0);
    if (estimation_.board && estimation_.board->estimates_warp)
      solver.linear_solver_ordering->AddElementToGroup(estimation_.board->warp.bend_m.data(), 1);
    for (double* block : SharedBlocks()) solver.linear_solver_ordering->AddElementToGroup(block, 1);
    for (size_t i = 0; i < placements_.size(); i += 6)
      solver.linear_solver_ordering->AddElementToGroup(&placements_[i], 1);
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
    for (size_t i = 0; i < estimation_.tag_placements.size(); ++i) {
      Rigid3& placement = estimation_.tag_placements[i].parent_from_group;
      placement = Displaced(placement, Eigen::Map<const Vector6d>(&placements_[6 * i]));
    }
    for (size_t i = 0; i < board_displacements_.size(); ++i) {
      Rigid3& pose = estimation_.board->views[i].camera_from_board;
      pose = Displaced(pose, board_displacements_[i]);
    }
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
    problem_.AddResidualBlock(new LegCost(estimation_.camera, estimation_.units[unit], observation), nullptr,
                              Camera(), Leg(observation.leg), &displacements_[6 * unit]);
  }
  void AddPrior(const ParameterPrior& prior) {
    const bool of_camera = prior.parameter < kCameraParameterCount;
    const int of_leg = prior.parameter - kCameraParameterCount;
    double* block = of_camera ? Camera() : Leg(of_leg / kLegParameterCount);
    const int entry = of_camera ? prior.parameter : of_leg % kLegParameterCount;
    problem_.AddResidualBlock(new PriorCost(BlockSize(block), entry, prior.value, prior.sigma), nullptr,
                              block);
  }
  void AddTag(const std::optional<size_t>& unit, const TagObservation& tag) {
    const TagPlacement& placement = estimation_.tag_placements[tag.group];
    std::vector<double*> blocks = {Camera(), &placements_[6 * tag.group]};
    if (unit) blocks.push_back(&displacements_[6 * *unit]);
    problem_.AddResidualBlock(
        new TagCost(estimation_.camera, placement, unit ? &estimation_.units[*unit] : nullptr, tag), nullptr,
        blocks);
  }
  void AddBoard(BoardProblem& board) {
    board_displacements_.assign(board.views.size(), Vector6d::Zero());
    for (size_t i = 0; i < board.views.size(); ++i) {
      std::vector<double*> blocks = {Camera(), board_displacements_[i].data()};
      if (board.estimates_warp) blocks.push_back(board.warp.bend_m.data());
      problem_.AddResidualBlock(new ViewCost(board, board.views[i], kCameraParameterCount), nullptr, blocks);
    }
  }
  void AddAllLegs(ceres::CostFunction* cost, const std::vector<double*>& others = {}) {
    std::vector<double*> blocks = SharedBlocks();
    blocks.erase(blocks.begin());
    blocks.insert(blocks.end(), others.begin(), others.end());
    problem_.AddResidualBlock(cost, nullptr, blocks);
  }

  EstimationProblem& estimation_;
  std::vector<double> displacements_;          // of the units' poses, 6 each
  std::vector<double> placements_;             // displacements of the tag groups, 6 each
  std::vector<Vector6d> board_displacements_;  // of the board's poses
  ceres::Problem problem_;
};

}  // namespace

SolveSummary Solve(EstimationProblem& problem, const SolveOptions& options) {
  return CeresProblem(problem).Solve(options);
}

}  // namespace legible
