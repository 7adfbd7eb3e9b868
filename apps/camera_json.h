// A camera as the documents of several commands have it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/camera_parameters.h"

namespace legible {

// {fx, fy, cx, cy, distortion}: values of a camera's parameters, or their sigmas; a pinhole's coefficients
// are five zeros.
nlohmann::ordered_json CameraValues(const CameraParameters& values, LensModel lens);

// The same with width_px, height_px and lens before them.
nlohmann::ordered_json CameraJson(const Camera& camera, const CameraParameters& values);

}  // namespace legible
