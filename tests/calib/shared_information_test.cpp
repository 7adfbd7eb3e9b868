#include "calib/shared_information.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/calib/synthetic_tags.h"
#include "tests/calib/truth_problem.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

// All residuals of a problem whose shared parameters, poses and tag placements are moved by `displacement`,
// in that order.
Eigen::VectorXd ResidualsAt(const EstimationProblem& problem, const Eigen::VectorXd& displacement) {
  SharedParameters shared = problem.shared;
  for (int i = 0; i < kSharedParameterCount; ++i) Parameter(shared, i) += displacement[i];
  const Camera camera = WithParameters(problem.camera, shared.camera);
  std::vector<double> all;
  const auto placed = [&](size_t group) -> Vector6d {
    return displacement.tail(6 * static_cast<Eigen::Index>(problem.tag_placements.size() - group)).head<6>();
  };
  const auto add_tag = [&](const TagObservation& tag, const Rigid3& platform, const Vector6d& posed) {
    const auto r =
        EvaluateTag(camera, problem.tag_placements[tag.group], placed(tag.group), platform, posed, tag);
    all.insert(all.end(), r->residual.begin(), r->residual.end());
  };
  Eigen::Index first = kSharedParameterCount;
  for (const PoseUnit& unit : problem.units) {
    for (const LegObservation& observation : unit.legs) {
      const LegParameters& leg = shared.legs[static_cast<size_t>(observation.leg)];
      const LegTip tip = TipOf(unit, leg, displacement.data() + first);
      const Eigen::VectorXd rows = EvaluateLeg(camera, leg, tip, observation).value().residual;
      all.insert(all.end(), rows.begin(), rows.end());
    }
    for (const TagObservation& tag : unit.tags)
      add_tag(tag, unit.camera_from_platform, displacement.segment<6>(first));
    first += unit.size();
  }
  for (const TagObservation& tag : problem.base_tags) add_tag(tag, Rigid3(), Vector6d::Zero());
  const BaseFrame base = FitBaseFrame(BaseJointsInCamera(shared), problem.drawn_base_joints);
  for (size_t group = 0; group < problem.tag_placements.size(); ++group)
    for (const double residual :
         EvaluatePlacement(problem.tag_placements[group], placed(group), base).residual)
      all.push_back(residual);
  for (const ParameterPrior& prior : problem.priors)
    all.push_back((Parameter(shared, prior.parameter) - prior.value) / prior.sigma);
  if (problem.base_joint_sigma_m > 0)
    for (const double residual_m : EvaluateDrawnBase(problem, shared).residual_m)
      all.push_back(residual_m / problem.base_joint_sigma_m);
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

// Central differences of the fourth order of ResidualsAt.
Eigen::MatrixXd NumericDerivatives(const EstimationProblem& problem) {
  constexpr double kStep = 1e-4;
  Eigen::Index unknowns = kSharedParameterCount;
  for (const PoseUnit& unit : problem.units) unknowns += unit.size();
  unknowns += 6 * static_cast<Eigen::Index>(problem.tag_placements.size());
  Eigen::MatrixXd jacobian(ResidualsAt(problem, Eigen::VectorXd::Zero(unknowns)).size(), unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const auto at = [&](double steps) {
      return ResidualsAt(problem, Eigen::VectorXd::Unit(unknowns, i) * steps * kStep);
    };
    jacobian.col(i) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kStep);
  }
  return jacobian;
}

// Information of the free shared parameters once poses and placements are eliminated: Schur's complement in
// dense matrices.
Eigen::MatrixXd NumericInformation(const EstimationProblem& problem) {
  const Eigen::MatrixXd jacobian = NumericDerivatives(problem);
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  const Eigen::Index others = hessian.rows() - kSharedParameterCount;
  const Eigen::MatrixXd cross = hessian.topRightCorner(kSharedParameterCount, others);
  Eigen::MatrixXd information =
      hessian.topLeftCorner<kSharedParameterCount, kSharedParameterCount>() -
      cross * hessian.bottomRightCorner(others, others).ldlt().solve(cross.transpose());
  for (int i = 0; i < kSharedParameterCount; ++i)
    if (!problem.free[static_cast<size_t>(i)]) {
      information.row(i).setZero();
      information.col(i).setZero();
    }
  return information;
}

// Both with the diagonal of `expected` scaled to 1.
void ExpectSameInformation(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, double tolerance) {
  const Eigen::VectorXd scale =
      expected.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
  EXPECT_TRUE(AreNear(scale.asDiagonal() * found * scale.asDiagonal(),
                      scale.asDiagonal() * expected * scale.asDiagonal(), tolerance));
}

TEST(SharedInformation, IsTheSchurComplementOfAllResiduals) {
  const SyntheticSession session = SmallSession();
  const EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  ExpectSameInformation(SharedInformation(problem), NumericInformation(problem), 1e-6);
}

TEST(SharedInformation, IsTheSchurComplementOfAllResidualsWithFreeLegs) {
  const SyntheticSession session = SmallSession();
  const EstimationProblem problem = ProblemAtTruth(session, session.observations, {.rigid_platform = false});
  ExpectSameInformation(SharedInformation(problem), NumericInformation(problem), 1e-6);
}

TEST(SharedInformation, CountsWhatIsKnownBeforehand) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  const Eigen::MatrixXd without = SharedInformation(problem);
  const int radius = FirstParameterOfLeg(3) + leg_parameter::kRadius;
  problem.priors = {{0, problem.shared.camera[0] + 1, 0.5}, {radius, 0.01, 1e-4}};
  problem.base_joint_sigma_m = 1e-3;
  const Eigen::MatrixXd with = SharedInformation(problem);
  ExpectSameInformation(with, NumericInformation(problem), 1e-6);
  EXPECT_NEAR(with(0, 0) - without(0, 0), 4, 1e-6);
}

TEST(SharedInformation, CountsTagsAndWhatIsKnownOfTheirPlaces) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  const Eigen::MatrixXd without = SharedInformation(problem);
  AddTagsToProblem(DrawTags(session, {}), 0.05, problem);
  const Eigen::MatrixXd with = SharedInformation(problem);
  ExpectSameInformation(with, NumericInformation(problem), 1e-6);
  EXPECT_GT(with(0, 0), without(0, 0));
}

TEST(SharedInformation, HasNoRowsForWhatIsHeld) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  problem.free.reset(0);
  const Eigen::MatrixXd information = SharedInformation(problem);
  EXPECT_EQ(information.row(0).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(information.col(0).cwiseAbs().maxCoeff(), 0);
  ExpectSameInformation(information, NumericInformation(problem), 1e-6);
}

}  // namespace
}  // namespace legible
