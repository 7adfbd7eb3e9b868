#include "calib/leg_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "calib/board/board_calibration.h"
#include "calib/calibrated_model.h"
#include "tests/calib/synthetic_tags.h"
#include "tests/calib/truth_problem.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

LegCalibrationInput InputOf(const SyntheticSession& session,
                            const std::vector<ImageObservation>& observations) {
  LegCalibrationInput input{
      session.nominal_robot, session.nominal_camera, session.nominal_camera_from_base, observations, {}, {}};
  input.known.joint_reading_m = 2e-5;
  return input;
}

SyntheticOptions FewImages() {
  SyntheticOptions options;
  options.image_count = 12;
  return options;
}

LegCalibrationOptions OneThread() {
  LegCalibrationOptions options;
  options.threads = 1;
  return options;
}

SharedParameters FoundParameters(const LegCalibration& found) {
  SharedParameters shared;
  shared.camera = ParametersOf(found.camera);
  for (size_t i = 0; i < kLegCount; ++i)
    shared.legs[i] << found.base_joints_in_camera_m[i], found.robot.legs[i].platform_joint_m,
        found.robot.legs[i].radius_m, found.robot.legs[i].joint_offset_m, found.shading_px[i];
  return shared;
}

// Differences by part, relative to the size of each.
void ExpectNearTruth(const SharedParameters& found, const SharedParameters& truth, double relative) {
  EXPECT_TRUE(
      AreNear(found.camera.head<4>() / truth.camera[0], truth.camera.head<4>() / truth.camera[0], relative));
  EXPECT_TRUE(AreNear(found.camera.tail<8>(), truth.camera.tail<8>(), 10 * relative));
  for (size_t i = 0; i < kLegCount; ++i) {
    const LegParameters &leg = found.legs[i], &expected = truth.legs[i];
    EXPECT_TRUE(AreNear(leg.head<3>() / expected.head<3>().norm(),
                        expected.head<3>() / expected.head<3>().norm(), relative));
    EXPECT_TRUE(AreNear(leg.segment<3>(3) / expected.segment<3>(3).norm(),
                        expected.segment<3>(3) / expected.segment<3>(3).norm(), relative));
    EXPECT_NEAR(leg[leg_parameter::kRadius] / expected[leg_parameter::kRadius], 1, relative);
    EXPECT_NEAR(leg[leg_parameter::kJointOffset], expected[leg_parameter::kJointOffset], 0.4 * relative);
  }
}

TEST(LegCalibration, FindsTheTruthOfExactObservations) {
  for (const bool is_distorted : {false, true}) {
    SyntheticOptions options = FewImages();
    options.camera = DesktopCamera(is_distorted);
    const SyntheticSession session = GenerateSession(options);
    const LegCalibration found = CalibrateLegs(InputOf(session, session.exact_observations), {});
    EXPECT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
    EXPECT_LT(found.rms_px, 1e-6);
    ExpectNearTruth(FoundParameters(found), TrueParameters(session), 1e-6);
  }
}

// From a guess of 8 px and no coefficients, of a camera as near as its view is wide.
SyntheticOptions FewImagesThroughAFisheye() {
  SyntheticOptions options = FewImages();
  options.camera = DesktopFisheye();
  options.camera_from_base = LookAt({0.52, 0.074, 0.3}, {0, 0, 0.13});
  return options;
}

TEST(LegCalibration, FindsTheTruthOfExactObservationsThroughAFisheye) {
  const SyntheticSession session = GenerateSession(FewImagesThroughAFisheye());
  const LegCalibration found = CalibrateLegs(InputOf(session, session.exact_observations), {});
  EXPECT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  EXPECT_EQ(found.camera.lens, LensModel::kFisheye);
  EXPECT_LT(found.rms_px, 1e-6);
  ExpectNearTruth(FoundParameters(found), TrueParameters(session), 1e-6);
}

TEST(LegCalibration, FindsTheSameTwiceOnOneThread) {
  const SyntheticSession session = GenerateSession(FewImages());
  const LegCalibrationInput input = InputOf(session, session.observations);
  const LegCalibration first = CalibrateLegs(input, OneThread()), second = CalibrateLegs(input, OneThread());
  EXPECT_EQ(first.iterations, second.iterations);
  EXPECT_TRUE(AreNear(ParametersOf(first.camera), ParametersOf(second.camera), 0));
  for (size_t i = 0; i < kLegCount; ++i)
    EXPECT_TRUE(AreNear(FoundParameters(first).legs[i], FoundParameters(second).legs[i], 0));
  EXPECT_TRUE(AreNear(first.observability.covariance, second.observability.covariance, 0));
}

