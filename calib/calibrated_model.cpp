#include "calib/calibrated_model.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace legible {
namespace {

constexpr int kPlacement = kCameraParameterCount + kLegCount * kModelLegParameters;  // of the base: 6
constexpr int kModelParameters = kPlacement + 6;

std::vector<std::string> ModelNames(LensModel lens) {
  std::vector<std::string> names;
  names.reserve(kModelParameters);
  for (int i = 0; i < kCameraParameterCount; ++i) names.push_back(ParameterName(lens, i));
  for (int leg = 1; leg <= kLegCount; ++leg)
    for (const char* name : {"base_joint_m.x", "base_joint_m.y", "base_joint_m.z", "platform_joint_m.x",
                             "platform_joint_m.y", "platform_joint_m.z", "radius_m", "joint_offset_m"})
      names.push_back(fmt::format("legs[{}].{}", leg, name));
  for (const char* name : {"translation_m.x", "translation_m.y", "translation_m.z", "rotation_rad.x",
                           "rotation_rad.y", "rotation_rad.z"})
    names.push_back(fmt::format("camera_from_base.{}", name));
  return names;
}

double SigmaOf(const Eigen::MatrixXd& covariance, const std::vector<bool>& known, int index) {
  const double variance = covariance(index, index);
  return known[static_cast<size_t>(index)] ? std::sqrt(std::max(variance, 0.0))
                                           : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Eigen::MatrixXd ModelBySharedParameters(const LegPoints& base_joints_in_camera_m,
                                        const LegPoints& drawn_base_joints_m, bool base_joints_held) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(kModelParameters, kSharedParameterCount);
  map.topLeftCorner<kCameraParameterCount, kCameraParameterCount>().setIdentity();
  const BaseFrame base = FitBaseFrame(base_joints_in_camera_m, drawn_base_joints_m);
  const JointsInBase joints = TakeToBase(base, base_joints_in_camera_m);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const int row = kCameraParameterCount + leg * kModelLegParameters;
    const int shared = FirstParameterOfLeg(leg);
    map.block<5, 5>(row + 3, shared + leg_parameter::kPlatformJoint).setIdentity();
    const int base_joint = shared + leg_parameter::kBaseJoint;
    for (int other = 0; other < kLegCount && !base_joints_held; ++other)
      map.block<3, 3>(kCameraParameterCount + other * kModelLegParameters, base_joint) =
          joints.d_joints.block<3, 3>(3 * other, 3 * leg);
    map.block<6, 3>(kPlacement, base_joint) = base.d_joints.middleCols<3>(3 * leg);
  }
  return map;
}

ModelCovariance CovarianceOfModel(const LegCalibration& calibration) {
  const Eigen::MatrixXd map = ModelBySharedParameters(
      calibration.base_joints_in_camera_m, calibration.drawn_base_joints_m, calibration.base_joints_held);
  ModelCovariance model{
      ModelNames(calibration.camera.lens), map * calibration.observability.covariance * map.transpose(), {}};
  for (int row = 0; row < kModelParameters; ++row) {
    bool known = true;
    for (int column = 0; column < kSharedParameterCount; ++column)
      known &= map(row, column) == 0 || calibration.observability.known[static_cast<size_t>(column)];
    model.known.push_back(known);
  }
  return model;
}

Eigen::VectorXd ValuesOfModel(const LegCalibration& calibration) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(kModelParameters);
  values.head<kCameraParameterCount>() = ParametersOf(calibration.camera);
  for (int i = 0; i < kLegCount; ++i) {
    const Leg& leg = calibration.robot.legs[static_cast<size_t>(i)];
    values.segment<kModelLegParameters>(kCameraParameterCount + i * kModelLegParameters) << leg.base_joint_m,
        leg.platform_joint_m, leg.radius_m, leg.joint_offset_m;
  }
  return values;
}

CalibratedModel ToModel(const LegCalibration& calibration) {
  const ModelCovariance all = CovarianceOfModel(calibration);
  CalibratedModel model;
  model.robot = calibration.robot;
  model.camera = calibration.camera;
  model.camera_from_base = calibration.camera_from_base;
  std::vector<Eigen::Index> estimated;
  for (Eigen::Index i = 0; i < kModelParameters; ++i)
    if (all.WasEstimated(i)) estimated.push_back(i);
  for (const Eigen::Index i : estimated) model.parameter_names.push_back(all.names[static_cast<size_t>(i)]);
  model.covariance = all.covariance(estimated, estimated);
  return model;
}

LegSigma SigmaOfLeg(const LegCalibration& calibration, const ModelCovariance& model, int leg) {
  const int row = kCameraParameterCount + leg * kModelLegParameters;
  const int shared = FirstParameterOfLeg(leg);
  const Observability& observability = calibration.observability;
  LegSigma sigma;
  for (int i = 0; i < 3; ++i) {
    sigma.base_joint_m[i] = SigmaOf(model.covariance, model.known, row + i);
    sigma.platform_joint_m[i] = SigmaOf(model.covariance, model.known, row + 3 + i);
    sigma.base_joint_in_camera_m[i] = SigmaOf(observability.covariance, observability.known, shared + i);
  }
  sigma.radius_m = SigmaOf(model.covariance, model.known, row + 6);
  sigma.joint_offset_m = SigmaOf(model.covariance, model.known, row + 7);
  return sigma;
}

CameraParameters SigmaOfCamera(const LegCalibration& calibration) {
  CameraParameters sigma;
  for (int i = 0; i < kCameraParameterCount; ++i)
    sigma[i] = SigmaOf(calibration.observability.covariance, calibration.observability.known, i);
  return sigma;
}

}  // namespace legible
