#include "calib/observability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "calib/shared_information.h"
#include "tests/calib/truth_problem.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string Descriptions(const std::vector<WeakDirection>& directions) {
  std::string text;
  for (const WeakDirection& direction : directions)
    text += direction.description + ": " + std::to_string(direction.relative_sigma) + "\n";
  return text;
}

SyntheticSession TenImages() {
  SyntheticOptions options;
  options.image_count = 10;
  return GenerateSession(options);
}

TEST(Observability, EverythingIsObservableWithRigidPlatformAndReadings) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {});
  const Observability found = AnalyseObservability(problem);
  EXPECT_TRUE(found.unobservable.empty()) << Descriptions(found.unobservable);
  EXPECT_EQ(found.weak.size(), 3);
  EXPECT_TRUE(std::all_of(found.known.begin(), found.known.end(), [](bool known) { return known; }));
}

TEST(Observability, CovarianceInvertsTheInformationInTheGauge) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {});
  const Eigen::MatrixXd covariance = AnalyseObservability(problem).covariance;
  const Eigen::MatrixXd information = SharedInformation(problem);
  const std::vector<int> free = FreeIndices(problem);
  const Eigen::VectorXd sigma = covariance.diagonal()(free).cwiseSqrt();
  const Eigen::MatrixXd c =
      sigma.cwiseInverse().asDiagonal() * covariance(free, free) * sigma.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd m = sigma.asDiagonal() * information(free, free) * sigma.asDiagonal();
  // C M C = C, and C says nothing of the gauge's six freedoms.
  EXPECT_TRUE(AreNear(c * m * c, c, 1e-5));
  Eigen::MatrixXd gauge = Eigen::MatrixXd::Zero(6, kSharedParameterCount);
  for (int leg = 0; leg < kLegCount; ++leg)
    gauge.middleCols<3>(FirstParameterOfLeg(leg) + leg_parameter::kPlatformJoint) =
        PlatformGauge(problem.drawn_platform_joints).middleCols<3>(3 * leg);
  EXPECT_TRUE(AreNear(gauge * covariance, Eigen::MatrixXd::Zero(6, kSharedParameterCount), 1e-12));
}

// Edges a twentieth as noisy as the session's: then the focal length is known to 9 %, which is no freedom but
// next to the others too little for a number.
TEST(Observability, NamesTheSixScalesOfFreeLegsAndNothingElse) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem = ProblemAtTruth(session, session.exact_observations,
                                                   {.rigid_platform = false, .noise = {.sample = 0.05}});
  const Observability found = AnalyseObservability(problem);
  ASSERT_EQ(found.unobservable.size(), 6) << Descriptions(found.unobservable);
  for (int leg = 1; leg <= kLegCount; ++leg)
    EXPECT_NE(found.unobservable[static_cast<size_t>(leg - 1)].description.find(
                  "the scale of leg " + std::to_string(leg) + " is free"),
              std::string::npos);
  EXPECT_LT(found.weak[0].relative_sigma, 0.1);
  EXPECT_FALSE(found.known[0]);
  for (int leg = 0; leg < kLegCount; ++leg) {
    EXPECT_FALSE(found.known[static_cast<size_t>(FirstParameterOfLeg(leg) + leg_parameter::kRadius)]);
    EXPECT_FALSE(found.known[static_cast<size_t>(FirstParameterOfLeg(leg) + leg_parameter::kBaseJoint + 2)]);
  }
}

TEST(Observability, SaysThatNoisyEdgesOfFreeLegsLeaveTheFocalLengthOpenToo) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem =
      ProblemAtTruth(session, session.exact_observations, {.rigid_platform = false});
  const Observability found = AnalyseObservability(problem);
  ASSERT_EQ(found.unobservable.size(), 7) << Descriptions(found.unobservable);
  EXPECT_NE(found.unobservable[6].description.find("camera.fx_px"), std::string::npos)
      << found.unobservable[6].description;
  EXPECT_FALSE(found.known[0]);
}

