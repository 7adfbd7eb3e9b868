#include "apps/found_parameters.h"

#include <cmath>
#include <limits>

namespace legible {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
const Eigen::Vector3d kUnknownPoint = Eigen::Vector3d::Constant(kUnknown);

FoundLeg UnknownLeg() {
  return {kUnknownPoint, kUnknownPoint, kUnknownPoint,
          kUnknown,      kUnknown,      {kUnknownPoint, kUnknownPoint, kUnknownPoint, kUnknown, kUnknown}};
}

double IfKnown(double value, double sigma) { return std::isnan(sigma) ? kUnknown : value; }

template <typename Values>
Values IfKnown(const Values& values, const Values& sigmas) {
  return values.binaryExpr(sigmas, [](double value, double sigma) { return IfKnown(value, sigma); });
}

FoundLeg FindLeg(const CalibrationRun& run, const ModelCovariance& covariance, int leg) {
  const LegCalibration& calibration = run.result.calibration;
  LegSigma sigma = SigmaOfLeg(calibration, covariance, leg);
  // Where each leg's direction is free there is no platform, and no length for a reading to be compared with.
  if (!run.options.estimation.rigid_platform) sigma.platform_joint_m = kUnknownPoint;
  if (!run.options.estimation.use_joint_readings) sigma.joint_offset_m = kUnknown;
  const auto i = static_cast<size_t>(leg);
  const Leg& found = calibration.robot.legs[i];
  return {IfKnown(found.base_joint_m, sigma.base_joint_m),
          IfKnown(calibration.base_joints_in_camera_m[i], sigma.base_joint_in_camera_m),
          IfKnown(found.platform_joint_m, sigma.platform_joint_m),
          IfKnown(found.radius_m, sigma.radius_m),
          IfKnown(found.joint_offset_m, sigma.joint_offset_m),
          sigma};
}

bool AreBaseJointsKnown(const FoundParameters& found) {
  for (const FoundLeg& leg : found.legs)
    if (!leg.base_joint_in_camera_m.allFinite()) return false;
  return true;
}

}  // namespace

FoundParameters WhatWasFound(const CalibrationRun& run) {
  const LegCalibration& calibration = run.result.calibration;
  FoundParameters found{CameraParameters::Constant(kUnknown), CameraParameters::Constant(kUnknown), {}, {}};
  found.legs.fill(UnknownLeg());
  if (calibration.status != CalibrationStatus::kConverged &&
      calibration.status != CalibrationStatus::kUnobservable)
    return found;
  found.camera_sigma = SigmaOfCamera(calibration);
  found.camera = IfKnown(ParametersOf(calibration.camera), found.camera_sigma);
  const ModelCovariance covariance = CovarianceOfModel(calibration);
  for (int leg = 0; leg < kLegCount; ++leg)
    found.legs[static_cast<size_t>(leg)] = FindLeg(run, covariance, leg);
  if (AreBaseJointsKnown(found)) found.camera_from_base = calibration.camera_from_base;
  return found;
}

}  // namespace legible
