#include "calib/pose_proposal.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "calib/calibrated_model.h"
#include "datasets/synthetic_session.h"
#include "tests/calib/random_rigs.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

LegCalibrationInput InputOf(const RigModel& model, const std::vector<ImageObservation>& images = {}) {
  LegCalibrationInput input{model.robot, model.camera, model.camera_from_base, images, {}, std::nullopt};
  input.known.joint_reading_m = 2e-5;
  return input;
}

RigModel DesktopRig() {
  return {DesktopHexapod(), DesktopCamera(true), LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})};
}

PoseProposalOptions Few(int candidates) {
  PoseProposalOptions options;
  options.candidates.count = candidates;
  options.planned_images = 3;
  return options;
}

// ---- PoseErrorOf

LegPoints BaseJoints(const RigModel& rig) {
  LegPoints joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = rig.camera_from_base * rig.robot.legs[i].base_joint_m;
  return joints;
}

LegPoints DrawnBaseJoints(const RigModel& rig) {
  LegPoints joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = rig.robot.legs[i].base_joint_m;
  return joints;
}

TEST(PoseError, IsHowFarForwardKinematicsMovesWithTheGeometry) {
  std::mt19937_64 generator = TestGenerator();
  const RigModel rig = DesktopRig();
  const std::vector<Rigid3> poses = DrawReachablePoses(rig.robot, 5, 7, {});
  const Eigen::MatrixXd by_shared = ModelBySharedParameters(BaseJoints(rig), DrawnBaseJoints(rig), false);
  const PoseErrorForms forms = PoseErrorOf(rig.robot, poses, by_shared);
  constexpr double kStep_m = 1e-6;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(kSharedParameterCount);
  for (int leg = 0; leg < kLegCount; ++leg)
    for (const int entry : {0, 1, 2, 3, 4, 5, leg_parameter::kJointOffset})
      change[FirstParameterOfLeg(leg) + entry] = Uniform(generator, -kStep_m, kStep_m);
  const Eigen::VectorXd of_model = by_shared * change;
  const auto moved = [&](double sign, const Rigid3& pose) {
    GoughStewart robot = rig.robot;
    for (int leg = 0; leg < kLegCount; ++leg) {
      const auto of_leg =
          of_model.segment<kModelLegParameters>(kCameraParameterCount + leg * kModelLegParameters);
      robot.legs[static_cast<size_t>(leg)].base_joint_m += sign * of_leg.head<3>();
      robot.legs[static_cast<size_t>(leg)].platform_joint_m += sign * of_leg.segment<3>(3);
      robot.legs[static_cast<size_t>(leg)].joint_offset_m += sign * of_leg[7];
    }
    return ForwardKinematics(robot, InverseKinematics(rig.robot, pose), pose).base_from_platform;
  };
  double position_m2 = 0, rotation_rad2 = 0;
  for (const Rigid3& pose : poses) {
    const Vector6d twice = Displacement(moved(-1, pose), moved(1, pose));
    position_m2 += twice.head<3>().squaredNorm() / 4 / 5;
    rotation_rad2 += twice.tail<3>().squaredNorm() / 4 / 5;
  }
  EXPECT_NEAR(change.dot(forms.position * change), position_m2, 1e-6 * position_m2);
  EXPECT_NEAR(change.dot(forms.rotation * change), rotation_rad2, 1e-6 * rotation_rad2);
}

TEST(PoseError, IsNoneWhereTheBaseMovesAsAWhole) {
  const RigModel rig = DesktopRig();
  const PoseErrorForms forms =
      PoseErrorOf(rig.robot, DrawReachablePoses(rig.robot, 5, 7, {}),
                  ModelBySharedParameters(BaseJoints(rig), DrawnBaseJoints(rig), false));
  Eigen::VectorXd change = Eigen::VectorXd::Zero(kSharedParameterCount);
  const Eigen::Vector3d shift(0.3, -0.2, 0.1), turn(0.5, 0.4, -0.3);
  for (int leg = 0; leg < kLegCount; ++leg)
    change.segment<3>(FirstParameterOfLeg(leg)) =
        shift + turn.cross(BaseJoints(rig)[static_cast<size_t>(leg)]);
  EXPECT_NEAR(change.dot(forms.position * change), 0, 1e-15);
  change.segment<3>(FirstParameterOfLeg(2)).x() += 1e-3;
  EXPECT_GT(change.dot(forms.position * change), 1e-9);
}

