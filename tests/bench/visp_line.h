// ViSP's moving-edges line, behind an interface of C++17: ViSP 3.5's headers are not C++20.
#pragma once

#include <cstdint>

namespace legible {

// a y + b x + c = 0, px; and the processor time that finding it took (the image's conversion left out).
struct VispLine {
  double a = 0, b = 0, c = 0;
  double time_s = 0;
};

// Tracks the line from a start that ends at the two given points (px); throws what ViSP throws. `pixels`: row
// by row.
VispLine FindLineWithVisp(const std::uint8_t* pixels, int width, int height, double start_x, double start_y,
                          double end_x, double end_y);

}  // namespace legible
