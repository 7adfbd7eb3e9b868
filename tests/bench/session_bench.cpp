// What calibrating a session is worth, against what the session's renderer knew: the shipped session, or the
// folders named in the environment variable LEGIBLE_SESSIONS (with truth.json in each, separated by colons).
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "calib/calibrated_model.h"
#include "calib/session_calibration.h"
#include "datasets/session_file.h"
#include "tests/bench/bench_table.h"
#include "tests/testing/board_of_camera.h"
#include "tests/testing/fresh_poses.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

std::vector<std::string> Folders() {
  const char* named = std::getenv("LEGIBLE_SESSIONS");
  if (named == nullptr) return {LEGIBLE_SOURCE_DIR "/datasets/hexapod"};
  std::vector<std::string> folders;
  std::istringstream stream(named);
  for (std::string folder; std::getline(stream, folder, ':');) folders.push_back(folder);
  return folders;
}

// Root mean square of the errors of focal lengths, principal point, radii and base joints in the camera
// frame, each in its stated sigma.
double NormalisedError(const LegCalibration& found, const RenderedTruth& truth) {
  const CameraParameters error = ParametersOf(found.camera) - ParametersOf(truth.camera);
  double squares = (error.head<4>().array() / SigmaOfCamera(found).head<4>().array()).square().sum();
  const ModelCovariance covariance = CovarianceOfModel(found);
  for (int i = 0; i < kLegCount; ++i) {
    const LegSigma sigma = SigmaOfLeg(found, covariance, i);
    const size_t leg = static_cast<size_t>(i);
    const Eigen::Vector3d joint =
        found.base_joints_in_camera_m[leg] - truth.camera_from_base * truth.robot.legs[leg].base_joint_m;
    squares +=
        (joint.array() / sigma.base_joint_in_camera_m.array()).square().sum() +
        std::pow((found.robot.legs[leg].radius_m - truth.robot.legs[leg].radius_m) / sigma.radius_m, 2);
  }
  return std::sqrt(squares / (4 + 4 * kLegCount));
}

// Of the coordinates of the base joints in the camera frame, root mean square.
double BaseJointSigma_mm(const LegCalibration& found) {
  const ModelCovariance covariance = CovarianceOfModel(found);
  double squares = 0;
  for (int leg = 0; leg < kLegCount; ++leg)
    squares += SigmaOfLeg(found, covariance, leg).base_joint_in_camera_m.squaredNorm() / (3 * kLegCount);
  return 1e3 * std::sqrt(squares);
}

enum class BoardUse { kNone, kInformation, kTogether };

BenchTable::Row RowOf(const std::string& folder, BoardUse use) {
  Session session = ReadSession(folder);
  const RenderedTruth truth = ReadRenderedTruth(folder + "/truth.json");
  SessionCalibrationOptions options;
  options.lens = truth.camera.lens;
  if (use != BoardUse::kNone) {
    const CameraByBoard board = CalibrateByRenderedBoard(truth.camera, 24);
    session.camera = board.result.camera;
    if (use == BoardUse::kInformation)
      session.known.camera_information = board.result.information.information;
    if (use == BoardUse::kTogether) options.board = SolvedProblem(board.input, board.result, board.options);
  }
  const SessionCalibration found = CalibrateSession(session, options);
  if (found.calibration.status != CalibrationStatus::kConverged)
    throw std::runtime_error(folder + ": " + found.calibration.message);
  const auto error = [&](const GoughStewart& model) {
    std::mt19937_64 generator(1);
    return ErrorInFreshPoses(truth.robot, model, session.robot, {}, generator);
  };
  const PoseError drawn = error(session.robot),
                  calibrated = error(LaidOnto(truth.robot, found.calibration.robot));
  const char* const uses[] = {"", ", its board's information", ", solved with the board"};
  return {session.folder.filename().string() + uses[static_cast<int>(use)],
          {{"images", static_cast<double>(session.images.size())},
           {"position_mm", 1e3 * calibrated.position_m},
           {"times_better", drawn.position_m / calibrated.position_m},
           {"rotation_mrad", 1e3 * calibrated.rotation_rad},
           {"times_better_rotation", drawn.rotation_rad / calibrated.rotation_rad},
           {"error_in_sigmas", NormalisedError(found.calibration, truth)},
           {"sigma_of_A_in_camera_mm", BaseJointSigma_mm(found.calibration)},
           {"held_out_px", found.held_out_rms_px.value_or(std::nan(""))},
           {"solve_s", found.times.solve_s + found.times.covariance_s},
           {"total_s", found.times.total_s}}};
}

BenchTable Sessions() {
  BenchTable table{"poses from joint readings alone, calibrated against drawn, in 300 fresh poses", {}};
  for (const std::string& folder : Folders())
    for (const BoardUse use : {BoardUse::kNone, BoardUse::kInformation, BoardUse::kTogether})
      table.rows.push_back(RowOf(folder, use));
  return table;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::Sessions()}, argc, argv); }
