#include "core/rig/scene_renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace legible {
namespace {

constexpr float kFar_m = 1e9F;
constexpr int kRowsPerTask = 4;
constexpr int kNoKey = -1;
// Grey levels by which a pixel's middle may differ from the mean of two opposite neighbours; its own mean
// differs from its middle by a twelfth of that at most.
constexpr float kLargestBend_grey = 2;

// Places of the sight lines over a pixel: Korobov's lattice, moved as a whole by another amount in each
// pixel. The share of them on one side of a straight edge of any direction is off by 0.016 (rms), and by
// nothing on average.
constexpr size_t kSamples = 48, kGenerator = 37;

Eigen::Vector2d SamplePlace(size_t sample, const Eigen::Vector2d& shift) {
  const Eigen::Vector2d place =
      Eigen::Vector2d(static_cast<double>(sample), static_cast<double>(sample * kGenerator % kSamples)) /
          kSamples +
      shift;
  return place - Eigen::Vector2d(std::floor(place.x()), std::floor(place.y()));
}

Eigen::Vector2d SampleShift(size_t pixel) {
  const std::uint64_t bits = Scrambled(pixel);
  constexpr double kUnit = 1.0 / (1ULL << 32U);
  return {static_cast<double>(bits >> 32U) * kUnit, static_cast<double>(bits & 0xffffffffU) * kUnit};
}

std::vector<Paint> PaintsOf(const SceneParts& parts) {
  std::vector<Paint> paints;
  for (const Cylinder& cylinder : parts.cylinders) paints.push_back(cylinder.paint);
  for (const Ball& ball : parts.balls) paints.push_back(ball.paint);
  for (const Face& face : parts.faces) paints.push_back(face.paint);
  return paints;
}

int KeyOf(int surface, bool is_lit) { return surface < 0 ? kNoKey : 2 * surface + (is_lit ? 1 : 0); }

template <typename RowJob>
void ForEachRow(int height, const RowJob& job) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsPerTask), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y) job(y);
  });
}

}  // namespace

SceneRenderer::SceneRenderer(const Camera& camera, const SceneParts& fixed, const SceneLight& light,
                             double background_grey, const Blotches& blotches)
    : lines_(camera),
      light_(light),
      background_grey_(static_cast<float>(background_grey)),
      blotches_(blotches),
      fixed_paints_(PaintsOf(fixed)),
      fixed_scene_(fixed, 0),
      fixed_(IndexOf(0, camera.height_px)) {
  PixelViews views(IndexOf(0, lines_.height()));
  ForEachRow(lines_.height(), [&](int y) { ViewFixed(y, views); });
  ForEachRow(lines_.height(), [&](int y) {
    for (int x = 0; x < lines_.width(); ++x)
      fixed_.mean_grey[IndexOf(x, y)] =
          ShowsEdge(views, x, y) ? MeanOver({}, x, y) : views.grey[IndexOf(x, y)];
  });
}

BrightnessImage SceneRenderer::Render(const SceneParts& parts) const {
  const RayScene scene(parts, static_cast<int>(fixed_paints_.size()));
  const Moving moving{&scene, PaintsOf(parts)};
  PixelViews views(IndexOf(0, lines_.height()));
  ForEachRow(lines_.height(), [&](int y) { ViewMoving(moving, y, views); });
  BrightnessImage image{lines_.width(), lines_.height(), std::vector<float>(views.grey.size())};
  ForEachRow(lines_.height(), [&](int y) {
    for (int x = 0; x < lines_.width(); ++x) image.Row(y)[x] = PixelGrey(moving, views, x, y);
  });
  return image;
}

float SceneRenderer::PaintGrey(const Moving& moving, int surface, const Eigen::Vector3f& x_in_camera) const {
  const size_t index = static_cast<size_t>(surface);
  const Paint& paint = IsFixed(surface) ? fixed_paints_[index] : moving.paints[index - fixed_paints_.size()];
  const double texture = paint.has_texture ? blotches_.At(x_in_camera.cast<double>()) : 0;
  return static_cast<float>(paint.grey + texture);
}

