// Ray traces a scene of which most stands still.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rig/blotches.h"
#include "core/rig/ray_scene.h"
#include "core/rig/sensor.h"
#include "core/rig/sight_lines.h"

namespace legible {

// Where the light comes from.
struct SceneLight {
  Eigen::Vector3f towards_in_camera;  // unit
  float ambient = 0;                  // share of the light that comes from everywhere

  float Share(float cosine, bool is_lit) const {
    return ambient + (is_lit ? (1 - ambient) * std::max(0.0F, cosine) : 0.0F);
  }
};

// What one sight line each meets in the pixels of an image, row by row.
struct PixelViews {
  // Surface and whether the light reaches it: pixels whose neighbours have all the same show no edge.
  std::vector<int> key;
  std::vector<float> grey;
  std::vector<char> is_touched;  // by what moves: it, or its shadow, is seen

  explicit PixelViews(size_t count) : key(count), grey(count), is_touched(count) {}
};

// Looks once at what stands still. Each image then takes one sight line a pixel to what moves and one to the
// light from where that may be dark, and many where surfaces or shadows end.
class SceneRenderer {
 public:
  SceneRenderer(const Camera& camera, const SceneParts& fixed, const SceneLight& light, double background_grey,
                const Blotches& blotches);

  // Mean brightness over each pixel.
  BrightnessImage Render(const SceneParts& moving) const;

 private:
  // What stands still as the middle of each pixel sees it, and as the whole pixel does.
  struct FixedViews {
    std::vector<float> depth, paint_grey, middle_grey, mean_grey;
    std::vector<int> surface;
    std::vector<char> is_lit;

    explicit FixedViews(size_t count)
        : depth(count),
          paint_grey(count),
          middle_grey(count),
          mean_grey(count),
          surface(count),
          is_lit(count) {}
  };
  // What moves, or nothing.
  struct Moving {
    const RayScene* scene = nullptr;
    std::vector<Paint> paints;
  };

  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(lines_.width()) + static_cast<size_t>(x);
  }
  bool IsFixed(int surface) const { return surface < static_cast<int>(fixed_paints_.size()); }
  float PaintGrey(const Moving& moving, int surface, const Eigen::Vector3f& x_in_camera) const;

  SightPacket MiddlesOf(int x, int y) const;
  void ViewFixed(int y, PixelViews& views);
  void ViewMoving(const Moving& moving, int y, PixelViews& views) const;
  ShadowPacket Shadows(const SightPacket& packet) const;

  bool ShowsEdge(const PixelViews& views, int x, int y) const;
  bool IsNearTouched(const PixelViews& views, int x, int y) const;
  float MeanOver(const Moving& moving, int x, int y) const;
  float PixelGrey(const Moving& moving, const PixelViews& views, int x, int y) const;

  SightLines lines_;
  SceneLight light_;
  float background_grey_;
  Blotches blotches_;
  std::vector<Paint> fixed_paints_;
  RayScene fixed_scene_;
  FixedViews fixed_;
};

}  // namespace legible
