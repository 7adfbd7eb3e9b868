#include <gtest/gtest.h>

#include "calib/session_calibration.h"
#include "datasets/session_file.h"
#include "tests/testing/fresh_poses.h"
#include "tests/testing/random.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

// Sixteen ray-traced images, nothing known but the drawing and a guess of the camera.
TEST(ShippedSession, CalibratedModelPredictsFreshPosesSeveralTimesBetterThanTheDrawing) {
  const std::string folder = LEGIBLE_SOURCE_DIR "/datasets/hexapod";
  const Session session = ReadSession(folder);
  const RenderedTruth truth = ReadRenderedTruth(folder + "/truth.json");
  const SessionCalibration found = CalibrateSession(session, {});
  ASSERT_EQ(found.calibration.status, CalibrationStatus::kConverged) << found.calibration.message;
  std::mt19937_64 generator = TestGenerator();
  const PoseError drawn = ErrorInFreshPoses(truth.robot, session.robot, session.robot, {}, generator);
  const PoseError calibrated = ErrorInFreshPoses(truth.robot, LaidOnto(truth.robot, found.calibration.robot),
                                                 session.robot, {}, generator);
  EXPECT_LT(calibrated.position_m, drawn.position_m / 4);
  EXPECT_LT(calibrated.rotation_rad, drawn.rotation_rad / 15);
  ASSERT_TRUE(found.held_out_rms_px);
  EXPECT_LT(*found.held_out_rms_px, 0.1);
}

}  // namespace
}  // namespace legible
