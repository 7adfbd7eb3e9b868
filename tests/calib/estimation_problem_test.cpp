#include "calib/estimation_problem.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/calib/truth_problem.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

TEST(PlatformGauge, VanishesForTheRigidFitToTheDrawing) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod();
  std::array<Eigen::Vector3d, kLegCount> drawn;
  std::vector<Eigen::Vector3d> drawn_list, moved;
  const Rigid3 motion{UniformRotation(generator), UniformVector(generator, -1, 1)};
  for (size_t i = 0; i < kLegCount; ++i) {
    drawn[i] = robot.legs[i].platform_joint_m;
    drawn_list.push_back(drawn[i]);
    moved.push_back(motion * (drawn[i] + UniformVector(generator, -0.02, 0.02)));
  }
  const Rigid3 fit = FitRigid(moved, drawn_list);
  Eigen::Matrix<double, 18, 1> displacement;
  for (size_t i = 0; i < kLegCount; ++i)
    displacement.segment<3>(3 * static_cast<Eigen::Index>(i)) = fit * moved[i] - drawn[i];
  EXPECT_GT(displacement.norm(), 0.01);
  EXPECT_TRUE(AreNear(PlatformGauge(drawn) * displacement, Vector6d::Zero(), 1e-14));
}

TEST(PlatformGauge, HasOrthonormalRows) {
  std::array<Eigen::Vector3d, kLegCount> drawn;
  for (size_t i = 0; i < kLegCount; ++i) drawn[i] = DesktopHexapod().legs[i].platform_joint_m;
  const Eigen::Matrix<double, 6, 18> gauge = PlatformGauge(drawn);
  EXPECT_TRUE(AreNear(gauge * gauge.transpose(), Matrix6d::Identity(), 1e-14));
}

using Joints = Eigen::Matrix<double, 18, 1>;

Joints BaseJointsOf(const SharedParameters& shared) {
  Joints joints;
  for (int i = 0; i < kLegCount; ++i)
    joints.segment<3>(3 * i) = shared.legs[static_cast<size_t>(i)].segment<3>(leg_parameter::kBaseJoint);
  return joints;
}

Joints DrawnBaseResidualAt(const EstimationProblem& problem, const Joints& joints) {
  SharedParameters shared = problem.shared;
  for (int i = 0; i < kLegCount; ++i)
    shared.legs[static_cast<size_t>(i)].segment<3>(leg_parameter::kBaseJoint) = joints.segment<3>(3 * i);
  return EvaluateDrawnBase(problem, shared).residual_m;
}

TEST(DrawnBase, DerivativeIsExact) {
  const SyntheticSession session = SmallSession();
  const EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  const DrawnBaseResidual found = EvaluateDrawnBase(problem, problem.shared);
  EXPECT_GT(found.residual_m.norm(), 1e-4);
  const auto numeric =
      NumericJacobian([&](const Joints& joints) { return DrawnBaseResidualAt(problem, joints); },
                      BaseJointsOf(problem.shared));
  EXPECT_TRUE(AreNear(found.d_base_joints, numeric, 1e-8));
}

TEST(DrawnBase, IsZeroWhereTheDrawingIsTheTruth) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  for (size_t i = 0; i < kLegCount; ++i)
    problem.drawn_base_joints[i] = session.true_robot.legs[i].base_joint_m;
  EXPECT_TRUE(AreNear(EvaluateDrawnBase(problem, problem.shared).residual_m, Joints::Zero(), 1e-14));
}

TEST(ParameterName, NamesEveryParameterInOrder) {
  for (const LensModel lens : {LensModel::kRational, LensModel::kFisheye}) {
    EXPECT_EQ(ParameterName(lens, 0), "camera.fx_px");
    EXPECT_EQ(ParameterName(lens, lens == LensModel::kFisheye ? 6 : 8), "camera.k3");
    EXPECT_EQ(ParameterName(lens, FirstParameterOfLeg(0)), "legs[1].base_joint_in_camera_m.x");
    EXPECT_EQ(ParameterName(lens, FirstParameterOfLeg(5) + leg_parameter::kRadius), "legs[6].radius_m");
  }
}

TEST(Solve, FindsTheTruthOfExactObservationsAgain) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {});
  problem.free.reset();
  for (int leg = 0; leg < kLegCount; ++leg)
    problem.free.set(static_cast<size_t>(FirstParameterOfLeg(leg) + leg_parameter::kRadius));
  const SharedParameters truth = problem.shared;
  for (LegParameters& leg : problem.shared.legs) leg[leg_parameter::kRadius] += 0.002;
  const Vector6d moved = (Vector6d() << 0.003, -0.002, 0.001, 0.01, -0.01, 0.02).finished();
  for (PoseUnit& unit : problem.units) Displace(unit, moved.data());
  const SolveSummary summary = Solve(problem, {});
  EXPECT_TRUE(summary.converged);
  EXPECT_LT(summary.cost, 1e-12);
  for (size_t i = 0; i < kLegCount; ++i) EXPECT_TRUE(AreNear(problem.shared.legs[i], truth.legs[i], 1e-10));
}

}  // namespace
}  // namespace legible
