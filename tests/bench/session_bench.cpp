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

BenchTable::Row RowOf(const std::string& folder) {
  const Session session = ReadSession(folder);
  const RenderedTruth truth = ReadRenderedTruth(folder + "/truth.json");
  const SessionCalibration found = CalibrateSession(session, {});
  if (found.calibration.status != CalibrationStatus::kConverged)
    throw std::runtime_error(folder + ": " + found.calibration.message);
  const auto error = [&](const GoughStewart& model) {
    std::mt19937_64 generator(1);
    return ErrorInFreshPoses(truth.robot, model, session.robot, {}, generator);
  };
  const PoseError drawn = error(session.robot),
                  calibrated = error(LaidOnto(truth.robot, found.calibration.robot));
  return {session.folder.filename().string(),
          {{"images", static_cast<double>(session.images.size())},
           {"position_mm", 1e3 * calibrated.position_m},
           {"times_better", drawn.position_m / calibrated.position_m},
           {"rotation_mrad", 1e3 * calibrated.rotation_rad},
           {"times_better_rotation", drawn.rotation_rad / calibrated.rotation_rad},
           {"error_in_sigmas", NormalisedError(found.calibration, truth)},
           {"held_out_px", found.held_out_rms_px.value_or(std::nan(""))},
           {"solve_s", found.times.solve_s + found.times.covariance_s},
           {"total_s", found.times.total_s}}};
}

BenchTable Sessions() {
  BenchTable table{"poses from joint readings alone, calibrated against drawn, in 300 fresh poses", {}};
  for (const std::string& folder : Folders()) table.rows.push_back(RowOf(folder));
  return table;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::Sessions()}, argc, argv); }
