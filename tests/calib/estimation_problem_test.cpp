#include "calib/estimation_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "tests/calib/truth_problem.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

SyntheticSession SmallSession() {
  SyntheticOptions options;
  options.image_count = 3;
  options.samples_per_edge = 5;
  options.camera = DesktopCamera(true);
  SyntheticSession session = GenerateSession(options);
  for (ImageObservation& image : session.observations)
    for (EdgeObservation& edge : image.edges) edge.common_sigma_px = 0.05;
  return session;
}

// All residuals of a problem whose shared parameters and poses are moved by `displacement`: the shared ones
// first.
Eigen::VectorXd ResidualsAt(const EstimationProblem& problem, const Eigen::VectorXd& displacement) {
  SharedParameters shared = problem.shared;
  for (int i = 0; i < kSharedParameterCount; ++i) Parameter(shared, i) += displacement[i];
  std::vector<double> all;
  Eigen::Index first = kSharedParameterCount;
  for (const PoseUnit& unit : problem.units) {
    for (const LegObservation& observation : unit.legs) {
      const LegParameters& leg = shared.legs[static_cast<size_t>(observation.leg)];
      const LegTip tip = TipOf(unit, leg, displacement.data() + first);
      const Eigen::VectorXd rows = EvaluateLeg(shared.camera, leg, tip, observation).value().residual;
      all.insert(all.end(), rows.begin(), rows.end());
    }
    first += unit.size();
  }
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
  Eigen::MatrixXd jacobian(ResidualsAt(problem, Eigen::VectorXd::Zero(unknowns)).size(), unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const auto at = [&](double steps) {
      return ResidualsAt(problem, Eigen::VectorXd::Unit(unknowns, i) * steps * kStep);
    };
    jacobian.col(i) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kStep);
  }
  return jacobian;
}

// Information of the free shared parameters once the poses are eliminated: Schur's complement in dense
// matrices.
Eigen::MatrixXd NumericInformation(const EstimationProblem& problem) {
  const Eigen::MatrixXd jacobian = NumericDerivatives(problem);
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  const Eigen::Index poses = hessian.rows() - kSharedParameterCount;
  const Eigen::MatrixXd cross = hessian.topRightCorner(kSharedParameterCount, poses);
  Eigen::MatrixXd information =
      hessian.topLeftCorner<kSharedParameterCount, kSharedParameterCount>() -
      cross * hessian.bottomRightCorner(poses, poses).ldlt().solve(cross.transpose());
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
  // About the true base the residual is zero and its derivative exact.
  for (size_t i = 0; i < kLegCount; ++i)
    problem.drawn_base_joints[i] = session.true_robot.legs[i].base_joint_m;
  problem.base_joint_sigma_m = 1e-3;
  const Eigen::MatrixXd with = SharedInformation(problem);
  ExpectSameInformation(with, NumericInformation(problem), 1e-6);
  EXPECT_NEAR(with(0, 0) - without(0, 0), 4, 1e-6);
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

TEST(DrawnBase, DerivativeIsExactAtZeroResidual) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  for (size_t i = 0; i < kLegCount; ++i)
    problem.drawn_base_joints[i] = session.true_robot.legs[i].base_joint_m;
  const DrawnBaseResidual found = EvaluateDrawnBase(problem, problem.shared);
  EXPECT_TRUE(AreNear(found.residual_m, Joints::Zero(), 1e-14));
  const auto numeric =
      NumericJacobian([&](const Joints& joints) { return DrawnBaseResidualAt(problem, joints); },
                      BaseJointsOf(problem.shared));
  EXPECT_TRUE(AreNear(found.d_base_joints, numeric, 1e-8));
}

TEST(DrawnBase, GradientOfItsSquareIsExactAtAnyResidual) {
  const SyntheticSession session = SmallSession();
  const EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  const DrawnBaseResidual found = EvaluateDrawnBase(problem, problem.shared);
  EXPECT_GT(found.residual_m.norm(), 1e-4);
  const auto numeric = NumericJacobian(
      [&](const Joints& joints) {
        return Eigen::Matrix<double, 1, 1>(DrawnBaseResidualAt(problem, joints).squaredNorm() / 2);
      },
      BaseJointsOf(problem.shared));
  EXPECT_TRUE(AreNear(found.residual_m.transpose() * found.d_base_joints, numeric, 1e-9));
}

TEST(ParameterName, NamesEveryParameterInOrder) {
  EXPECT_EQ(ParameterName(0), "camera.fx_px");
  EXPECT_EQ(ParameterName(8), "camera.k3");
  EXPECT_EQ(ParameterName(FirstParameterOfLeg(0)), "legs[1].base_joint_in_camera_m.x");
  EXPECT_EQ(ParameterName(FirstParameterOfLeg(5) + leg_parameter::kRadius), "legs[6].radius_m");
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
