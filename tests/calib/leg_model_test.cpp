#include "calib/leg_model.h"

#include <gtest/gtest.h>

#include <random>

#include "calib/estimation_problem.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

LegParameters RandomLeg(std::mt19937_64& generator) {
  LegParameters leg;
  leg << Eigen::Vector3d(0, 0.2, 0.9) + UniformVector(generator, -0.1, 0.1),
      UniformVector(generator, -0.2, 0.2), 0.01, 0.001, 0.05, -0.02, -0.03, 0.01;
  return leg;
}

template <int N>
Eigen::Matrix<double, N, 1> RandomDisplacement(std::mt19937_64& generator, double size) {
  Eigen::Matrix<double, N, 1> displacement;
  for (double& entry : displacement) entry = Uniform(generator, -size, size);
  return displacement;
}

// Small displacements, where the left Jacobian's closed form has no digits left, and large ones.
constexpr double kDisplacements[] = {0, 1e-7, 1e-4, 0.3};

TEST(TipOnPlatform, DerivativesAgreeWithNumericOnesAtAnyDisplacement) {
  std::mt19937_64 generator = TestGenerator();
  for (const double size : kDisplacements) {
    const LegParameters leg = RandomLeg(generator);
    const Rigid3 pose{UniformRotation(generator), UniformVector(generator, -0.1, 0.1)};
    const Vector6d at = RandomDisplacement<6>(generator, size);
    const LegTip tip = TipOnPlatform(leg, pose, at);
    const auto d_pose = NumericJacobian(
        [&](const Vector6d& moved) { return TipOnPlatform(leg, pose, moved).b_in_camera; }, at, 1e-3);
    EXPECT_TRUE(AreNear(tip.d_pose, d_pose, 1e-10)) << size;
    const auto of_leg = [&](const LegParameters& moved) {
      return TipOnPlatform(moved, pose, at).b_in_camera;
    };
    const auto d_leg = NumericJacobian(of_leg, leg, 1e-3);
    EXPECT_TRUE(AreNear(tip.d_base_joint, d_leg.leftCols<3>(), 1e-10));
    EXPECT_TRUE(AreNear(tip.d_platform_joint, d_leg.middleCols<3>(3), 1e-10));
    EXPECT_TRUE(AreNear(d_leg.rightCols<6>(), Eigen::Matrix<double, 3, 6>::Zero(), 1e-12));
  }
}

TEST(TipOnPlatform, IsThePlatformJointOfTheDisplacedPlatform) {
  std::mt19937_64 generator = TestGenerator();
  const LegParameters leg = RandomLeg(generator);
  const Rigid3 pose{UniformRotation(generator), UniformVector(generator, -0.1, 0.1)};
  const Vector6d displacement = RandomDisplacement<6>(generator, 0.3);
  EXPECT_TRUE(AreNear(TipOnPlatform(leg, pose, displacement).b_in_camera,
                      Displaced(pose, displacement) * leg.segment<3>(leg_parameter::kPlatformJoint), 1e-15));
}

TEST(TipAlongDirection, DerivativesAgreeWithNumericOnesAtAnyDisplacement) {
  std::mt19937_64 generator = TestGenerator();
  for (const double size : kDisplacements) {
    const LegParameters leg = RandomLeg(generator);
    const Eigen::Vector3d axis = UniformVector(generator, -0.3, 0.3);
    const Eigen::Vector2d at = RandomDisplacement<2>(generator, size);
    const LegTip tip = TipAlongDirection(leg, axis, at);
    const auto of_displacement = [&](const Eigen::Vector2d& moved) {
      return TipAlongDirection(leg, axis, moved).b_in_camera;
    };
    EXPECT_TRUE(AreNear(tip.d_pose, NumericJacobian(of_displacement, at), 1e-11));
    const auto d_leg = NumericJacobian(
        [&](const LegParameters& moved) { return TipAlongDirection(moved, axis, at).b_in_camera; }, leg);
    EXPECT_TRUE(AreNear(tip.d_base_joint, d_leg.leftCols<3>(), 1e-11));
    EXPECT_TRUE(AreNear(tip.d_platform_joint, d_leg.middleCols<3>(3), 1e-11));
  }
}

TEST(TipAlongDirection, MovesAcrossTheAxis) {
  std::mt19937_64 generator = TestGenerator();
  const Eigen::Vector3d axis = UniformVector(generator, -0.3, 0.3);
  const LegTip tip = TipAlongDirection(RandomLeg(generator), axis, Eigen::Vector2d::Zero());
  EXPECT_TRUE(AreNear(axis.transpose() * tip.d_pose, Eigen::RowVector2d::Zero(), 1e-15));
  EXPECT_TRUE(AreNear(tip.d_pose.transpose() * tip.d_pose, Eigen::Matrix2d::Identity(), 1e-15));
}

// One leg of a synthetic image with noise, common errors and a reading.
class LegInOneImage : public testing::Test {
 protected:
  LegInOneImage() {
    SyntheticOptions options;
    options.image_count = 1;
    options.samples_per_edge = 4;
    options.camera = DesktopCamera(true);
    session_ = GenerateSession(options);
    for (EdgeObservation& edge : session_.observations[0].edges) edge.common_sigma_px = 0.02;
    observation_ = {kLeg, {}, (*session_.observations[0].joint_readings_m)[kLeg], 2e-5};
    for (const EdgeObservation& edge : session_.observations[0].edges)
      if (edge.leg == kLeg)
        observation_.edges.emplace_back(edge, EdgeNoise{1.1, 0.8, 0.7}, Eigen::VectorXd::Ones(4));
    const Leg& leg = session_.true_robot.legs[kLeg];
    leg_ << session_.true_camera_from_base * leg.base_joint_m, leg.platform_joint_m, leg.radius_m,
        leg.joint_offset_m, 0.05, -0.02, -0.03, 0.01;
    camera_ = session_.true_camera;
    camera_from_platform_ = session_.true_camera_from_base * session_.true_base_from_platform[0];
  }