// Through the middles of the pixels from (x, y) on; those beyond the row's end or the lens's see nothing.
SightPacket SceneRenderer::MiddlesOf(int x, int y) const {
  SightPacket packet;
  for (size_t i = 0; i < kPacketSize; ++i) {
    const int column = x + static_cast<int>(i);
    const bool is_seen = column < lines_.width() && lines_.HasImage(column, y);
    const Eigen::Vector2d line = is_seen ? lines_.At(column, y, 0.5, 0.5) : Eigen::Vector2d(0, 0);
    packet.direction.Set(i, line.cast<float>().homogeneous());
    packet.depth[i] = is_seen ? kFar_m : 0;
    packet.surface[i] = -1;
  }
  return packet;
}

// From what was met, where it faces the light.
ShadowPacket SceneRenderer::Shadows(const SightPacket& packet) const {
  ShadowPacket shadows;
  for (size_t i = 0; i < kPacketSize; ++i) {
    shadows.origin.Set(i, packet.depth[i] * packet.direction[i]);
    const bool faces_light =
        packet.surface[i] >= 0 && packet.normal[i].dot(light_.towards_in_camera) > 0 && light_.ambient < 1;
    shadows.is_wanted[i] = faces_light;
    shadows.is_dark[i] = !faces_light;
  }
  return shadows;
}

void SceneRenderer::ViewFixed(int y, PixelViews& views) {
  for (int x = 0; x < lines_.width(); x += static_cast<int>(kPacketSize)) {
    SightPacket packet = MiddlesOf(x, y);
    fixed_scene_.Trace(packet);
    ShadowPacket shadows = Shadows(packet);
    fixed_scene_.TraceShadows(light_.towards_in_camera, shadows);
    const size_t count = std::min(kPacketSize, static_cast<size_t>(lines_.width() - x));
    for (size_t i = 0; i < count; ++i) {
      const size_t pixel = IndexOf(x, y) + i;
      const int surface = packet.surface[i];
      const bool is_seen = surface >= 0, is_lit = is_seen && !shadows.is_dark[i];
      fixed_.depth[pixel] = packet.depth[i];
      fixed_.surface[pixel] = surface;
      fixed_.is_lit[pixel] = is_lit ? 1 : 0;
      const float paint = is_seen ? PaintGrey({}, surface, shadows.origin[i]) : background_grey_;
      const float cosine = packet.normal[i].dot(light_.towards_in_camera);
      fixed_.paint_grey[pixel] = paint;
      fixed_.middle_grey[pixel] = is_seen ? paint * light_.Share(cosine, is_lit) : paint;
      views.grey[pixel] = fixed_.middle_grey[pixel];
      views.key[pixel] = KeyOf(surface, is_lit);
    }
  }
}

void SceneRenderer::ViewMoving(const Moving& moving, int y, PixelViews& views) const {
  for (int x = 0; x < lines_.width(); x += static_cast<int>(kPacketSize)) {
    SightPacket packet = MiddlesOf(x, y);
    const size_t count = std::min(kPacketSize, static_cast<size_t>(lines_.width() - x));
    const size_t first = IndexOf(x, y);
    for (size_t i = 0; i < count; ++i) packet.depth[i] = fixed_.depth[first + i];
    moving.scene->Trace(packet);
    ShadowPacket shadows = Shadows(packet), on_moving = shadows;
    fixed_scene_.TraceShadows(light_.towards_in_camera, on_moving);
    // What stands still is known to be lit or not, but for shadows of what moves.
    for (size_t i = 0; i < count; ++i) {
      const bool is_lit = packet.surface[i] >= 0 ? !on_moving.is_dark[i] : fixed_.is_lit[first + i] != 0;
      shadows.is_wanted[i] = is_lit;
      shadows.is_dark[i] = !is_lit;
    }
    moving.scene->TraceShadows(light_.towards_in_camera, shadows);
    for (size_t i = 0; i < count; ++i) {
      const size_t pixel = first + i;
      const int surface = packet.surface[i];
      const bool is_lit = !shadows.is_dark[i];
      if (surface >= 0) {
        const float cosine = packet.normal[i].dot(light_.towards_in_camera);
        views.grey[pixel] = PaintGrey(moving, surface, shadows.origin[i]) * light_.Share(cosine, is_lit);
        views.key[pixel] = KeyOf(surface, is_lit);
        views.is_touched[pixel] = 1;
        continue;
      }
      const bool was_lit = fixed_.is_lit[pixel] != 0;
      views.grey[pixel] =
          was_lit && !is_lit ? fixed_.paint_grey[pixel] * light_.ambient : fixed_.middle_grey[pixel];
      views.key[pixel] = KeyOf(fixed_.surface[pixel], is_lit);
      views.is_touched[pixel] = was_lit != is_lit ? 1 : 0;
    }
  }
}