TEST(LegCalibration, FindsTheSameOnTwoThreadsUpToASmallShareOfSigma) {
  const SyntheticSession session = GenerateSession(FewImages());
  const LegCalibrationInput input = InputOf(session, session.observations);
  const SharedParameters one = FoundParameters(CalibrateLegs(input, OneThread()));
  const LegCalibration two = CalibrateLegs(input, {});
  const SharedParameters of_two = FoundParameters(two);
  for (int i = 0; i < kSharedParameterCount; ++i)
    EXPECT_NEAR(Parameter(of_two, i), Parameter(one, i), 1e-3 * std::sqrt(two.observability.covariance(i, i)))
        << ParameterName(two.camera.lens, i);
}

TEST(LegCalibration, BaseFrameIsTheRigidFitOfTheBaseJointsToTheDrawing) {
  const SyntheticSession session = GenerateSession(FewImages());
  const LegCalibration found = CalibrateLegs(InputOf(session, session.observations), {});
  std::vector<Eigen::Vector3d> drawn, in_camera;
  for (size_t i = 0; i < kLegCount; ++i) {
    drawn.push_back(session.nominal_robot.legs[i].base_joint_m);
    in_camera.push_back(found.base_joints_in_camera_m[i]);
    EXPECT_TRUE(AreNear(found.camera_from_base * found.robot.legs[i].base_joint_m, in_camera.back(), 1e-12));
  }
  EXPECT_TRUE(
      AreNear(Displacement(FitRigid(drawn, in_camera), found.camera_from_base), Vector6d::Zero(), 1e-12));
}

TEST(LegCalibration, PlatformFrameIsTheRigidFitOfThePlatformJointsToTheDrawing) {
  const SyntheticSession session = GenerateSession(FewImages());
  const LegCalibration found = CalibrateLegs(InputOf(session, session.observations), {});
  std::vector<Eigen::Vector3d> drawn, in_platform;
  for (size_t i = 0; i < kLegCount; ++i) {
    drawn.push_back(session.nominal_robot.legs[i].platform_joint_m);
    in_platform.push_back(found.robot.legs[i].platform_joint_m);
  }
  EXPECT_TRUE(AreNear(Displacement({}, FitRigid(in_platform, drawn)), Vector6d::Zero(), 1e-9));
}

TEST(LegCalibration, NoiseIsEstimatedFromTheResiduals) {
  SyntheticOptions options = FewImages();
  const SyntheticSession session = GenerateSession(options);
  LegCalibrationInput input = InputOf(session, session.observations);
  for (ImageObservation& image : input.images)
    for (EdgeObservation& edge : image.edges)
      for (EdgeSample& sample : edge.samples) sample.sigma_px = 1;
  const LegCalibration found = CalibrateLegs(input, {});
  EXPECT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  EXPECT_NEAR(found.edge_sigma_px, options.edge_sigma_px, 0.05 * options.edge_sigma_px);
}

TEST(LegCalibration, KeepsWhatIsHeld) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  input.camera = session.true_camera;
  LegCalibrationOptions options;
  options.hold.focal_length = options.hold.principal_point = options.hold.distortion = true;
  options.hold.platform_joints = options.hold.radii = true;
  const LegCalibration found = CalibrateLegs(input, options);
  EXPECT_TRUE(AreNear(ParametersOf(found.camera), ParametersOf(input.camera), 0));
  for (size_t i = 0; i < kLegCount; ++i) {
    EXPECT_EQ(found.robot.legs[i].radius_m, input.drawing.legs[i].radius_m);
    EXPECT_TRUE(AreNear(found.robot.legs[i].platform_joint_m, input.drawing.legs[i].platform_joint_m, 0));
  }
}

TEST(LegCalibration, IgnoresImagesWithoutEdges) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  const LegCalibration without = CalibrateLegs(input, OneThread());
  input.images.push_back({"empty", input.images[0].joint_readings_m, {}});
  const LegCalibration with = CalibrateLegs(input, OneThread());
  EXPECT_TRUE(AreNear(ParametersOf(with.camera), ParametersOf(without.camera), 0));
  EXPECT_EQ(with.camera_from_platform.size(), input.images.size());
}

