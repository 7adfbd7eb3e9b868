#include "tests/testing/rendered_truth.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace legible {
namespace {

using Json = nlohmann::json;

Eigen::Vector3d VectorOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Rigid3 RigidOf(const Json& json) {
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row) rotation.row(row) = VectorOf(json.at("R").at(static_cast<size_t>(row)));
  return {Eigen::Quaterniond(rotation).normalized(), VectorOf(json.at("t"))};
}

Camera CameraOf(const Json& json) {
  Camera camera;
  camera.width_px = json.at("width");
  camera.height_px = json.at("height");
  camera.fx_px = json.at("fx");
  camera.fy_px = json.at("fy");
  camera.cx_px = json.at("cx");
  camera.cy_px = json.at("cy");
  const Json& lens = json.at("distortion");
  camera.distortion.head<5>() << lens.at("k1").get<double>(), lens.at("k2").get<double>(),
      lens.at("p1").get<double>(), lens.at("p2").get<double>(), lens.at("k3").get<double>();
  return camera;
}

}  // namespace

RenderedTruth ReadRenderedTruth(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + " cannot be read");
  const Json json = Json::parse(stream);
  RenderedTruth truth;
  truth.camera = CameraOf(json.at("camera"));
  truth.camera_from_base = RigidOf(json.at("camera_from_base"));
  for (size_t i = 0; i < kLegCount; ++i) {
    const Json& leg = json.at("legs").at(i);
    truth.robot.legs[i].base_joint_m = VectorOf(leg.at("A_base"));
    truth.robot.legs[i].platform_joint_m = VectorOf(leg.at("B_platform"));
    truth.robot.legs[i].radius_m = leg.at("radius");
    truth.robot.legs[i].joint_offset_m = leg.at("joint_offset");
  }
  for (const Json& image : json.at("images"))
    truth.images.emplace_back(image.at("name"), RigidOf(image.at("base_from_platform")));
  return truth;
}

}  // namespace legible
