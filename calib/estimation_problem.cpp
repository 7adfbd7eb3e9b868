#include "calib/estimation_problem.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <stdexcept>

namespace legible {
namespace {

using Matrix18 = Eigen::Matrix<double, 18, 18>;

std::vector<std::string> MakeParameterNames() {
  std::vector<std::string> names;
  for (const char* name :
       {"fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"})
    names.push_back(fmt::format("camera.{}", name));
  for (int leg = 1; leg <= kLegCount; ++leg)
    for (const char* name :
         {"base_joint_in_camera_m.x", "base_joint_in_camera_m.y", "base_joint_in_camera_m.z",
          "platform_joint_m.x", "platform_joint_m.y", "platform_joint_m.z", "radius_m", "joint_offset_m",
          "edge_1_shift_px", "edge_1_tilt_px", "edge_2_shift_px", "edge_2_tilt_px"})
      names.push_back(fmt::format("legs[{}].{}", leg, name));
  return names;
}

// Columns of an infinitesimal rigid motion of the points: translations, then rotations about their centroid.
Eigen::Matrix<double, 18, 6> RigidMotions(const std::array<Eigen::Vector3d, kLegCount>& points) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centroid += point / kLegCount;
  Eigen::Matrix<double, 18, 6> motions;
  for (int i = 0; i < kLegCount; ++i)
    motions.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(),
        -Skew(points[static_cast<size_t>(i)] - centroid);
  return motions;
}

std::array<Eigen::Vector3d, kLegCount> BaseJoints(const SharedParameters& shared) {
  std::array<Eigen::Vector3d, kLegCount> joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = shared.legs[i].segment<3>(leg_parameter::kBaseJoint);
  return joints;
}

void AddDrawnBase(const EstimationProblem& problem, Eigen::MatrixXd& information) {
  const Matrix18 d = EvaluateDrawnBase(problem, problem.shared).d_base_joints / problem.base_joint_sigma_m;
  const Matrix18 added = d.transpose() * d;
  for (int i = 0; i < kLegCount; ++i)
    for (int j = 0; j < kLegCount; ++j)
      information.block<3, 3>(FirstParameterOfLeg(i), FirstParameterOfLeg(j)) +=
          added.block<3, 3>(3 * i, 3 * j);
}

// Adds one unit's information with its pose eliminated.
void AddUnit(const EstimationProblem& problem, const PoseUnit& unit, Eigen::MatrixXd& information) {
  const double at_rest[6] = {};
  Eigen::MatrixXd pose = Eigen::MatrixXd::Zero(unit.size(), unit.size());
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(kSharedParameterCount, unit.size());
  for (const LegObservation& observation : unit.legs) {
    const LegParameters& leg = problem.shared.legs[static_cast<size_t>(observation.leg)];
    const auto r = EvaluateLeg(problem.shared.camera, leg, TipOf(unit, leg, at_rest), observation);
    if (!r) throw std::runtime_error("SharedInformation: the model cannot be evaluated at its own solution");
    const int first = FirstParameterOfLeg(observation.leg);
    pose += r->d_pose.transpose() * r->d_pose;
    cross.topRows<kCameraParameterCount>() += r->d_camera.transpose() * r->d_pose;
    cross.middleRows<kLegParameterCount>(first) += r->d_leg.transpose() * r->d_pose;
    information.topLeftCorner<kCameraParameterCount, kCameraParameterCount>() +=
        r->d_camera.transpose() * r->d_camera;
    information.block<kLegParameterCount, kLegParameterCount>(first, first) +=
        r->d_leg.transpose() * r->d_leg;
    const Eigen::MatrixXd camera_leg = r->d_camera.transpose() * r->d_leg;
    information.block<kCameraParameterCount, kLegParameterCount>(0, first) += camera_leg;
    information.block<kLegParameterCount, kCameraParameterCount>(first, 0) += camera_leg.transpose();
  }
  // A direction that the image says nothing about takes no information with it: the pseudo-inverse.
  information -= cross * pose.completeOrthogonalDecomposition().solve(cross.transpose());
}

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

double& Parameter(SharedParameters& shared, int index) {
  if (index < kCameraParameterCount) return shared.camera[index];
  const int of_leg = index - kCameraParameterCount;
  return shared.legs[static_cast<size_t>(of_leg / kLegParameterCount)][of_leg % kLegParameterCount];
}

double Parameter(const SharedParameters& shared, int index) {
  return Parameter(const_cast<SharedParameters&>(shared), index);
}

const std::string& ParameterName(int index) {
  static const std::vector<std::string> names = MakeParameterNames();
  return names.at(static_cast<size_t>(index));
}

Eigen::Matrix<double, 6, 18> PlatformGauge(
    const std::array<Eigen::Vector3d, kLegCount>& drawn_platform_joints) {
  const Eigen::Matrix<double, 18, 6> motions = RigidMotions(drawn_platform_joints);
  const Eigen::MatrixXd orthonormal =
      motions.householderQr().householderQ() * Eigen::MatrixXd::Identity(18, 6);
  return orthonormal.transpose();
}

Matrix18 WithoutRigidMotion(const std::array<Eigen::Vector3d, kLegCount>& points) {
  const Eigen::Matrix<double, 18, 6> motions = RigidMotions(points);
  return Matrix18::Identity() - motions * (motions.transpose() * motions).ldlt().solve(motions.transpose());
}

DrawnBaseResidual EvaluateDrawnBase(const EstimationProblem& problem, const SharedParameters& shared) {
  const auto joints = BaseJoints(shared);
  const std::vector<Eigen::Vector3d> drawn(problem.drawn_base_joints.begin(),
                                           problem.drawn_base_joints.end());
  const Rigid3 camera_from_base = FitRigid(drawn, {joints.begin(), joints.end()});
  DrawnBaseResidual result;
  std::array<Eigen::Vector3d, kLegCount> drawn_in_camera;
  for (size_t i = 0; i < kLegCount; ++i) {
    drawn_in_camera[i] = camera_from_base * drawn[i];
    result.residual_m.segment<3>(3 * static_cast<Eigen::Index>(i)) = joints[i] - drawn_in_camera[i];
  }
  result.d_base_joints = WithoutRigidMotion(drawn_in_camera);
  return result;
}

Eigen::MatrixXd SharedInformation(const EstimationProblem& problem) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kSharedParameterCount, kSharedParameterCount);
  for (const PoseUnit& unit : problem.units) AddUnit(problem, unit, information);
  for (const ParameterPrior& prior : problem.priors)
    information(prior.parameter, prior.parameter) += 1 / (prior.sigma * prior.sigma);
  if (problem.base_joint_sigma_m > 0) AddDrawnBase(problem, information);
  for (int i = 0; i < kSharedParameterCount; ++i) {
    if (problem.free[static_cast<size_t>(i)]) continue;
    information.row(i).setZero();
    information.col(i).setZero();
  }
  return information;
}

}  // namespace legible
