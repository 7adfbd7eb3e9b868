// Cameras of every lens, and where they see points.
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "datasets/camera_file.h"
#include "datasets/synthetic_session.h"

namespace legible {

inline std::vector<Camera> CamerasOfEveryLens() {
  Camera pinhole = DesktopCamera(false), four = DesktopCamera(true), five = DesktopCamera(true),
         rational = DesktopCamera(true);
  pinhole.lens = LensModel::kPinhole;
  five.distortion[4] = -0.013;
  rational.lens = LensModel::kRational;
  rational.distortion << 0.6, 0.04, 5e-4, -7e-5, 0.002, 0.9, 0.1, 1e-5;
  return {pinhole, four, five, rational, DesktopFisheye()};
}

inline CameraFile PlacedCamera(const Camera& camera) {
  return {camera, LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})};
}

// Points of depth 1 whose images are spread over the camera's.
inline std::vector<Eigen::Vector2d> PointsInSight(const Camera& camera) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 6; ++j)
      points.push_back(
          Unproject(camera, {i * (camera.width_px - 1) / 8.0, j * (camera.height_px - 1) / 6.0}).value());
  return points;
}

}  // namespace legible