TEST(LegCalibration, SaysSoWhereLegsAreFree) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationOptions options;
  options.use_joint_readings = options.rigid_platform = false;
  const LegCalibration found = CalibrateLegs(InputOf(session, session.observations), options);
  EXPECT_EQ(found.status, CalibrationStatus::kUnobservable);
  ASSERT_GE(found.observability.unobservable.size(), 6);
  for (size_t leg = 0; leg < kLegCount; ++leg)
    EXPECT_NE(
        found.observability.unobservable[leg].description.find("the scale of leg " + std::to_string(leg + 1)),
        std::string::npos);
  EXPECT_NE(found.message.find("give joint readings, a radius, or a tag"), std::string::npos)
      << found.message;
}

TEST(LegCalibration, SaysSoWhereObservationsAreTooFew) {
  SyntheticOptions options;
  options.image_count = 1;
  options.samples_per_edge = 2;
  const SyntheticSession session = GenerateSession(options);
  const LegCalibration found = CalibrateLegs(InputOf(session, session.observations), {});
  EXPECT_EQ(found.status, CalibrationStatus::kTooFewObservations);
  EXPECT_FALSE(found.message.empty());
  EXPECT_EQ(CalibrateLegs(InputOf(session, {}), {}).status, CalibrationStatus::kTooFewObservations);
}

TEST(LegCalibration, OneImageLeavesTheRobotOpen) {
  SyntheticOptions options;
  options.image_count = 1;
  const SyntheticSession session = GenerateSession(options);
  const LegCalibration found = CalibrateLegs(InputOf(session, session.observations), {});
  EXPECT_EQ(found.status, CalibrationStatus::kUnobservable) << ToString(found.status);
}

TEST(LegCalibration, RejectsMalformedInput) {
  const SyntheticSession session = GenerateSession(FewImages());
  const LegCalibrationInput good = InputOf(session, session.observations);
  LegCalibrationInput bad = good;
  bad.images[0].edges[0].leg = kLegCount;
  EXPECT_THROW(CalibrateLegs(bad, {}), std::invalid_argument);
  bad = good;
  bad.images[0].edges[0].edge = 2;
  EXPECT_THROW(CalibrateLegs(bad, {}), std::invalid_argument);
  bad = good;
  bad.start = CalibrationStart{good.camera, good.drawing, good.camera_from_base, {}};
  EXPECT_THROW(CalibrateLegs(bad, {}), std::invalid_argument);
  LegCalibrationOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(CalibrateLegs(good, options), std::invalid_argument);
  options = {};
  options.threads = 0;
  EXPECT_THROW(CalibrateLegs(good, options), std::invalid_argument);
  options = {};
  options.default_joint_reading_sigma_m = 0;
  EXPECT_THROW(CalibrateLegs(good, options), std::invalid_argument);
}

TEST(LegCalibration, RejectsSamplesWithoutAFiniteSigma) {
  const SyntheticSession session = GenerateSession(FewImages());
  for (const double sigma_px : {0.0, -1.0, std::nan("")}) {
    LegCalibrationInput bad = InputOf(session, session.observations);
    bad.images[0].edges[0].samples[0].sigma_px = sigma_px;
    EXPECT_THROW(CalibrateLegs(bad, {}), std::invalid_argument) << sigma_px;
  }
}

TEST(LegCalibration, HeldBaseJointsKeepTheirShapeWhileTheBaseIsPlaced) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.exact_observations);
  for (size_t i = 0; i < kLegCount; ++i)
    input.drawing.legs[i].base_joint_m = session.true_robot.legs[i].base_joint_m;
  LegCalibrationOptions options;
  options.hold.base_joints = true;
  const LegCalibration found = CalibrateLegs(input, options);
  ASSERT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  for (size_t i = 0; i < kLegCount; ++i)
    EXPECT_TRUE(AreNear(found.robot.legs[i].base_joint_m, input.drawing.legs[i].base_joint_m, 2e-6));
  const ModelCovariance covariance = CovarianceOfModel(found);
  for (int leg = 0; leg < kLegCount; ++leg) {
    EXPECT_EQ(SigmaOfLeg(found, covariance, leg).base_joint_m, Eigen::Vector3d::Zero());
    EXPECT_GT(SigmaOfLeg(found, covariance, leg).base_joint_in_camera_m.minCoeff(), 0);
  }
  EXPECT_TRUE(AreNear(found.camera_from_base.translation, session.true_camera_from_base.translation, 1e-4));
  EXPECT_FALSE(AreNear(input.camera_from_base.translation, session.true_camera_from_base.translation, 1e-4));
}

