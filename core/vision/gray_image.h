// 8-bit grey images, without a dependency on the library that decodes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace legible {

struct GrayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  // row by row

  std::uint8_t operator()(int x, int y) const { return Row(y)[x]; }
  const std::uint8_t* Row(int y) const {
    return pixels.data() + static_cast<size_t>(y) * static_cast<size_t>(width);
  }
};

// Any format that OpenCV reads, colours turned to grey; nothing where the file is not an image.
std::optional<GrayImage> ReadGrayImage(const std::filesystem::path& file);

// The bytes of a PNG file.
std::string EncodePng(const GrayImage& image);

// Gaussian blur; sigma_px > 0.
GrayImage Blurred(const GrayImage& image, double sigma_px);

}  // namespace legible
