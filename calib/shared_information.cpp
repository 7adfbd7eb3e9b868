#include "calib/shared_information.h"

#include <Eigen/QR>
#include <stdexcept>

#include "calib/board/board_information.h"

namespace legible {
namespace {

// Derivatives of some residuals by the unknowns from `first` on.
struct DerivativeBlock {
  Eigen::Index first;
  Eigen::MatrixXd derivative;
};

void Add(const std::vector<DerivativeBlock>& blocks, Eigen::MatrixXd& information) {
  for (const DerivativeBlock& a : blocks)
    for (const DerivativeBlock& b : blocks)
      information.block(a.first, b.first, a.derivative.cols(), b.derivative.cols()) +=
          a.derivative.transpose() * b.derivative;
}

// Where all A are among the unknowns.
void AddByBaseJoints(const Eigen::MatrixXd& d_base_joints, std::vector<DerivativeBlock>& blocks) {
  for (int leg = 0; leg < kLegCount; ++leg)
    blocks.push_back(
        {FirstParameterOfLeg(leg) + leg_parameter::kBaseJoint, d_base_joints.middleCols<3>(3 * leg)});
}

// Information of all unknowns but the last `count`, whatever these are. A direction among those that nothing
// tells of takes no information with it: the pseudo-inverse.
Eigen::MatrixXd WithoutLast(const Eigen::MatrixXd& information, Eigen::Index count) {
  if (count == 0) return information;
  const Eigen::Index rest = information.rows() - count;
  const Eigen::MatrixXd cross = information.topRightCorner(rest, count);
  return information.topLeftCorner(rest, rest) - cross * information.bottomRightCorner(count, count)
                                                             .completeOrthogonalDecomposition()
                                                             .solve(cross.transpose());
}

void Demand(bool is_evaluated) {
  if (!is_evaluated)
    throw std::runtime_error("SharedInformation: the model cannot be evaluated at its own solution");
}

// The unknowns in a row: the shared parameters, the tags' placements and, of one unit at a time, its pose.
class Information {
 public:
  explicit Information(const EstimationProblem& problem)
      : problem_(problem),
        first_pose_(FirstOfGroup(problem.tag_placements.size())),
        sum_(Eigen::MatrixXd::Zero(first_pose_, first_pose_)) {}

  Eigen::MatrixXd OfSharedParameters() {
    for (const PoseUnit& unit : problem_.units) AddUnit(unit);
    for (const TagObservation& tag : problem_.base_tags) AddTag(tag, Rigid3(), {}, sum_);
    AddPlacements();
    for (const ParameterPrior& prior : problem_.priors)
      sum_(prior.parameter, prior.parameter) += 1 / (prior.sigma * prior.sigma);
    sum_.topLeftCorner<kCameraParameterCount, kCameraParameterCount>() +=
        problem_.camera_prior.root.transpose() * problem_.camera_prior.root;
    if (problem_.board) AddBoard(*problem_.board);
    if (problem_.base_joint_sigma_m > 0) AddDrawnBase();
    return WithoutLast(sum_, first_pose_ - kSharedParameterCount);
  }

 private:
  static Eigen::Index FirstOfGroup(size_t group) {
    return kSharedParameterCount + 6 * static_cast<Eigen::Index>(group);
  }

  void AddUnit(const PoseUnit& unit) {
    const double at_rest[6] = {};
    Eigen::MatrixXd with_pose = Eigen::MatrixXd::Zero(first_pose_ + unit.size(), first_pose_ + unit.size());
    for (const LegObservation& observation : unit.legs) {
      const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(observation.leg)];
      const auto r = EvaluateLeg(CameraOf(problem_), leg, TipOf(unit, leg, at_rest), observation);
      Demand(r.has_value());
      Add({{0, r->d_camera}, {FirstParameterOfLeg(observation.leg), r->d_leg}, {first_pose_, r->d_pose}},
          with_pose);
    }
    for (const TagObservation& tag : unit.tags)
      AddTag(tag, unit.camera_from_platform, {first_pose_}, with_pose);
    sum_ += WithoutLast(with_pose, unit.size());
  }

  void AddTag(const TagObservation& tag, const Rigid3& camera_from_platform,
              const std::optional<Eigen::Index>& pose, Eigen::MatrixXd& information) const {
    const auto r = EvaluateTag(CameraOf(problem_), problem_.tag_placements[tag.group], Vector6d::Zero(),
                               camera_from_platform, Vector6d::Zero(), tag);
    Demand(r.has_value());
    std::vector<DerivativeBlock> blocks = {{0, r->d_camera}, {FirstOfGroup(tag.group), r->d_placement}};
    if (pose) blocks.push_back({*pose, r->d_pose});
    Add(blocks, information);
  }

  void AddPlacements() {
    const std::vector<PlacementResiduals> residuals = EvaluatePlacements(problem_);
    for (size_t group = 0; group < residuals.size(); ++group) {
      std::vector<DerivativeBlock> blocks = {{FirstOfGroup(group), residuals[group].d_placement}};
      AddByBaseJoints(residuals[group].d_base_joints, blocks);
      Add(blocks, sum_);
    }
  }

  void AddBoard(BoardProblem board) {
    board.camera = WithParameters(problem_.camera, problem_.shared.camera);
    const Eigen::MatrixXd information = InformationOf(board).information;
    sum_.topLeftCorner(information.rows(), information.cols()) += information;
  }

  void AddDrawnBase() {
    std::vector<DerivativeBlock> blocks;
    AddByBaseJoints(EvaluateDrawnBase(problem_, problem_.shared).d_base_joints / problem_.base_joint_sigma_m,
                    blocks);
    Add(blocks, sum_);
  }

  const EstimationProblem& problem_;
  Eigen::Index first_pose_;
  Eigen::MatrixXd sum_;
};

}  // namespace

Eigen::MatrixXd SharedInformation(const EstimationProblem& problem) {
  Eigen::MatrixXd information = Information(problem).OfSharedParameters();
  for (int i = 0; i < kSharedParameterCount; ++i) {
    if (problem.free[static_cast<size_t>(i)]) continue;
    information.row(i).setZero();
    information.col(i).setZero();
  }
  return information;
}

}  // namespace legible
