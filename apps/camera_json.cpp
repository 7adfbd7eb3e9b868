#include "apps/camera_json.h"

#include <nlohmann/json.hpp>

#include "apps/calibrate_settings.h"
#include "apps/json_text.h"

namespace legible {

nlohmann::ordered_json CameraValues(const CameraParameters& values, LensModel lens) {
  const int coefficients = static_cast<int>(lens == LensModel::kPinhole ? LensModel::kBrownConrady : lens);
  return {{"fx", values[0]},
          {"fy", values[1]},
          {"cx", values[2]},
          {"cy", values[3]},
          {"distortion", List(values.segment(4, coefficients))}};
}

nlohmann::ordered_json CameraJson(const Camera& camera, const CameraParameters& values) {
  nlohmann::ordered_json json = {
      {"width_px", camera.width_px}, {"height_px", camera.height_px}, {"lens", LensName(camera.lens)}};
  json.update(CameraValues(values, camera.lens));
  return json;
}

}  // namespace legible
