#include "calib/estimation_problem.h"

#include <fmt/format.h>

#include <Eigen/QR>

namespace legible {
namespace {

constexpr std::array<const char*, kLegParameterCount> kLegParameterNames = {"base_joint_in_camera_m.x",
                                                                            "base_joint_in_camera_m.y",
                                                                            "base_joint_in_camera_m.z",
                                                                            "platform_joint_m.x",
                                                                            "platform_joint_m.y",
                                                                            "platform_joint_m.z",
                                                                            "radius_m",
                                                                            "joint_offset_m",
                                                                            "edge_1_shift_px",
                                                                            "edge_1_tilt_px",
                                                                            "edge_2_shift_px",
                                                                            "edge_2_tilt_px"};

}  // namespace

LegTip TipOf(const PoseUnit& unit, const LegParameters& leg, const double* displacement) {
  if (unit.rigid)
    return TipOnPlatform(leg, unit.camera_from_platform, Eigen::Map<const Vector6d>(displacement));
  return TipAlongDirection(leg, unit.axis_in_camera, Eigen::Map<const Eigen::Vector2d>(displacement));
}

void Displace(PoseUnit& unit, const double* displacement) {
  if (unit.rigid) {
    unit.camera_from_platform =
        Displaced(unit.camera_from_platform, Eigen::Map<const Vector6d>(displacement));
    return;
  }
  const LegTip tip = TipAlongDirection(LegParameters::Zero(), unit.axis_in_camera,
                                       Eigen::Map<const Eigen::Vector2d>(displacement));
  unit.axis_in_camera = tip.b_in_camera;
}

bool EstimationProblem::HasPlatformGauge() const {
  bool platform_free = true;
  for (int leg = 0; leg < kLegCount; ++leg)
    for (int i = 0; i < 3; ++i)
      platform_free &=
          free[static_cast<size_t>(FirstParameterOfLeg(leg) + leg_parameter::kPlatformJoint + i)];
  return platform_free && !units.empty() && units.front().rigid;
}

Camera CameraOf(const EstimationProblem& problem) {
  return WithParameters(problem.camera, problem.shared.camera);
}

double& Parameter(SharedParameters& shared, int index) {
  if (index < kCameraParameterCount) return shared.camera[index];
  const int of_leg = index - kCameraParameterCount;
  return shared.legs[static_cast<size_t>(of_leg / kLegParameterCount)][of_leg % kLegParameterCount];
}

double Parameter(const SharedParameters& shared, int index) {
  return Parameter(const_cast<SharedParameters&>(shared), index);
}

std::string ParameterName(LensModel lens, int index) {
  if (index < kCameraParameterCount) return fmt::format("camera.{}", CameraParameterName(lens, index));
  const int of_leg = index - kCameraParameterCount;
  return fmt::format("legs[{}].{}", of_leg / kLegParameterCount + 1,
                     kLegParameterNames[static_cast<size_t>(of_leg % kLegParameterCount)]);
}

Eigen::Matrix<double, 6, 18> PlatformGauge(const LegPoints& drawn_platform_joints) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& joint : drawn_platform_joints) centroid += joint / kLegCount;
  // Columns of an infinitesimal rigid motion of the joints: translations, then rotations about their
  // centroid.
  Eigen::Matrix<double, 18, 6> motions;
  for (int i = 0; i < kLegCount; ++i)
    motions.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(),
        -Skew(drawn_platform_joints[static_cast<size_t>(i)] - centroid);
  const Eigen::MatrixXd orthonormal =
      motions.householderQr().householderQ() * Eigen::MatrixXd::Identity(18, 6);
  return orthonormal.transpose();
}

LegPoints BaseJointsInCamera(const SharedParameters& shared) {
  LegPoints joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = shared.legs[i].segment<3>(leg_parameter::kBaseJoint);
  return joints;
}

DrawnBaseResidual EvaluateDrawnBase(const EstimationProblem& problem, const SharedParameters& shared) {
  const LegPoints joints = BaseJointsInCamera(shared);
  const BaseFrame base = FitBaseFrame(joints, problem.drawn_base_joints);
  DrawnBaseResidual result;
  result.d_base_joints.setIdentity();
  for (int i = 0; i < kLegCount; ++i) {
    const size_t leg = static_cast<size_t>(i);
    const Eigen::Vector3d drawn = base.camera_from_base * problem.drawn_base_joints[leg];
    result.residual_m.segment<3>(3 * i) = joints[leg] - drawn;
    result.d_base_joints.middleRows<3>(3 * i) -= base.MotionOf(drawn);
  }
  return result;
}

std::vector<PlacementResiduals> EvaluatePlacements(const EstimationProblem& problem) {
  std::vector<PlacementResiduals> residuals;
  if (problem.tag_placements.empty()) return residuals;
  const BaseFrame base = FitBaseFrame(BaseJointsInCamera(problem.shared), problem.drawn_base_joints);
  residuals.reserve(problem.tag_placements.size());
  for (const TagPlacement& placement : problem.tag_placements)
    residuals.push_back(EvaluatePlacement(placement, Vector6d::Zero(), base));
  return residuals;
}

}  // namespace legible
