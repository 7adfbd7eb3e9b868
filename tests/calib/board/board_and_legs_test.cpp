// What a board is worth for the calibration of the legs, on ray-traced images of these.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "calib/calibrated_model.h"
#include "calib/session_calibration.h"
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

double Rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

void Report(const std::string& what, const LegCalibration& found, const BaseJoints& joints) {
  double largest = 0;
  for (const double off : joints.off_in_sigmas) largest = std::max(largest, std::abs(off));
  std::cout << what << ": sigma of A " << 1e3 * Rms(joints.sigma_m) << " mm rms; off by "
            << Rms(joints.off_in_sigmas) << " sigma rms, " << largest << " at most; fx " << found.camera.fx_px
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

TEST_F(BoardAndLegs, ABoardDividesTheSigmaOfTheBaseJointsByThreeAndTheTruthStaysWithinIt) {
  Session session = ReadSession(folder_);
  const LegCalibration without = Calibrate(session, options_);
  const BaseJoints alone = BaseJointsOf(without, truth_);
  Report("without a board", without, alone);

  const CameraByBoard board = CalibrateByRenderedBoard(truth_.camera, 24);
  ASSERT_EQ(board.result.status, BoardCalibrationStatus::kConverged) << board.result.message;
  session.camera = board.result.camera;
  session.known.camera_information = board.result.information.information;
  const LegCalibration informed = Calibrate(session, options_);
  const BaseJoints with = BaseJointsOf(informed, truth_);
  Report("with its information", informed, with);
  EXPECT_LT(Rms(with.sigma_m), Rms(alone.sigma_m) / 3);
  // Each with 95 % by itself: three of 18 outside would be one case in twenty.
  EXPECT_GE(std::count_if(with.off_in_sigmas.begin(), with.off_in_sigmas.end(),
                          [](double off) { return std::abs(off) < 2; }),
            16);

  // Solved together the board tells as much; what differs is where edges are then looked for and weighed.
  session.known.camera_information.resize(0, 0);
  SessionCalibrationOptions together = options_;
  together.board = SolvedProblem(board.input, board.result, board.options);
  const LegCalibration joint = Calibrate(session, together);
  const BaseJoints jointly = BaseJointsOf(joint, truth_);
  Report("solved together", joint, jointly);
  EXPECT_NEAR(Rms(jointly.sigma_m) / Rms(with.sigma_m), 1, 0.05);
  for (size_t i = 0; i < 18; ++i) EXPECT_NEAR(jointly.off_in_sigmas[i], with.off_in_sigmas[i], 1) << i;
}

}  // namespace
}  // namespace legible