TEST(LegCalibration, WrongJointReadingsAreNamedAndDoNotCount) {
  SyntheticOptions few = FewImages();
  few.image_count = 16;
  const SyntheticSession session = GenerateSession(few);
  const LegCalibration clean = CalibrateLegs(InputOf(session, session.observations), {});
  ASSERT_EQ(clean.status, CalibrationStatus::kConverged);
  EXPECT_TRUE(clean.outlying_readings.empty());
  auto observations = session.observations;
  (*observations[4].joint_readings_m)[2] += 1e-3;
  (*observations[9].joint_readings_m)[0] -= 1e-2;
  const LegCalibration found = CalibrateLegs(InputOf(session, observations), {});
  ASSERT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  ASSERT_EQ(found.outlying_readings.size(), 2);
  const OutlyingReading &a = found.outlying_readings[0], &b = found.outlying_readings[1];
  EXPECT_EQ(std::tuple(a.image, a.leg), std::tuple(4, 2));
  EXPECT_EQ(std::tuple(b.image, b.leg), std::tuple(9, 0));
  EXPECT_NEAR(a.off_m, 1e-3, 2e-4);
  EXPECT_NEAR(b.off_m, -1e-2, 2e-4);
  EXPECT_NEAR(found.edge_sigma_px, clean.edge_sigma_px, 0.01 * clean.edge_sigma_px);
  const ModelCovariance covariance = CovarianceOfModel(found);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Leg &estimate = found.robot.legs[static_cast<size_t>(leg)],
              &truth = session.true_robot.legs[static_cast<size_t>(leg)];
    const LegSigma sigma = SigmaOfLeg(found, covariance, leg);
    EXPECT_NEAR(estimate.joint_offset_m, truth.joint_offset_m, 4 * sigma.joint_offset_m);
    EXPECT_NEAR(estimate.radius_m, truth.radius_m, 4 * sigma.radius_m);
  }
}

// Where weak edges leave the pose to the tags, readings are judged by both.
TEST(LegCalibration, TagsPredictTheReadingsTooAndLeaveRightOnesAlone) {
  SyntheticOptions weak_edges = FewImages();
  weak_edges.edge_sigma_px = 1.5;
  const SyntheticSession session = GenerateSession(weak_edges);
  LegCalibrationInput input = InputOf(session, session.observations);
  input.tags = DrawTags(session, {.corner_sigma_px = 0.02});
  const LegCalibration found = CalibrateLegs(input, {});
  ASSERT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  EXPECT_TRUE(found.outlying_readings.empty());
  EXPECT_TRUE(found.weights_steady);
}

// Without readings and radii nothing but the tags says how large the robot is.
TEST(LegCalibration, TagsSetTheScaleThatEdgesLeaveOpen) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.exact_observations);
  LegCalibrationOptions options;
  options.use_joint_readings = false;
  EXPECT_EQ(CalibrateLegs(input, options).status, CalibrationStatus::kUnobservable);
  input.tags = DrawTags(session, {.corner_sigma_px = 0});
  const LegCalibration found = CalibrateLegs(input, options);
  ASSERT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  for (size_t i = 0; i < kLegCount; ++i)
    EXPECT_NEAR(found.robot.legs[i].radius_m, session.true_robot.legs[i].radius_m, 1e-7);
}

TEST(LegCalibration, TagsMakeTheRestMoreCertain) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  const LegCalibration without = CalibrateLegs(input, {});
  input.tags = DrawTags(session, {});
  const LegCalibration with = CalibrateLegs(input, {});
  ASSERT_EQ(with.status, CalibrationStatus::kConverged) << with.message;
  EXPECT_LT(with.observability.covariance(0, 0), 0.5 * without.observability.covariance(0, 0));
  ASSERT_EQ(with.tags.size(), 2U);
  EXPECT_EQ(with.tags[0].tags, 3);
  EXPECT_EQ(with.tags[1].tags, 12);
  EXPECT_LT(with.tags[1].placement_sigmas, 3);
  EXPECT_NEAR(with.tag_sigma_px, 0.05, 0.01);
}