  // Compares all derivatives, with Pose numbers of pose from `unit`, column by column relative to the largest
  // entry.
  template <int Pose>
  void ExpectDerivativesAgree(const PoseUnit& unit,
                              const Eigen::Matrix<double, Pose, 1>& displacement) const {
    constexpr int kCount = kCameraParameterCount + kLegParameterCount + Pose;
    using Unknowns = Eigen::Matrix<double, kCount, 1>;
    const auto evaluate = [&](const Unknowns& u) {
      const LegParameters leg = u.template segment<kLegParameterCount>(kCameraParameterCount);
      const Eigen::Matrix<double, Pose, 1> moved = u.template tail<Pose>();
      return EvaluateLeg(WithParameters(camera_, u.template head<kCameraParameterCount>()), leg,
                         TipOf(unit, leg, moved.data()), observation_)
          .value();
    };
    Unknowns at;
    at << ParametersOf(camera_), leg_, displacement;
    const LegResiduals found = evaluate(at);
    Eigen::Matrix<double, kRows, kCount> derivative;
    derivative << found.d_camera, found.d_leg, found.d_pose;
    const Eigen::Matrix<double, kRows, kCount> numeric = NumericJacobian(
        [&](const Unknowns& u) -> Eigen::Matrix<double, kRows, 1> { return evaluate(u).residual; }, at, 1e-4);
    const Eigen::Matrix<double, 1, kCount> sizes = derivative.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-3);
    const auto relative = [&](const Eigen::MatrixXd& m) {
      return (m * sizes.cwiseInverse().asDiagonal()).eval();
    };
    EXPECT_TRUE(AreNear(relative(derivative), relative(numeric), 1e-6));
  }

  static constexpr int kLeg = 2, kRows = 9;  // two edges of four samples, and the reading
  SyntheticSession session_;
  LegObservation observation_;
  LegParameters leg_;
  Camera camera_;
  Rigid3 camera_from_platform_;
};

TEST_F(LegInOneImage, DerivativesAgreeWithNumericOnesOnARigidPlatform) {
  const PoseUnit unit{0, true, camera_from_platform_, {}, {}};
  ExpectDerivativesAgree<6>(unit, Vector6d::Zero());
  ExpectDerivativesAgree<6>(unit, (Vector6d() << 0.01, -0.02, 0.005, 0.03, 0.05, -0.04).finished());
}

TEST_F(LegInOneImage, DerivativesAgreeWithNumericOnesAlongAFreeDirection) {
  const Eigen::Vector3d tip = camera_from_platform_ * leg_.segment<3>(leg_parameter::kPlatformJoint);
  const PoseUnit unit{0, false, {}, tip - leg_.segment<3>(leg_parameter::kBaseJoint), {}};
  ExpectDerivativesAgree<2>(unit, Eigen::Vector2d::Zero());
  ExpectDerivativesAgree<2>(unit, Eigen::Vector2d(0.02, -0.01));
}

TEST_F(LegInOneImage, ReadingResidualIsTheLengthLessOffsetAndReadingInSigmas) {
  const PoseUnit unit{0, true, camera_from_platform_, {}, {}};
  const Vector6d at_rest = Vector6d::Zero();
  const LegTip tip = TipOf(unit, leg_, at_rest.data());
  const auto found = EvaluateLeg(camera_, leg_, tip, observation_);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->residual.size(), RowCount(observation_));
  const double length_m = (tip.b_in_camera - leg_.segment<3>(leg_parameter::kBaseJoint)).norm();
  EXPECT_NEAR(found->residual[kRows - 1],
              (length_m - leg_[leg_parameter::kJointOffset] - *observation_.reading_m) / 2e-5, 1e-9);
}

TEST_F(LegInOneImage, ResidualsVanishAtTheTruthOfExactEdges) {
  leg_.tail<4>().setZero();
  LegObservation exact{kLeg, {}, (*session_.exact_observations[0].joint_readings_m)[kLeg], 2e-5};
  for (const EdgeObservation& edge : session_.exact_observations[0].edges)
    if (edge.leg == kLeg) exact.edges.emplace_back(edge, EdgeNoise{}, Eigen::VectorXd::Ones(4));
  const Vector6d at_rest = Vector6d::Zero();
  const auto found = EvaluateLeg(camera_, leg_, TipOnPlatform(leg_, camera_from_platform_, at_rest), exact);
  ASSERT_TRUE(found);
  EXPECT_TRUE(AreNear(found->residual, Eigen::VectorXd::Zero(kRows), 1e-9));
}

TEST_F(LegInOneImage, DisplacingAUnitMovesTheTipAsTheDisplacementDid) {
  const Vector6d displacement = (Vector6d() << 0.01, -0.02, 0.005, 0.03, 0.05, -0.04).finished();
  const Vector6d at_rest = Vector6d::Zero();
  PoseUnit rigid{0, true, camera_from_platform_, {}, {}};
  PoseUnit free{0, false, {}, {0.1, 0.2, 0.3}, {}};
  for (PoseUnit* unit : {&rigid, &free}) {
    const Eigen::Vector3d moved = TipOf(*unit, leg_, displacement.data()).b_in_camera;
    Displace(*unit, displacement.data());
    EXPECT_TRUE(AreNear(TipOf(*unit, leg_, at_rest.data()).b_in_camera, moved, 1e-14));
  }
}

}  // namespace
}  // namespace legible
