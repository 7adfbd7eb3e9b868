#include "apps/truth_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "core/geometry/camera_parameters.h"

namespace legible {
namespace {

using Json = nlohmann::ordered_json;

Json RigidJson(const Rigid3& transform) {
  const Eigen::Matrix3d rotation = transform.rotation.toRotationMatrix();
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(List(rotation.row(row).transpose()));
  return {{"R", rows}, {"t", List(transform.translation)}};
}

Json CameraJson(const Camera& camera) {
  // A pinhole is a lens of five zeros.
  const LensModel lens = camera.lens == LensModel::kPinhole ? LensModel::kBrownConrady : camera.lens;
  Json distortion = {{"model", lens == LensModel::kRational  ? "opencv_rational"
                               : lens == LensModel::kFisheye ? "opencv_fisheye"
                                                             : "opencv_brown_conrady"}};
  for (int i = 0; i < static_cast<int>(lens); ++i)
    distortion[CameraParameterName(lens, 4 + i)] = camera.distortion[i];
  return {{"width", camera.width_px}, {"height", camera.height_px}, {"fx", camera.fx_px},
          {"fy", camera.fy_px},       {"cx", camera.cx_px},         {"cy", camera.cy_px},
          {"distortion", distortion}};
}

Json LegsJson(const SimulationTruth& truth) {
  Json legs = Json::array();
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = truth.robot.legs[i];
    legs.push_back({{"leg", i},
                    {"joint_column", fmt::format("q{}", i + 1)},
                    {"A_base", List(leg.base_joint_m)},
                    {"A_cam", List(truth.camera_from_base * leg.base_joint_m)},
                    {"B_platform", List(leg.platform_joint_m)},
                    {"radius", leg.radius_m},
                    {"joint_offset", leg.joint_offset_m}});
  }
  return legs;
}

}  // namespace

nlohmann::ordered_json TruthJson(const SimulatedSession& session) {
  const SimulationTruth& truth = session.truth.truth;
  Json images = Json::array();
  for (size_t i = 0; i < session.paper.images.size(); ++i)
    images.push_back({{"name", session.paper.images[i].name},
                      {"base_from_platform", RigidJson(session.base_from_platform[i])},
                      {"q_true", List(session.true_readings_m[i])},
                      {"q_measured", List(session.paper.images[i].joint_readings_m)}});
  return {{"camera", CameraJson(truth.camera)},
          {"camera_from_base", RigidJson(truth.camera_from_base)},
          {"legs", LegsJson(truth)},
          {"images", images}};
}

}  // namespace legible
