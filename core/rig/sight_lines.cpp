#include "core/rig/sight_lines.h"

#include <tbb/parallel_for.h>

#include <limits>

namespace legible {

SightLines::SightLines(const Camera& camera)
    : width_(camera.width_px),
      height_(camera.height_px),
      corners_(Index(0, height_ + 1, width_ + 1)),
      has_image_(Index(0, height_, width_)) {
  const Eigen::Vector2d nowhere = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  tbb::parallel_for(0, height_ + 1, [&](int y) {
    for (int x = 0; x <= width_; ++x)
      corners_[Index(x, y, width_ + 1)] = Unproject(camera, {x - 0.5, y - 0.5}).value_or(nowhere);
  });
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) has_image_[Index(x, y, width_)] = At(x, y, 0.5, 0.5).allFinite() ? 1 : 0;
}

}  // namespace legible
