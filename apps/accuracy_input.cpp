#include "apps/accuracy_input.h"

#include <fmt/format.h>

#include "apps/wording.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"
#include "datasets/pose_file.h"
#include "datasets/session_file.h"
#include "datasets/three_upu_file.h"

namespace legible {
namespace {

JudgedPose At(const std::string& name, const Vector6d& coordinates,
              const OrientationConvention& orientation) {
  JudgedPose pose;
  pose.name = name;
  pose.coordinates = coordinates;
  pose.base_from_platform = {orientation.ToRotation(coordinates.tail<3>()), coordinates.head<3>()};
  return pose;
}

JudgedPose At(const std::string& name, const Rigid3& base_from_platform,
              const OrientationConvention& orientation) {
  Vector6d coordinates;
  coordinates << base_from_platform.translation, orientation.FromRotation(base_from_platform.rotation);
  return At(name, coordinates, orientation);
}

// The poses that a session's joint readings lead to.
void AddSession(const AccuracySettings& settings, const JudgedRobot& robot, std::vector<JudgedPose>& poses) {
  const auto* hexapod = std::get_if<GoughStewart>(&robot.mechanism);
  if (hexapod == nullptr)
    throw InputError(settings.model, 0, "is a 3-UPU, whose sessions are not known", "give poses");
  for (const SessionImage& image : ReadSession(*settings.session).images) {
    const auto found = ForwardKinematics(*hexapod, image.joint_readings_m, hexapod->home);
    poses.push_back(At(image.name, found.base_from_platform, settings.orientation));
    if (found.status == ForwardKinematicsStatus::kConverged) continue;
    poses.back().status = "impossible";
    poses.back().message =
        fmt::format("forward kinematics from its joint readings is {}", ToString(found.status));
  }
}

// The first leg that cannot, and how many others.
std::string OutOfReachText(const Mechanism& mechanism, const Eigen::VectorXd& readings_m) {
  const std::vector<int> legs = JointsOutOfRange(mechanism, readings_m);
  if (legs.empty()) return "";
  const auto [shortest_m, longest_m] = JointRangesOf(mechanism)[static_cast<size_t>(legs[0])];
  const std::string text = fmt::format("leg {} would read {:.4f} m, beyond its range of {:.4g} to {:.4g} m",
                                       legs[0] + 1, readings_m[legs[0]], shortest_m, longest_m);
  const int others = static_cast<int>(legs.size()) - 1;
  return others > 0 ? fmt::format("{}, and {} beyond theirs", text, Plural(others, "other leg")) : text;
}

void MarkUnreachable(const JudgedRobot& robot, JudgedPose& pose) {
  if (!pose.status.empty()) return;
  if (!CanTake(robot.mechanism, pose.base_from_platform)) {
    pose.status = "impossible";
    pose.message = "the platform of a 3-UPU only translates: give it no rotation";
    return;
  }
  pose.message = OutOfReachText(robot.mechanism, JointReadingsOf(robot.mechanism, pose.base_from_platform));
  if (!pose.message.empty()) pose.status = "out_of_reach";
}

std::string PoseName(size_t number) { return fmt::format("pose {}", number); }

}  // namespace

JudgedRobot ReadJudgedRobot(const AccuracySettings& settings) {
  if (HoldsThreeUpu(settings.model)) return {ReadThreeUpu(settings.model), {}, {}, {}};
  const CalibratedModel model = ReadModel(settings.model);
  JudgedRobot robot{model.robot, model.camera, model.camera_from_base, {}};
  if (model.covariance.size() > 0)
    robot.geometry_covariance = GeometryCovariance(model.parameter_names, model.covariance);
  return robot;
}

PoseAccuracyOptions PoseOptionsOf(const AccuracySettings& settings, const JudgedRobot& robot) {
  const int joints = JointCountOf(robot.mechanism);
  const std::vector<double> errors_m =
      settings.joint_error_m.empty() ? std::vector<double>{kAssumedJointError_m} : settings.joint_error_m;
  if (errors_m.size() != 1 && errors_m.size() != static_cast<size_t>(joints))
    throw InputError(
        settings.model, 0,
        fmt::format("has {} joints, and --joint-error gives {} numbers", joints, errors_m.size()),
        "give one, or one for each joint");
  const bool is_hexapod = std::holds_alternative<GoughStewart>(robot.mechanism);
  if (!is_hexapod && (settings.geometry_error_m || settings.edge_noise_px))
    throw InputError(settings.model, 0,
                     "is a 3-UPU: errors of geometry and vision are known for hexapods only",
                     "leave --geometry-error and --edge-noise out");
  if (settings.edge_noise_px && !(robot.camera && robot.camera_from_base))
    throw InputError(settings.model, 0, "has no camera, which --edge-noise needs",
                     "give the model.yaml of a calibration, or leave --edge-noise out");
  PoseAccuracyOptions options;
  options.joint_error_bounds = Eigen::VectorXd::Constant(joints, errors_m.front());
  for (size_t i = 0; i < errors_m.size(); ++i)
    options.joint_error_bounds[static_cast<Eigen::Index>(i)] = errors_m[i];
  options.geometry_bound_m = settings.geometry_error_m;
  options.edge_sigma_px = settings.edge_noise_px;
  options.leg_sets = settings.leg_sets;
  options.characteristic_length_m = settings.characteristic_length_m;
  options.length_unit_m = LengthUnitOf(settings).si;
  return options;
}

std::vector<JudgedPose> PosesToJudge(const AccuracySettings& settings, const JudgedRobot& robot) {
  std::vector<JudgedPose> poses;
  for (const Vector6d& coordinates : settings.poses)
    poses.push_back(At(PoseName(poses.size() + 1), coordinates, settings.orientation));
  if (settings.poses_file)
    for (const PoseRow& row : ReadPoses(*settings.poses_file))
      poses.push_back(At(row.name, row.coordinates, settings.orientation));
  if (settings.session) AddSession(settings, robot, poses);
  if (poses.empty()) poses.push_back(At("home", HomeOf(robot.mechanism), settings.orientation));
  for (JudgedPose& pose : poses) MarkUnreachable(robot, pose);
  return poses;
}

}  // namespace legible
