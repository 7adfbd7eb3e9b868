// Images of cylindrical legs whose edges are known exactly.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/geometry/camera.h"
#include "core/vision/predicted_legs.h"
#include "tests/testing/render_scene.h"

namespace legible {

// A light at infinity on a matt leg: ambient + diffuse * max(0, normal . towards_light).
struct LambertLight {
  double ambient = 60;                                // grey levels
  double diffuse = 140;                               // grey levels
  Eigen::Vector3d towards_light_in_camera{0, 0, -1};  // unit
};

struct RenderOptions {
  double background = 40;  // grey levels
  double leg = 200;        // grey levels, where no light is given
  std::optional<LambertLight> light;
  double blur_px = 0.8;  // standard deviation of the lens's Gaussian; the pixels' own extent is added
};

// Legs in front hide legs behind. Sight lines follow the camera's lens: each pixel near an edge is the mean
// of 208 exact intersections of sight lines with the cylinders, blurred before they are gathered into pixels.
CleanImage RenderLegs(const LegsInCamera& legs, const Camera& camera, const RenderOptions& options);

}  // namespace legible
