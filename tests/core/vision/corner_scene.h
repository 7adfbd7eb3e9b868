// A printed corner for tests: where it is, and how it is seen.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/vision/corner_fit.h"
#include "tests/testing/random.h"
#include "tests/testing/render_scene.h"

namespace legible {

inline Eigen::Vector2d Direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

inline CornerCells RandomCells(std::mt19937_64& generator) {
  CornerCells cells;
  for (double& cell : cells.reshaped()) cell = Uniform(generator, 0, 1) < 0.5 ? 0 : 1;
  return cells;
}

inline CornerSite SiteAt(const Eigen::Vector2d& pixel, double direction_1_rad, double direction_2_rad,
                         double pitch_px, const CornerCells& cells) {
  return {pixel, {pitch_px * Direction(direction_1_rad), pitch_px * Direction(direction_2_rad)}, cells, true};
}

// The cells as they are seen, with no formula but where each place of the image lies among them.
class CellScene : public RenderedScene {
 public:
  CellScene(const CornerSite& site, double dark, double light) : site_(site), dark_(dark), light_(light) {
    edges_ << site.edges_px[0], site.edges_px[1];
    inverse_ = edges_.inverse();
  }
  double Brightness(const Eigen::Vector2d& x) const override {
    const Eigen::Vector2d pitches = inverse_ * (x - site_.pixel);
    const auto cell = [](double at) { return std::clamp(static_cast<int>(std::floor(at)) + 2, 0, 3); };
    return dark_ + (light_ - dark_) * site_.cells(cell(pitches.y()), cell(pitches.x()));
  }
  bool VariesInPixel(const Eigen::Vector2d&, double) const override { return true; }

 private:
  CornerSite site_;
  double dark_, light_;
  Eigen::Matrix2d edges_, inverse_;
};

// Its normalised coordinates are pixels.
inline Camera PixelCamera(int size_px) {
  Camera camera;
  camera.width_px = camera.height_px = size_px;
  camera.fx_px = camera.fy_px = 1;
  camera.lens = LensModel::kPinhole;
  return camera;
}

inline CornerModel::Parameters ParametersOf(const CornerSite& site, double blur_px) {
  CornerModel::Parameters parameters;
  parameters << site.pixel, std::atan2(site.edges_px[0].y(), site.edges_px[0].x()),
      std::atan2(site.edges_px[1].y(), site.edges_px[1].x()), blur_px;
  return parameters;
}

inline CornerSite RandomSite(std::mt19937_64& generator, const CornerCells& cells) {
  const double direction_1 = Uniform(generator, -M_PI, M_PI);
  const double opening = Uniform(generator, 0.9, 2.2) * (Uniform(generator, -1, 1) > 0 ? 1 : -1);
  return SiteAt({Uniform(generator, -0.5, 0.5), Uniform(generator, -0.5, 0.5)}, direction_1,
                direction_1 + opening, Uniform(generator, 2.5, 6), cells);
}

}  // namespace legible