bool SceneRenderer::IsNearTouched(const PixelViews& views, int x, int y) const {
  for (int row = std::max(0, y - 1); row <= std::min(lines_.height() - 1, y + 1); ++row)
    for (int column = std::max(0, x - 1); column <= std::min(lines_.width() - 1, x + 1); ++column)
      if (views.is_touched[IndexOf(column, row)] != 0) return true;
  return false;
}

// Whether a surface or a shadow may end within the pixel, or its brightness bend.
bool SceneRenderer::ShowsEdge(const PixelViews& views, int x, int y) const {
  const size_t pixel = IndexOf(x, y), width = static_cast<size_t>(lines_.width());
  if (!lines_.HasImage(x, y)) return false;
  const int left = std::max(0, x - 1), right = std::min(lines_.width() - 1, x + 1);
  const int top = std::max(0, y - 1), bottom = std::min(lines_.height() - 1, y + 1);
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column)
      if (views.key[IndexOf(column, row)] != views.key[pixel]) return true;
  const float *const grey = views.grey.data() + pixel, middle = 2 * *grey;
  return (right - left == 2 && std::abs(grey[-1] + grey[1] - middle) > 2 * kLargestBend_grey) ||
         (bottom - top == 2 && std::abs(*(grey - width) + grey[width] - middle) > 2 * kLargestBend_grey);
}

// Over many sight lines of a pixel.
float SceneRenderer::MeanOver(const Moving& moving, int x, int y) const {
  const size_t pixel = IndexOf(x, y);
  const Eigen::Vector2d shift = SampleShift(pixel);
  float sum = 0;
  for (size_t start = 0; start < kSamples; start += kPacketSize) {
    SightPacket packet;
    for (size_t i = 0; i < kPacketSize; ++i) {
      const Eigen::Vector2d place = SamplePlace(start + i, shift);
      packet.direction.Set(i, lines_.At(x, y, place.x(), place.y()).cast<float>().homogeneous());
      packet.depth[i] = kFar_m;
      packet.surface[i] = -1;
    }
    fixed_scene_.Trace(packet);
    if (moving.scene) moving.scene->Trace(packet);
    ShadowPacket shadows = Shadows(packet);
    if (moving.scene) moving.scene->TraceShadows(light_.towards_in_camera, shadows);
    fixed_scene_.TraceShadows(light_.towards_in_camera, shadows);
    for (size_t i = 0; i < kPacketSize; ++i) {
      const int surface = packet.surface[i];
      if (surface < 0) {
        sum += background_grey_;
        continue;
      }
      const float paint = surface == fixed_.surface[pixel] ? fixed_.paint_grey[pixel]
                                                           : PaintGrey(moving, surface, shadows.origin[i]);
      sum += paint * light_.Share(packet.normal[i].dot(light_.towards_in_camera), !shadows.is_dark[i]);
    }
  }
  return sum / static_cast<float>(kSamples);
}

float SceneRenderer::PixelGrey(const Moving& moving, const PixelViews& views, int x, int y) const {
  const size_t pixel = IndexOf(x, y);
  if (!IsNearTouched(views, x, y)) return fixed_.mean_grey[pixel];
  return ShowsEdge(views, x, y) ? MeanOver(moving, x, y) : views.grey[pixel];
}

}  // namespace legible
