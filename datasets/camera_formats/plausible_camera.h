// What no camera is, whatever the format of its file.
#pragma once

#include <optional>
#include <string>

#include "core/geometry/camera.h"

namespace legible {

// What is wrong with the camera and what to do, as an InputError has them; nothing where it may be one: focal
// lengths of 0.2 to 50 times the image's width and height, the principal point in the image or half of it
// beside.
struct ImplausibleCamera {
  std::string what_is_wrong, what_to_do;
};
std::optional<ImplausibleCamera> WhatIsImplausible(const Camera& camera);

// The same of the coefficients of the lens: each by itself moves the image's corner by at most a million
// times its distance from the middle. (Those of a rational lens may cancel each other.)
std::optional<ImplausibleCamera> WhatCoefficientIsImplausible(const Camera& camera);

}  // namespace legible
