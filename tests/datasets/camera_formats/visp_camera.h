// ViSP's reader and writer of cameras, and its projection. Apart, for ViSP 3.5's headers are not C++20.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace legible {

enum class VispLens { kPinhole, kRadial, kFisheye };

// px, py, u0, v0, then kud and kdu, or k1 to k5.
struct VispCamera {
  VispLens lens = VispLens::kPinhole;
  std::vector<double> values;
};

// By vpXmlParserCamera, the camera named "camera" for images of that size; throws std::runtime_error.
VispCamera ReadByVisp(const std::string& file, VispLens lens, int width_px, int height_px);
void WriteByVisp(const std::string& file, const VispCamera& camera, int width_px, int height_px);

// vpMeterPixelConversion and vpPixelMeterConversion.
std::array<double, 2> ToPixelByVisp(const VispCamera& camera, double x, double y);
std::array<double, 2> ToMetreByVisp(const VispCamera& camera, double u, double v);

}  // namespace legible
