// What a board is worth for the calibration of the legs, on ray-traced images of these.
#include <gtest/gtest.h>

#include <iostream>

#include "calib/calibrated_model.h"
#include "calib/session_calibration.h"
#include "core/vision/median.h"
#include "datasets/session_file.h"
#include "tests/testing/board_of_camera.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

// Each coordinate of the base joints in the camera frame: sigma, and how far off the truth in sigmas.
struct BaseJoints {
  std::vector<double> sigma_m, off_in_sigmas;
};

BaseJoints BaseJointsOf(const LegCalibration& found, const RenderedTruth& truth) {
  BaseJoints joints;
  const ModelCovariance covariance = CovarianceOfModel(found);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const LegSigma sigma = SigmaOfLeg(found, covariance, leg);
    const Eigen::Vector3d off =
        found.base_joints_in_camera_m[static_cast<size_t>(leg)] -
        truth.camera_from_base * truth.robot.legs[static_cast<size_t>(leg)].base_joint_m;
    for (int i = 0; i < 3; ++i) {
      joints.sigma_m.push_back(sigma.base_joint_in_camera_m[i]);
      joints.off_in_sigmas.push_back(off[i] / sigma.base_joint_in_camera_m[i]);
    }
  }
  return joints;
}

void Report(const std::string& what, const LegCalibration& found, const BaseJoints& joints) {
  double squares = 0, largest = 0;
  for (const double off : joints.off_in_sigmas) {
    squares += off * off / 18;
    largest = std::max(largest, std::abs(off));
  }
  std::cout << what << ": sigma of A, median " << 1e3 * MedianOf(joints.sigma_m) << " mm; off by "
            << std::sqrt(squares) << " sigma rms, " << largest << " at most; fx " << found.camera.fx_px
            << " +- " << SigmaOfCamera(found)[0] << "\n";
}

class BoardAndLegs : public testing::Test {
 protected:
  LegCalibration Calibrate(const Session& session, const SessionCalibrationOptions& options) const {
    const SessionCalibration found = CalibrateSession(session, options);
    EXPECT_EQ(found.calibration.status, CalibrationStatus::kConverged) << found.calibration.message;
    return found.calibration;
  }

  const std::string folder_ = LEGIBLE_SOURCE_DIR "/datasets/hexapod";
  const RenderedTruth truth_ = ReadRenderedTruth(folder_ + "/truth.json");
  SessionCalibrationOptions options_ = [] {
    SessionCalibrationOptions options;
    options.folds = 0;
    return options;
  }();
};

TEST_F(BoardAndLegs, ABoardDividesTheSigmaOfTheBaseJointsByThreeAndTheTruthStaysWithinTwo) {
  Session session = ReadSession(folder_);
  const BaseJoints alone = BaseJointsOf(Calibrate(session, options_), truth_);
  Report("without a board", Calibrate(session, options_), alone);

  const CameraByBoard board = CalibrateByRenderedBoard(truth_.camera, 24);
  ASSERT_EQ(board.result.status, BoardCalibrationStatus::kConverged) << board.result.message;
  session.camera = board.result.camera;
  session.known.camera_information = board.result.information.information;
  const LegCalibration informed = Calibrate(session, options_);
  const BaseJoints with = BaseJointsOf(informed, truth_);
  Report("with its information", informed, with);
  for (size_t i = 0; i < 18; ++i) {
    EXPECT_LT(with.sigma_m[i], alone.sigma_m[i] / 3) << "coordinate " << i;
    EXPECT_LT(std::abs(with.off_in_sigmas[i]), 2) << "coordinate " << i;
  }

  // Solved together the board tells what its information says, where the problem is as linear as here.
  session.known.camera_information.resize(0, 0);
  SessionCalibrationOptions together = options_;
  together.board = SolvedProblem(board.input, board.result, board.options);
  const LegCalibration joint = Calibrate(session, together);
  const BaseJoints jointly = BaseJointsOf(joint, truth_);
  Report("solved together", joint, jointly);
  for (size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(jointly.sigma_m[i] / with.sigma_m[i], 1, 0.02) << "coordinate " << i;
    EXPECT_NEAR(jointly.off_in_sigmas[i], with.off_in_sigmas[i], 0.1) << "coordinate " << i;
  }
}

}  // namespace
}  // namespace legible
