// Images of scenes whose brightness is known exactly along every sight line, through any lens.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "core/geometry/camera.h"
#include "core/vision/gray_image.h"

namespace legible {

// Brightness before noise and rounding, row by row.
struct CleanImage {
  int width = 0;
  int height = 0;
  std::vector<float> grey;
};

// What a camera looks at; x are normalised image coordinates without distortion.
class RenderedScene {
 public:
  virtual ~RenderedScene() = default;
  virtual double Brightness(const Eigen::Vector2d& x) const = 0;
  // Whether brightness may vary within the pixel about x, whose sides are `pixel` long.
  virtual bool VariesInPixel(const Eigen::Vector2d& x, double pixel) const = 0;
};

// Each pixel in which brightness varies is the mean of 208 sight lines, which follow the camera's lens,
// blurred before they are gathered into pixels: blur_px is the standard deviation of the lens's Gaussian, the
// pixels' own extent is added. What the lens has no sight lines for is `background`, grey levels.
CleanImage RenderScene(const RenderedScene& scene, const Camera& camera, double background, double blur_px);

// Adds normal noise to each pixel and rounds.
GrayImage WithNoise(const CleanImage& clean, double sigma_grey, std::mt19937_64& generator);

}  // namespace legible