// ---- What is expected, against a calibration

// Mean squared position and rotation error by the covariance that a calibration states.
std::pair<double, double> PoseSigmas(const LegCalibration& calibration, const std::vector<Rigid3>& poses) {
  const ModelCovariance model = CovarianceOfModel(calibration);
  std::vector<Eigen::Index> rows;
  rows.reserve(kGeometryCount);
  for (const std::string& name : GeometryNames())
    rows.push_back(std::find(model.names.begin(), model.names.end(), name) - model.names.begin());
  const Eigen::MatrixXd covariance = model.covariance(rows, rows);
  double position = 0, rotation = 0;
  for (const Rigid3& pose : poses) {
    const Eigen::MatrixXd by_geometry =
        InverseJacobian(calibration.robot, pose).inverse() * ReadingsByGeometry(calibration.robot, pose);
    const Matrix6d of_pose = by_geometry * covariance * by_geometry.transpose();
    position += of_pose.diagonal().head<3>().sum() / static_cast<double>(poses.size());
    rotation += of_pose.diagonal().tail<3>().sum() / static_cast<double>(poses.size());
  }
  return {std::sqrt(position), std::sqrt(rotation)};
}

TEST(ExpectedSigma, IsWhatACalibrationOfTheSessionStates) {
  SyntheticOptions drawn;
  drawn.image_count = 14;
  drawn.samples_per_edge = 6;
  drawn.camera = DesktopCamera(true);
  drawn.edge_sigma_px = 0.03;
  drawn.common_edge_sigma_px = drawn.lasting_shading_px = 0.02;
  const SyntheticSession session = GenerateSession(drawn);
  LegCalibrationInput input{session.nominal_robot,
                            session.nominal_camera,
                            session.nominal_camera_from_base,
                            session.observations,
                            {},
                            std::nullopt};
  input.known.joint_reading_m = 2e-5;
  input.known.radius_m = 5e-4;
  const LegCalibration calibration = CalibrateLegs(input, {});
  ASSERT_EQ(calibration.status, CalibrationStatus::kConverged) << calibration.message;

  input.start = {calibration.camera, calibration.robot, calibration.camera_from_base,
                 calibration.camera_from_platform};
  PoseProposalOptions options = Few(1);
  options.cared_for = DrawReachablePoses(session.nominal_robot, 20, 3, {});
  options.noise = calibration.noise;
  const ExpectedSigma expected = PoseProposer(input, {}, options).Expected();
  const auto [position_m, rotation_rad] = PoseSigmas(calibration, options.cared_for);
  const auto near = [](const std::optional<double>& found, double stated) {
    EXPECT_NEAR(found.value(), stated, 0.03 * stated);
  };
  near(expected.position_m, position_m);
  near(expected.rotation_rad, rotation_rad);
  const CameraParameters camera = SigmaOfCamera(calibration);
  near(expected.focal_length_px, camera.head<2>().norm() / std::sqrt(2));
  near(expected.principal_point_px, camera.segment<2>(2).norm() / std::sqrt(2));
  const ModelCovariance model = CovarianceOfModel(calibration);
  double a = 0, b = 0, r = 0, o = 0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const LegSigma sigma = SigmaOfLeg(calibration, model, leg);
    a += sigma.base_joint_m.squaredNorm();
    b += sigma.platform_joint_m.squaredNorm();
    r += std::pow(sigma.radius_m, 2);
    o += std::pow(sigma.joint_offset_m, 2);
  }
  near(expected.base_joint_m, std::sqrt(a / 18));
  near(expected.platform_joint_m, std::sqrt(b / 18));
  near(expected.radius_m, std::sqrt(r / 6));
  near(expected.joint_offset_m, std::sqrt(o / 6));
}

// ---- Proposals

TEST(PoseProposer, LeavesOpenWhatNoImageTells) {
  const PoseProposer proposer(InputOf(DesktopRig()), {}, Few(5));
  const ExpectedSigma nothing = proposer.Expected();
  EXPECT_FALSE(nothing.position_m || nothing.rotation_rad || nothing.focal_length_px || nothing.base_joint_m);
  EXPECT_FALSE(proposer.Next().value().expected.position_m);
}

