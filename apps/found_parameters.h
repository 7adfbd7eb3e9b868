// The parameters of a calibration that a number may be given for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "apps/calibration_run.h"
#include "calib/calibrated_model.h"

namespace legible {

struct FoundLeg {
  Eigen::Vector3d base_joint_m, base_joint_in_camera_m, platform_joint_m;
  double radius_m, joint_offset_m;
  LegSigma sigma;  // 0: held
};

// NaN, value and sigma alike, where the data do not determine a parameter or it had no part in the
// estimation.
struct FoundParameters {
  CameraParameters camera, camera_sigma;
  std::optional<Rigid3> camera_from_base;
  std::array<FoundLeg, kLegCount> legs;
};
FoundParameters WhatWasFound(const CalibrationRun& run);

}  // namespace legible
