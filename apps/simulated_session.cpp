#include "apps/simulated_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/json_text.h"
#include "apps/truth_json.h"
#include "calib/pose_candidates.h"
#include "core/rig/drives.h"
#include "core/rig/scene_camera.h"
#include "core/robots/mechanism.h"
#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"
#include "datasets/input_error.h"
#include "datasets/robot_file.h"
#include "datasets/session_file.h"

namespace legible {
namespace {

// Of DesktopHexapod and SyntheticOptions: where the camera stands before it, in base, and looks.
constexpr double kDesktopRadius_m = 0.27;
const Eigen::Vector3d kDesktopEye_m{0.94, 0.074, 0.285}, kDesktopTarget_m{0, 0, 0.13};

// As that before a robot of another size, whose base frame may lie anywhere: x of the base as far as it lies
// in the base's plane, up towards the platform at home.
Rigid3 UsualCameraPlace(const GoughStewart& robot) {
  Eigen::Vector3d base_centre = Eigen::Vector3d::Zero(), platform_centre = Eigen::Vector3d::Zero();
  for (const Leg& leg : robot.legs) {
    base_centre += leg.base_joint_m / kLegCount;
    platform_centre += robot.home * leg.platform_joint_m / kLegCount;
  }
  double squares = 0;
  for (const Leg& leg : robot.legs) squares += (leg.base_joint_m - base_centre).squaredNorm();
  const double scale = std::sqrt(squares / kLegCount) / kDesktopRadius_m;
  const Eigen::Vector3d up = (platform_centre - base_centre).normalized();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX() - up.x() * up;
  if (forward.norm() < 0.1) forward = Eigen::Vector3d::UnitY() - up.y() * up;
  Eigen::Matrix3d axes;
  axes.col(0) = forward.normalized();
  axes.col(1) = up.cross(axes.col(0));
  axes.col(2) = up;
  const Rigid3 base_from_upright{Eigen::Quaterniond(axes).normalized(), base_centre};
  return LookAt(scale * kDesktopEye_m, scale * kDesktopTarget_m) * Inverse(base_from_upright);
}

// The desktop's lens before a sensor of that many pixels.
Camera UsualCamera(const SimulateSettings& settings) {
  Camera camera = DesktopCamera(true);
  const int width = settings.width_px.value_or(camera.width_px);
  const int height = settings.height_px.value_or(width * camera.height_px / camera.width_px);
  const double scale = static_cast<double>(width) / camera.width_px;
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  camera.cx_px = scale * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = scale * (camera.cy_px + 0.5) - 0.5 + (height - scale * camera.height_px) / 2;
  camera.width_px = width;
  camera.height_px = height;
  return camera;
}

SyntheticOptions OptionsOf(const SimulateSettings& settings, std::vector<std::string>& warnings) {
  SyntheticOptions options;
  if (settings.robot) options.drawing = ReadRobot(*settings.robot);
  options.camera = UsualCamera(settings);
  options.camera_from_base = UsualCameraPlace(options.drawing);
  if (settings.camera) {
    const CameraFile camera = ReadCamera(*settings.camera);
    options.camera = camera.camera;
    warnings.insert(warnings.end(), camera.warnings.begin(), camera.warnings.end());
    if (camera.camera_from_base) options.camera_from_base = *camera.camera_from_base;
  }
  options.geometry_error_m = settings.geometry_error_m;
  options.joint_offset_error_m = settings.offset_error_m;
  options.radius_error_m = settings.radius_error_m;
  options.camera_error_px = settings.camera_error_px;
  options.camera_position_error_m = settings.camera_position_error_m;
  options.camera_rotation_error_rad = settings.camera_rotation_error_rad;
  options.joint_reading_sigma_m = settings.reading_noise_m;
  options.seed = static_cast<std::uint64_t>(settings.seed);
  return options;
}

void DemandHomeInReach(const SimulateSettings& settings, const GoughStewart& robot) {
  if (JointsOutOfRange(robot, InverseKinematics(robot, robot.home)).empty()) return;
  throw InputError(settings.robot.value_or(settings.out), 0,
                   "the robot as drawn at random cannot take its home pose: a joint leaves its range",
                   "give a home in the middle of the joint ranges, or smaller errors");
}

void DrawRig(const SimulateSettings& settings, SimulatedSession& session) try {
  const SyntheticRig rig = GenerateRig(OptionsOf(settings, session.warnings));
  DemandHomeInReach(settings, rig.true_robot);
  session.truth.truth = {rig.true_robot, rig.true_camera, rig.true_camera_from_base};
  session.truth.options.seed = static_cast<std::uint64_t>(settings.seed);
  session.truth.options.drives.reading_noise_m = settings.reading_noise_m;
  session.paper.robot = rig.nominal_robot;
  session.paper.camera = rig.nominal_camera;
  session.paper.camera_from_base = rig.nominal_camera_from_base;
  if (settings.radius_error_m > 0) session.paper.known.radius_m = settings.radius_error_m / std::sqrt(3.0);
} catch (const std::invalid_argument& error) {
  throw InputError(settings.robot.value_or(settings.out), 0, "no rig can be drawn like this", error.what());
}

void ReadRig(const SimulateSettings& settings, SimulatedSession& session) {
  session.truth = ReadTruth(*settings.truth);
  const SimulationTruth& truth = session.truth.truth;
  session.paper.robot = session.truth.drawing_robot ? ReadRobot(*session.truth.drawing_robot) : truth.robot;
  const CameraFile camera = session.truth.drawing_camera ? ReadCamera(*session.truth.drawing_camera)
                                                         : CameraFile{truth.camera, truth.camera_from_base};
  session.paper.camera = camera.camera;
  session.paper.camera_from_base = camera.camera_from_base;
  session.warnings = camera.warnings;
  if (!session.truth.drawing_robot || !session.truth.drawing_camera)
    session.warnings.push_back(fmt::format(
        "{} does not name both drawings: what is missing is the true one, and there is nothing to find",
        settings.truth->string()));
}

void DrawImages(const SimulateSettings& settings, SimulatedSession& session) {
  const SimulationTruth& truth = session.truth.truth;
  PoseCandidateOptions options;
  options.count = settings.images;
  options.seed = static_cast<std::uint64_t>(settings.seed);
  const PoseCandidates drawn =
      DrawPoseCandidates({truth.robot, truth.camera, truth.camera_from_base}, options);
  if (static_cast<int>(drawn.poses.size()) < settings.images)
    throw InputError(
        settings.truth.value_or(settings.robot.value_or(settings.out)), 0,
        fmt::format("of {} poses {} are out of reach, and in {} too little of the legs is in sight",
                    drawn.drawn, drawn.out_of_reach, drawn.out_of_sight),
        "place the camera otherwise, or widen joint_range_m");
  for (size_t i = 0; i < drawn.poses.size(); ++i) {
    const Rigid3& pose = drawn.poses[i].base_from_platform;
    const Vector6d readings_m = InverseKinematics(truth.robot, pose);
    const Drives drives(session.truth.options.drives, truth.robot, readings_m, session.truth.options.seed);
    session.base_from_platform.push_back(pose);
    session.true_readings_m.push_back(readings_m);
    session.paper.images.push_back({fmt::format("{:03}.png", i), {}, drives.Measure(i)});
  }
}

}  // namespace

SimulatedSession DrawSession(const SimulateSettings& settings) {
  SimulatedSession session;
  if (settings.truth)
    ReadRig(settings, session);
  else
    DrawRig(settings, session);
  if (const auto sigma_m = ReadingSigma(session.truth.options.drives))
    session.paper.known.joint_reading_m = std::max(*sigma_m, kLeastKnownSigma);
  for (const auto& [name, sigma] : settings.known)
    for (const auto& [known_name, field] : kKnownFields)
      if (known_name == name) session.paper.known.*field = sigma;
  if (settings.images > 0) DrawImages(settings, session);
  return session;
}

void WriteSimulatedSession(const std::filesystem::path& folder, const SimulatedSession& session,
                           const std::function<void(int done, int total)>& progress) {
  SimulatedTruth truth = session.truth;
  truth.drawing_robot = folder / "robot.yaml";
  truth.drawing_camera = folder / "camera.yaml";
  WriteTruth(folder / "truth.yaml", truth);
  const int count = static_cast<int>(session.paper.images.size());
  if (count == 0) {
    WriteRobot(folder / "robot.yaml", session.paper.robot);
    WriteCamera(folder / "camera.yaml", session.paper.camera, session.paper.camera_from_base);
    return;
  }
  WriteSession(folder, session.paper);
  WriteFileAtomically(folder / "truth.json", JsonText(TruthJson(session)));
  std::filesystem::create_directory(folder / "images");
  const SceneCamera camera(truth.truth, truth.options.scene, truth.options.seed);
  for (int i = 0; i < count; ++i) {
    progress(i, count);
    const auto image = static_cast<size_t>(i);
    WriteFileAtomically(folder / "images" / session.paper.images[image].name,
                        EncodePng(camera.Take(session.base_from_platform[image], {}, image)));
  }
}

}  // namespace legible
