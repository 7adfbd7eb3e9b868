#include "calib/held_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/synthetic_session.h"

namespace legible {
namespace {

LegCalibrationInput InputOf(const SyntheticSession& session, const Camera& camera) {
  LegCalibrationInput input{session.nominal_robot, camera, session.nominal_camera_from_base,
                            session.observations,  {},     {}};
  input.known.joint_reading_m = 2e-5;
  return input;
}

SyntheticSession TwelveImages() {
  SyntheticOptions options;
  options.image_count = 12;
  return GenerateSession(options);
}

std::vector<HeldDifference> DifferencesFor(const LegCalibrationInput& input) {
  LegCalibrationOptions options;
  options.hold.principal_point = true;
  const LegCalibration held = CalibrateLegs(input, options);
  EXPECT_EQ(held.status, CalibrationStatus::kConverged) << held.message;
  return DifferencesOfHeld(input, held, options, 4);
}

TEST(DifferencesOfHeld, NameAWrongPrincipalPointAndByHowMuch) {
  const SyntheticSession session = TwelveImages();
  Camera wrong = session.true_camera;
  wrong.cx_px += 60;
  const LegCalibrationInput input = InputOf(session, wrong);
  const auto differences = DifferencesFor(input);
  ASSERT_FALSE(differences.empty());
  EXPECT_EQ(differences[0].parameter, "camera.cx_px");
  const LegCalibration free = CalibrateLegs(input, {});
  EXPECT_NEAR(differences[0].sigmas,
              (wrong.cx_px - free.camera.cx_px) / std::sqrt(free.observability.covariance(2, 2)),
              0.02 * std::abs(differences[0].sigmas));
}

TEST(DifferencesOfHeld, AreNoneWhereWhatIsHeldIsRight) {
  const SyntheticSession session = TwelveImages();
  EXPECT_TRUE(DifferencesFor(InputOf(session, session.true_camera)).empty());
}

}  // namespace
}  // namespace legible