TEST(LegCalibration, MisreadTagsAreLeftOutAndCounted) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  input.tags = DrawTags(session, {.misread_fraction = 0.25});
  const LegCalibration found = CalibrateLegs(input, {});
  ASSERT_EQ(found.status, CalibrationStatus::kConverged) << found.message;
  EXPECT_GT(found.tags[1].tags_left_out, 0);
  EXPECT_LT(found.tags[1].tags_left_out, 7);
  // What is misread takes nothing from the edges' freedom.
  input.tags = DrawTags(session, {});
  EXPECT_NEAR(found.noise.sample, CalibrateLegs(input, {}).noise.sample, 0.0015);
}

TEST(LegCalibration, RejectsTagsThatDoNotFitTheRest) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  input.tags = DrawTags(session, {});
  LegCalibrationOptions free_legs;
  free_legs.rigid_platform = false;
  EXPECT_THROW(CalibrateLegs(input, free_legs), std::invalid_argument);
  input.tags[0].detections.pop_back();
  EXPECT_THROW(CalibrateLegs(input, {}), std::invalid_argument);
}

TEST(ToModel, ListsTheCovarianceOfWhatWasEstimatedOnly) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationOptions options;
  options.hold.radii = true;
  const CalibratedModel model = ToModel(CalibrateLegs(InputOf(session, session.observations), options));
  for (const std::string& name : model.parameter_names)
    EXPECT_EQ(name.find("radius"), std::string::npos) << name;
  EXPECT_EQ(model.parameter_names.back(), "camera_from_base.rotation_rad.z");
  ASSERT_EQ(model.covariance.rows(), static_cast<Eigen::Index>(model.parameter_names.size()));
  EXPECT_GT(model.covariance.diagonal().minCoeff(), 0);
}

// --- A board seen by the same camera. --------------------------------------------------------------------

// What a board tells enters as its information or is solved together with the legs: where the board tells
// much and the legs are as linear as here, that is the same.
TEST(CalibrateLegs, TakesABoardAsItsInformationOrSolvesItTogether) {
  const SyntheticSession session = GenerateSession(FewImages());
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  const BoardCalibrationInput seen = {
      points, SeeBoard(generator, session.true_camera, points, {.views = 20, .noise_px = 0.05}).views,
      session.true_camera.width_px, session.true_camera.height_px};
  const BoardCalibrationOptions options{.lens = session.true_camera.lens};
  const BoardCalibration board = CalibrateCamera(seen, options);
  ASSERT_EQ(board.status, BoardCalibrationStatus::kConverged) << board.message;

  LegCalibrationInput input = InputOf(session, session.observations);
  const LegCalibration alone = CalibrateLegs(input, {});
  input.camera = board.camera;
  input.known.camera_information = board.information.information;
  const LegCalibration informed = CalibrateLegs(input, {});
  input.known.camera_information.resize(0, 0);
  input.board = SolvedProblem(seen, board, options);
  const LegCalibration together = CalibrateLegs(input, {});
  for (const LegCalibration* found : {&alone, &informed, &together})
    ASSERT_EQ(found->status, CalibrationStatus::kConverged) << found->message;
  const CameraParameters sigma = SigmaOfCamera(informed);
  for (int i = 0; i < 4 + static_cast<int>(session.true_camera.lens); ++i) {
    EXPECT_LT(sigma[i], 0.5 * SigmaOfCamera(alone)[i]) << i;
    EXPECT_NEAR(SigmaOfCamera(together)[i] / sigma[i], 1, 0.01) << i;
    EXPECT_NEAR(ParametersOf(together.camera)[i], ParametersOf(informed.camera)[i], 0.1 * sigma[i]) << i;
    EXPECT_NEAR(ParametersOf(informed.camera)[i], ParametersOf(session.true_camera)[i], 4 * sigma[i]) << i;
  }
}

TEST(CalibrateLegs, RefusesABoardSeenThroughAnotherLensModel) {
  const SyntheticSession session = GenerateSession(FewImages());
  LegCalibrationInput input = InputOf(session, session.observations);
  input.board = BoardProblem{BoardCamera(LensModel::kFisheye), {}, {}, false};
  EXPECT_THROW(CalibrateLegs(input, {}), std::invalid_argument);
}

}  // namespace
}  // namespace legible
