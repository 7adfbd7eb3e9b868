#include "tests/reproduction/lab_rigs.h"

#include <stdexcept>

#include "calib/leg_calibration.h"
#include "tests/testing/delta_lab.h"

namespace legible {
namespace {

SyntheticOptions SessionOptions(std::uint64_t seed) {
  SyntheticOptions options;
  options.image_count = 20;
  options.drawing = DesktopHexapod();
  options.geometry_error_m = 2e-3;
  options.joint_offset_error_m = 1.5e-3;
  options.radius_error_m = 6e-4;
  options.camera = DeltaLabCamera();
  options.camera_from_base = DeltaLabCameraFromBase();
  options.camera_error_px = 8;
  options.camera_position_error_m = 0.03;
  options.camera_rotation_error_rad = 0.05;
  options.edge_sigma_px = 0.05;
  options.joint_reading_sigma_m = 2e-5;
  options.seed = options.noise_seed = seed;
  return options;
}

}  // namespace

LabRig DrawLabRig(std::uint64_t seed) {
  const SyntheticSession session = GenerateSession(SessionOptions(seed));
  return {{session.true_robot, session.true_camera, session.true_camera_from_base},
          {session.nominal_robot, session.nominal_camera, session.nominal_camera_from_base},
          session.observations};
}

SimulationTruth Calibrated(const LabRig& rig) {
  LegCalibrationInput input{
      rig.nominal.robot, rig.nominal.camera, rig.nominal.camera_from_base, rig.session, {}, {}};
  input.known.joint_reading_m = SessionOptions(1).joint_reading_sigma_m;
  LegCalibrationOptions options;
  options.threads = 1;
  const LegCalibration found = CalibrateLegs(input, options);
  if (found.status != CalibrationStatus::kConverged)
    throw std::runtime_error("the calibration of a rig failed: " + found.message);
  return {found.robot, found.camera, found.camera_from_base};
}

}  // namespace legible
