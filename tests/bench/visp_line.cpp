#include "tests/bench/visp_line.h"

#include <visp3/me/vpMeLine.h>

#include <algorithm>
#include <ctime>

#include "tests/bench/visp_moving_edges.h"

namespace legible {

VispLine FindLineWithVisp(const std::uint8_t* pixels, int width, int height, double start_x, double start_y,
                          double end_x, double end_y) {
  vpImage<unsigned char> image(static_cast<unsigned>(height), static_cast<unsigned>(width));
  std::copy(pixels, pixels + static_cast<long>(width) * height, image.bitmap);
  vpMe me = MovingEdges();
  const std::clock_t before = std::clock();
  vpMeLine line;
  line.setMe(&me);
  line.initTracking(image, vpImagePoint(start_y, start_x), vpImagePoint(end_y, end_x));
  line.track(image);
  const double time_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return {line.getA(), line.getB(), line.getC(), time_s};
}

}  // namespace legible