TEST(PoseProposer, ForetellsTheSigmaAfterTheProposedPoseAndNeverProposesOneTwice) {
  const RigModel rig = DesktopRig();
  PoseProposer proposer(InputOf(rig), {}, Few(12));
  std::vector<Rigid3> proposed;
  double before_m = INFINITY;
  while (const auto proposal = proposer.Next()) {
    for (const Rigid3& earlier : proposed)
      EXPECT_GT((proposal->base_from_platform.translation - earlier.translation).norm(), 1e-3);
    proposed.push_back(proposal->base_from_platform);
    const ImageObservation seen = ExpectObservation(rig, proposal->base_from_platform, {});
    EXPECT_EQ(seen.edges.size(), static_cast<size_t>(proposal->edges));
    EXPECT_TRUE(AreNear(*seen.joint_readings_m, proposal->joint_readings_m, 1e-12));
    proposer.Add(seen);
    const double after_m = proposer.Expected().position_m.value_or(INFINITY);
    if (const auto foretold_m = proposal->expected.position_m) {
      EXPECT_NEAR(after_m, *foretold_m, 1e-6 * after_m);
    }
    EXPECT_LE(after_m, before_m);
    before_m = after_m;
  }
  EXPECT_EQ(proposed.size(), 12);
  EXPECT_LT(before_m, 1e-3);
}

TEST(PoseProposer, ResumesWithTheImagesThatThereAre) {
  std::mt19937_64 generator = TestGenerator();
  const RandomRig rig = DrawRig(generator);
  PoseProposer proposer(InputOf(rig.guess), {}, Few(30));
  std::vector<ImageObservation> images;
  images.reserve(4);
  for (int i = 0; i < 4; ++i) {
    images.push_back(SeenIn(rig, proposer.Next().value().base_from_platform, {}));
    proposer.Add(images.back());
  }
  const PoseProposer resumed(InputOf(rig.guess, images), {}, Few(30));
  EXPECT_EQ(resumed.Next()->base_from_platform.translation, proposer.Next()->base_from_platform.translation);
  EXPECT_EQ(resumed.Expected().position_m, proposer.Expected().position_m);
}

TEST(PoseProposer, DoesNotProposeWhatWasRejected) {
  PoseProposer proposer(InputOf(DesktopRig()), {}, Few(3));
  for (int i = 0; i < 3; ++i) proposer.Reject(proposer.Next().value().base_from_platform);
  EXPECT_FALSE(proposer.Next());
}

TEST(PoseProposer, CountsAPoseWithoutEdgesAsTaken) {
  PoseProposer proposer(InputOf(DesktopRig()), {}, Few(3));
  const Rigid3 first = proposer.Next()->base_from_platform;
  proposer.Add({"dark", InverseKinematics(DesktopHexapod(), first), {}});
  EXPECT_NE(proposer.Next()->base_from_platform.translation, first.translation);
}

TEST(PoseProposer, IsAsItWasAfterAnImageThatTheModelCannotProduce) {
  const RigModel rig = DesktopRig();
  PoseProposer proposer(InputOf(rig), {}, Few(4));
  const Rigid3 first = proposer.Next()->base_from_platform;
  ImageObservation image = ExpectObservation(rig, first, {});
  image.edges[0].samples[0].point_px = {1e7, -1e7};
  EXPECT_THROW(proposer.Add(image), std::runtime_error);
  EXPECT_EQ(proposer.Next()->base_from_platform.translation, first.translation);
}

TEST(PoseProposer, NeedsReadingsThatLeadToAPose) {
  PoseProposer proposer(InputOf(DesktopRig()), {}, Few(1));
  EXPECT_THROW(proposer.Add({"none", std::nullopt, {}}), std::invalid_argument);
  EXPECT_THROW(proposer.Add({"far", Vector6d::Constant(5), {}}), std::invalid_argument);
  LegCalibrationOptions edges_only;
  edges_only.use_joint_readings = false;
  EXPECT_THROW(PoseProposer(InputOf(DesktopRig()), edges_only, Few(1)), std::invalid_argument);
}

}  // namespace
}  // namespace legible
