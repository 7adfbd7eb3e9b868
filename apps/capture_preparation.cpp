#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "apps/calibrate_settings.h"
#include "apps/capture_run.h"
#include "calib/pose_candidates.h"
#include "core/robots/mechanism.h"
#include "datasets/camera_file.h"
#include "datasets/input_error.h"
#include "datasets/pose_file.h"
#include "datasets/robot_file.h"
#include "servo/joint_limits.h"

namespace legible {
namespace {

constexpr double kLeastRegularity = 0.05;  // of a pose that a user names, on the way from home
constexpr double kSamePose_m = 1e-4;

PriorKnowledge KnownOf(const CaptureSettings& settings, const OpenedRig& rig) {
  PriorKnowledge known;
  if (rig.reading_sigma_m) known.joint_reading_m = std::max(*rig.reading_sigma_m, kLeastKnownSigma);
  for (const auto& [name, sigma] : settings.known)
    for (const auto& [known_name, field] : kKnownFields)
      if (known_name == name) known.*field = sigma;
  return known;
}

InputError NoDrawing(const CaptureSettings& settings, const std::string& what, const std::string& mend) {
  return InputError(settings.rig, 0, fmt::format("has no drawing of the {}", what), mend);
}

GoughStewart RobotOnPaper(const CaptureSettings& settings, const OpenedRig& rig) {
  if (settings.robot) return ReadRobot(*settings.robot);
  if (rig.drawing_robot) return ReadRobot(*rig.drawing_robot);
  if (rig.simulation) return rig.simulation->rig->truth().robot;
  throw NoDrawing(settings, "robot", "name a robot.yaml with --robot");
}

CameraFile CameraOnPaper(const CaptureSettings& settings, const OpenedRig& rig) {
  const auto& file = settings.camera ? settings.camera : rig.drawing_camera;
  if (file) {
    CameraFile camera = ReadCamera(*file);
    if (!camera.camera_from_base)
      throw InputError(*file, 0, "does not say where the camera is",
                       "add camera_from_base: a tape measure will do");
    return camera;
  }
  if (!rig.simulation) throw NoDrawing(settings, "camera", "name a camera.yaml with --camera");
  const SimulationTruth& truth = rig.simulation->rig->truth();
  return {truth.camera, truth.camera_from_base};
}

// The laboratory's papers: those that were named, else those that the rig names, else a simulated rig's
// truth.
Session DescriptionOf(const CaptureSettings& settings, const OpenedRig& rig,
                      std::vector<std::string>& warnings) {
  Session session;
  session.robot = RobotOnPaper(settings, rig);
  const CameraFile camera = CameraOnPaper(settings, rig);
  session.camera = camera.camera;
  session.camera_from_base = camera.camera_from_base;
  warnings = camera.warnings;
  session.known = KnownOf(settings, rig);
  if (!ForgetsCamera(settings.known)) session.known.camera_information = camera.information;
  const bool is_robot_drawn = settings.robot || rig.drawing_robot;
  const bool is_camera_drawn = settings.camera || rig.drawing_camera;
  if (!is_robot_drawn || !is_camera_drawn)
    warnings.push_back(
        fmt::format("{} names no drawing of the {}: the session has the true one, and there "
                    "is nothing to find",
                    rig.simulation->truth_file.string(),
                    is_robot_drawn    ? "camera"
                    : is_camera_drawn ? "robot"
                                      : "robot and camera"));
  return session;
}

bool IsSame(const Rigid3& a, const Rigid3& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

bool IsSame(const GoughStewart& a, const GoughStewart& b) {
  if (!IsSame(a.home, b.home)) return false;
  return std::equal(a.legs.begin(), a.legs.end(), b.legs.begin(), [](const Leg& one, const Leg& other) {
    return one.base_joint_m == other.base_joint_m && one.platform_joint_m == other.platform_joint_m &&
           one.radius_m == other.radius_m && one.joint_offset_m == other.joint_offset_m &&
           one.joint_range_m == other.joint_range_m;
  });
}

bool IsSame(const Camera& a, const Camera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px && a.fy_px == b.fy_px &&
         a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.lens == b.lens && a.distortion == b.distortion;
}

// What was begun is gone on with: options that say otherwise are a mistake.
void DemandSameAs(const Session& session, const CaptureSettings& settings) {
  const auto differs = [&](const std::filesystem::path& file, const char* what) {
    return InputError(file, 0,
                      fmt::format("is not the {} that {} was begun with", what, session.folder.string()),
                      "leave the option out, or begin another session");
  };
  if (settings.robot && !IsSame(ReadRobot(*settings.robot), session.robot))
    throw differs(*settings.robot, "robot");
  if (settings.camera) {
    const CameraFile camera = ReadCamera(*settings.camera);
    const bool is_placed_alike =
        camera.camera_from_base.has_value() == session.camera_from_base.has_value() &&
        (!camera.camera_from_base || IsSame(*camera.camera_from_base, *session.camera_from_base));
    if (!IsSame(camera.camera, session.camera) || !is_placed_alike) throw differs(*settings.camera, "camera");
  }
  for (const auto& [name, sigma] : settings.known)
    for (const auto& [known_name, field] : kKnownFields)
      if (known_name == name && session.known.*field != sigma)
        throw InputError(session.files.at(0), 0, fmt::format("says otherwise of {} than --known", name),
                         "leave --known out, or begin another session");
}

std::unique_ptr<GrowingSession> OpenSession(const CaptureSettings& settings, const OpenedRig& rig,
                                            std::vector<std::string>& warnings) {
  if (!settings.resumes || !std::filesystem::exists(settings.out / "session.yaml"))
    return std::make_unique<GrowingSession>(settings.out, DescriptionOf(settings, rig, warnings));
  auto session = std::make_unique<GrowingSession>(settings.out);
  DemandSameAs(session->session(), settings);
  if (!session->session().camera_from_base)
    throw InputError(session->session().files.at(2), 0, "does not say where the camera is",
                     "add camera_from_base: a tape measure will do");
  return session;
}

// The file that says what the session's camera is like, where there is one.
std::filesystem::path CameraFileName(const CaptureSettings& settings, const OpenedRig& rig,
                                     const Session& session) {
  if (settings.camera) return *settings.camera;
  if (!session.files.empty()) return session.files.at(2);  // of a session that is gone on with
  return rig.drawing_camera.value_or(settings.rig);
}

std::string ImageNameOf(const std::filesystem::path& file, const PoseRow& row) {
  const bool is_plain = row.name.find_first_not_of(
                            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                            "0123456789_-.") == std::string::npos &&
                        !row.name.starts_with('.');
  if (!is_plain)
    throw InputError(file, row.line, fmt::format("pose \"{}\" gives no file name for its image", row.name),
                     "name it by letters, digits, _, - and .");
  return row.name + ".png";
}

// Throws for what the joints cannot reach, or would not come to from home.
NamedPose PoseOf(const std::filesystem::path& file, const PoseRow& row, const GoughStewart& robot) {
  NamedPose pose{ImageNameOf(file, row),
                 {RotationFromVector(row.coordinates.tail<3>()), row.coordinates.head<3>()}};
  const Vector6d readings_m = InverseKinematics(robot, pose.base_from_platform);
  const double margin_m = JointLimitOptions().range_margin_m;
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] >= shortest_m + margin_m && readings_m[i] <= longest_m - margin_m) continue;
    throw InputError(
        file, row.line,
        fmt::format(
            "pose \"{}\" is out of reach: leg {} would read {:.4f} m, and its range is {:.4g} to {:.4g} m "
            "with {:.1g} mm to keep from its ends",
            row.name, i + 1, readings_m[i], shortest_m, longest_m, 1e3 * margin_m),
        "mend it, or take this row out");
  }
  const auto reached = PoseFromHome(robot, readings_m, kLeastRegularity);
  if (!reached || Displacement(*reached, pose.base_from_platform).norm() > kSamePose_m)
    throw InputError(
        file, row.line,
        fmt::format("pose \"{}\" is not what its joint readings lead to from home: it lies beyond, or "
                    "near, a singular pose",
                    row.name),
        "mend it, or take this row out");
  return pose;
}

}  // namespace

PreparedCapture PrepareCapture(const CaptureSettings& settings, OpenedRig rig) {
  PreparedCapture prepared;
  prepared.settings = settings;
  prepared.rig = std::move(rig);
  prepared.session = OpenSession(settings, prepared.rig, prepared.warnings);
  const Session& session = prepared.session->session();
  DemandSameImageSize(CameraFileName(settings, prepared.rig, session), session.camera, prepared.rig);
  if (settings.poses)
    for (const PoseRow& row : ReadPoses(*settings.poses))
      prepared.poses.push_back(PoseOf(*settings.poses, row, session.robot));
  return prepared;
}

}  // namespace legible
