// Ray traces a scene of which most stands still.
#pragma once

#include <algorithm>
#include <array>
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
// light from where that may be dark; where surfaces or shadows end between neighbours, it looks at the
// corners of their pixels, and takes many sight lines where these differ.
class SceneRenderer {
 public:
  // The room casts no shadows.
  SceneRenderer(const Camera& camera, const SceneParts& room, const SceneParts& base, const SceneLight& light,
                double background_grey, const Blotches& blotches);

  // Mean brightness over each pixel.
  BrightnessImage Render(const SceneParts& moving_parts) const;

 private:
  // What stands still as the middle of each pixel sees it, and as the whole pixel does.
  struct FixedViews {
    std::vector<float> depth, paint_grey, middle_grey, mean_grey;
    std::vector<Eigen::Vector3f> normal;
    std::vector<int> surface;
    std::vector<char> is_lit;
    std::vector<char> is_even;  // nothing that stands still ends in the pixel or in its neighbours

    explicit FixedViews(size_t count)
        : depth(count),
          paint_grey(count),
          middle_grey(count),
          mean_grey(count),
          normal(count),
          surface(count),
          is_lit(count),
          is_even(count) {}
  };
  // What moves, or nothing.
  struct Moving {
    const RayScene* scene = nullptr;
    std::vector<Paint> paints;
  };

  // What is met at the corners of some pixels of a row: upper ones, then lower ones.
  static constexpr int kCornered = static_cast<int>(kPacketSize) / 2 - 1;  // pixels
  struct CornerKeys {
    std::array<int, kPacketSize> keys;

    bool AreAll(size_t pixel, int key) const {
      const size_t below = pixel + kPacketSize / 2;
      return keys[pixel] == key && keys[pixel + 1] == key && keys[below] == key && keys[below + 1] == key;
    }
  };

  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(lines_.width()) + static_cast<size_t>(x);
  }
  bool IsFixed(int surface) const { return surface < static_cast<int>(fixed_paints_.size()); }
  float PaintGrey(const Moving& moving, int surface, const Eigen::Vector3f& x_in_camera) const;

  SightPacket MiddlesOf(int x, int y) const;
  ShadowPacket Shadows(const SightPacket& packet) const;
  void ViewFixed(int y, PixelViews& views);
  void ViewMoving(const Moving& moving, int y, PixelViews& views) const;

  // Whether the neighbours of a pixel see something else, or something that moves.
  bool HasOtherKeysAbout(const PixelViews& views, int x, int y) const;
  bool IsNearTouched(const PixelViews& views, int x, int y) const;
  bool Bends(const PixelViews& views, int x, int y) const;
  CornerKeys KeysAtCorners(const Moving& moving, int x, int y) const;

  SightPacket SamplesOf(int x, int y, size_t round) const;
  ShadowPacket Look(const Moving& moving, size_t pixel, SightPacket& packet) const;
  float SumOver(const Moving& moving, int x, int y, size_t round) const;
  float MeanOver(const Moving& moving, int x, int y, size_t rounds) const;
  size_t RoundsFor(const PixelViews& views, int x, int y, bool shows_edge) const;
  void FillRow(const Moving& moving, const PixelViews& views, int y, float* row) const;

  SightLines lines_;
  SceneLight light_;
  float background_grey_;
  Blotches blotches_;
  std::vector<Paint> fixed_paints_;
  RayScene room_scene_, base_scene_;
  FixedViews fixed_;
};

}  // namespace legible
