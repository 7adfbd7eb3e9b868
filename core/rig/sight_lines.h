// Where each place of the image looks, through the lens.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/camera.h"

namespace legible {

// Undistorted normalised coordinates (x, y) of sight lines (x, y, 1), exact at the corners of pixels and
// interpolated between: within 1e-3 px for any lens that bends by less than that from a pixel to the next.
class SightLines {
 public:
  explicit SightLines(const Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }
  // Whether the lens shows anything there.
  bool HasImage(int x, int y) const { return has_image_[Index(x, y, width_)] != 0; }
  // At the top-left corner of a pixel, or at the right or lower end of the last ones; not finite where the
  // lens shows nothing.
  const Eigen::Vector2d& AtCorner(int x, int y) const { return corners_[Index(x, y, width_ + 1)]; }
  // At a place within a pixel, (0, 0) its top-left corner, (1, 1) its bottom-right one.
  Eigen::Vector2d At(int x, int y, double right, double down) const {
    const size_t above = Index(x, y, width_ + 1), below = Index(x, y + 1, width_ + 1);
    return (1 - down) * ((1 - right) * corners_[above] + right * corners_[above + 1]) +
           down * ((1 - right) * corners_[below] + right * corners_[below + 1]);
  }

 private:
  static size_t Index(int x, int y, int width) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }

  int width_, height_;
  std::vector<Eigen::Vector2d> corners_;  // of pixels, row by row
  std::vector<char> has_image_;           // by pixel
};

}  // namespace legible
