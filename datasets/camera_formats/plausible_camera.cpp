#include "datasets/camera_formats/plausible_camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/geometry/camera_parameters.h"

namespace legible {
namespace {

constexpr double kShortestFocalLength = 0.2;  // of the image size: a field of view of 136 degrees
constexpr double kLongestFocalLength = 50;    // of the image size: 1.1 degrees

// Along one side of the image.
struct Axis {
  const char *focal_name, *centre_name, *side;
  double focal_px, centre_px;
  int size_px;
};

std::optional<ImplausibleCamera> WrongFocalLength(const Axis& axis) {
  if (axis.focal_px >= kShortestFocalLength * axis.size_px &&
      axis.focal_px <= kLongestFocalLength * axis.size_px)
    return std::nullopt;
  if (axis.focal_px <= 0)
    return ImplausibleCamera{fmt::format("has {} {} px", axis.focal_name, axis.focal_px),
                             "give a number greater than 0"};
  const double field_of_view_deg = 2 * std::atan2(0.5 * axis.size_px, axis.focal_px) * 180 / std::numbers::pi;
  return ImplausibleCamera{
      fmt::format("has {} {} px for an image {} px {}, which means a field of view of {:.3g} degrees",
                  axis.focal_name, axis.focal_px, axis.size_px, axis.side, field_of_view_deg),
      fmt::format("give the focal length in pixels, between {} and {} times that size", kShortestFocalLength,
                  kLongestFocalLength)};
}

// Lenses are shifted, and images cut out of larger ones, but not by as much as the image.
std::optional<ImplausibleCamera> WrongCentre(const Axis& axis) {
  if (axis.centre_px >= -0.5 * axis.size_px && axis.centre_px <= 1.5 * axis.size_px) return std::nullopt;
  return ImplausibleCamera{fmt::format("has {} {} px for an image {} px {}", axis.centre_name, axis.centre_px,
                                       axis.size_px, axis.side),
                           "give the principal point in pixels, in the image or near it"};
}

}  // namespace

std::optional<ImplausibleCamera> WhatIsImplausible(const Camera& camera) {
  const Axis across{"fx", "cx", "wide", camera.fx_px, camera.cx_px, camera.width_px};
  const Axis down{"fy", "cy", "high", camera.fy_px, camera.cy_px, camera.height_px};
  for (const auto check : {WrongFocalLength, WrongCentre})
    for (const Axis& axis : {across, down})
      if (auto wrong = check(axis)) return wrong;
  return std::nullopt;
}

std::optional<ImplausibleCamera> WhatCoefficientIsImplausible(const Camera& camera) {
  constexpr double kMost = 1e6;
  Camera centred = camera;
  centred.cx_px = 0.5 * camera.width_px;
  centred.cy_px = 0.5 * camera.height_px;
  const Distortion sizes = CoefficientSizes(centred);
  for (int i = 0; i < static_cast<int>(camera.lens); ++i) {
    const double value = camera.distortion[i];
    if (std::abs(value) <= kMost * sizes[i]) continue;
    return ImplausibleCamera{
        fmt::format("has {} {:g}, which is no lens's for an image of {} x {} px",
                    CameraParameterName(camera.lens, 4 + i), value, camera.width_px, camera.height_px),
        "mend that coefficient"};
  }
  return std::nullopt;
}

}  // namespace legible
