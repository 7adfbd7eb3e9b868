// From the light that falls on a sensor to the image that it gives: blur, noise, rounding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vision/gray_image.h"

namespace legible {

// Brightness in grey levels, before noise and rounding.
struct BrightnessImage {
  int width = 0;
  int height = 0;
  std::vector<float> grey;  // row by row

  float* Row(int y) { return grey.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }
  const float* Row(int y) const { return grey.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }
};

// Gaussian blur of standard deviation sigma_px >= 0; beyond the border the image goes on as it ends there.
BrightnessImage Blurred(const BrightnessImage& image, double sigma_px);

// Normal noise that depends on (seed, frame, pixel) alone.
class PixelNoise {
 public:
  PixelNoise(double sigma_grey, std::uint64_t seed);
  // Adds the noise of a frame, and rounds to 0 … 255.
  GrayImage Expose(const BrightnessImage& image, std::uint64_t frame) const;

 private:
  // Quantiles of the normal distribution; a pixel's noise is the sum of two of them drawn at random.
  static constexpr size_t kQuantiles = 4096;
  std::array<float, kQuantiles> quantiles_;
  std::uint64_t seed_;
};

// Scrambles all bits (splitmix64): neighbouring numbers give unrelated ones.
inline std::uint64_t Scrambled(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace legible
