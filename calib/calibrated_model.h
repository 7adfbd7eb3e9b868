// What a calibration hands on to the rest of the program.
#pragma once

#include <string>

#include "calib/leg_calibration.h"
#include "core/session/session.h"

namespace legible {

inline constexpr int kModelLegParameters = 8;  // A (3), B (3), R, joint offset

// Linear map from the shared parameters of the estimation to those of ModelCovariance: A is taken to the base
// frame, which follows A; base joints that are held among themselves have zero rows.
Eigen::MatrixXd ModelBySharedParameters(const LegPoints& base_joints_in_camera_m,
                                        const LegPoints& drawn_base_joints_m, bool base_joints_held);

// Covariance of the parameters that a model is used with: the camera's, then for each leg A in base, B in
// platform, R and joint offset, in the gauges of LegCalibration, then the placement of the base (displacement
// in camera); parameters that were held have zero rows.
struct ModelCovariance {
  std::vector<std::string> names;
  Eigen::MatrixXd covariance;
  std::vector<bool> known;  // false: no number may be given for the parameter

  bool WasEstimated(Eigen::Index i) const { return known[static_cast<size_t>(i)] && covariance(i, i) > 0; }
};
ModelCovariance CovarianceOfModel(const LegCalibration& calibration);

// The values of those parameters; of the base's placement, a displacement, 0.
Eigen::VectorXd ValuesOfModel(const LegCalibration& calibration);

// With the covariance of what was estimated; what was held or stays open has no rows. Provenance is the
// caller's to add.
CalibratedModel ToModel(const LegCalibration& calibration);

// One standard deviation of a leg's parameters (m) in CovarianceOfModel, and of A in the camera frame; NaN:
// not known.
struct LegSigma {
  Eigen::Vector3d base_joint_m, base_joint_in_camera_m, platform_joint_m;
  double radius_m, joint_offset_m;
};
LegSigma SigmaOfLeg(const LegCalibration& calibration, const ModelCovariance& model, int leg);

// One standard deviation of the camera's parameters in the order of CameraParameters; 0: held, NaN: not
// known.
CameraParameters SigmaOfCamera(const LegCalibration& calibration);

}  // namespace legible