TEST(Observability, ScaleDirectionsOfFreeLegsCarryNoInformation) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem =
      ProblemAtTruth(session, session.exact_observations, {.rigid_platform = false});
  const Eigen::MatrixXd information = SharedInformation(problem);
  for (int leg = 0; leg < kLegCount; ++leg) {
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(kSharedParameterCount);
    const LegParameters& values = problem.shared.legs[static_cast<size_t>(leg)];
    scale.segment<3>(FirstParameterOfLeg(leg)) = values.segment<3>(leg_parameter::kBaseJoint);
    scale[FirstParameterOfLeg(leg) + leg_parameter::kRadius] = values[leg_parameter::kRadius];
    const double without_cancellation = information.diagonal().dot(scale.cwiseAbs2());
    EXPECT_LT(scale.dot(information * scale), 1e-12 * without_cancellation);
  }
}

TEST(Observability, NamesTheScaleOfTheWholeRobotWithoutReadings) {
  const SyntheticSession session = TenImages();
  const EstimationProblem problem =
      ProblemAtTruth(session, session.exact_observations, {.joint_readings = false});
  const Observability found = AnalyseObservability(problem);
  ASSERT_EQ(found.unobservable.size(), 1) << Descriptions(found.unobservable);
  EXPECT_NE(found.unobservable[0].description.find("the scale of the whole robot is free"),
            std::string::npos);
}

TEST(Observability, KnownRadiiTakeTheScalesAway) {
  const SyntheticSession session = TenImages();
  EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {.rigid_platform = false});
  for (int leg = 0; leg < kLegCount; ++leg)
    problem.priors.push_back({FirstParameterOfLeg(leg) + leg_parameter::kRadius, 0.01, 1e-5});
  for (const WeakDirection& direction : AnalyseObservability(problem).unobservable)
    EXPECT_EQ(direction.description.find("scale"), std::string::npos) << direction.description;
}

// Without coefficients in the denominator each of its has the same derivative as one in the numerator.
TEST(Observability, AdvisesFewerCoefficientsWhereThoseOfARationalLensAreNotToldApart) {
  SyntheticOptions options;
  options.image_count = 10;
  options.camera.lens = LensModel::kRational;
  const SyntheticSession session = GenerateSession(options);
  EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {});
  const auto descriptions = [&] { return Descriptions(AnalyseObservability(problem).unobservable); };
  EXPECT_THAT(descriptions(), AllOf(HasSubstr("camera.k1"), HasSubstr("camera.k4"),
                                    HasSubstr("say how well the distortion is known, or take a lens model "
                                              "with fewer coefficients")));
  // What a board has told leaves nothing else to be said.
  problem.camera_prior.root.setIdentity(4, kCameraParameterCount);
  EXPECT_THAT(descriptions(), AllOf(HasSubstr("camera.k1"), HasSubstr("camera.k4"),
                                    HasSubstr("calibrate the camera with a lens model of fewer"),
                                    Not(HasSubstr("say how well the distortion"))));
}

TEST(Observability, HoldingAThingRemovesItsRows) {
  const SyntheticSession session = TenImages();
  EstimationProblem problem = ProblemAtTruth(session, session.exact_observations, {});
  const double radius_sigma_m = std::sqrt(AnalyseObservability(problem).covariance(
      FirstParameterOfLeg(0) + leg_parameter::kRadius, FirstParameterOfLeg(0) + leg_parameter::kRadius));
  problem.free.reset(0);
  problem.free.reset(1);
  const Observability found = AnalyseObservability(problem);
  EXPECT_EQ(found.covariance.topRows<2>().cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(found.covariance.leftCols<2>().cwiseAbs().maxCoeff(), 0);
  EXPECT_TRUE(found.known[0] && found.known[1]);
  EXPECT_TRUE(found.unobservable.empty()) << Descriptions(found.unobservable);
  const int radius = FirstParameterOfLeg(0) + leg_parameter::kRadius;
  EXPECT_LT(std::sqrt(found.covariance(radius, radius)), radius_sigma_m);
}

TEST(Observability, WhereAllIsHeldAllIsKnown) {
  SyntheticOptions options;
  options.image_count = 2;
  const SyntheticSession session = GenerateSession(options);
  EstimationProblem problem = ProblemAtTruth(session, session.observations, {});
  problem.free.reset();
  const Observability found = AnalyseObservability(problem);
  EXPECT_TRUE(found.unobservable.empty());
  EXPECT_EQ(found.covariance.norm(), 0);
  EXPECT_EQ(std::count(found.known.begin(), found.known.end(), true), kSharedParameterCount);
}

}  // namespace
}  // namespace legible
