#include "core/rig/scene_renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace legible {
namespace {

constexpr float kFar_m = 1e9F;
constexpr int kRowsPerTask = 4;
constexpr int kNoKey = -1;
// Grey levels by which a pixel's middle may differ from the mean of two opposite neighbours; its own mean
// differs from its middle by a twelfth of that at most.
constexpr float kLargestBend_grey = 2;

// Places of the sight lines over a pixel: Korobov's lattice of 48 that is most even in all directions, moved
// as a whole by another amount in each pixel. The share of them on one side of a straight edge is off by
// 0.018 (rms; 0.032 for edges in the least even direction), and by nothing on average. Every third of them is
// a round: a lattice of 16.
constexpr size_t kRounds = 3, kSamples = kRounds * kPacketSize, kGenerator = 7;

Eigen::Vector2d SamplePlace(size_t sample, const Eigen::Vector2d& shift) {
  const auto part = [](size_t n) { return static_cast<double>(n) / kSamples; };
  const double right = part(sample) + shift.x(), down = part(sample * kGenerator % kSamples) + shift.y();
  return {right < 1 ? right : right - 1, down < 1 ? down : down - 1};
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
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsPerTask),
                    [&](const tbb::blocked_range<int>& rows) {
                      for (int y = rows.begin(); y < rows.end(); ++y) job(y);
                    });
}

}  // namespace

SceneRenderer::SceneRenderer(const Camera& camera, const SceneParts& room, const SceneParts& base,
                             const SceneLight& light, double background_grey, const Blotches& blotches)
    : lines_(camera),
      light_(light),
      background_grey_(static_cast<float>(background_grey)),
      blotches_(blotches),
      fixed_paints_(PaintsOf(room)),
      room_scene_(room, 0),
      base_scene_(base, static_cast<int>(fixed_paints_.size())),
      fixed_(IndexOf(0, camera.height_px)) {
  const std::vector<Paint> of_base = PaintsOf(base);
  fixed_paints_.insert(fixed_paints_.end(), of_base.begin(), of_base.end());
  PixelViews views(IndexOf(0, lines_.height()));
  ForEachRow(lines_.height(), [&](int y) { ViewFixed(y, views); });
  ForEachRow(lines_.height(), [&](int y) {
    FillRow({}, views, y, fixed_.mean_grey.data() + IndexOf(0, y));
    for (int x = 0; x < lines_.width(); ++x) {
      const size_t pixel = IndexOf(x, y);
      fixed_.is_even[pixel] = fixed_.surface[pixel] >= 0 && !HasOtherKeysAbout(views, x, y) ? 1 : 0;
    }
  });
}

BrightnessImage SceneRenderer::Render(const SceneParts& moving_parts) const {
  const RayScene scene(moving_parts, static_cast<int>(fixed_paints_.size()));
  const Moving moving{&scene, PaintsOf(moving_parts)};
  PixelViews views(IndexOf(0, lines_.height()));
  ForEachRow(lines_.height(), [&](int y) { ViewMoving(moving, y, views); });
  BrightnessImage image{lines_.width(), lines_.height(), std::vector<float>(views.grey.size())};
  ForEachRow(lines_.height(), [&](int y) { FillRow(moving, views, y, image.Row(y)); });
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
  SightPacket packet = {};
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
    room_scene_.Trace(packet);
    base_scene_.Trace(packet);
    ShadowPacket shadows = Shadows(packet);
    base_scene_.TraceShadows(light_.towards_in_camera, shadows);
    const size_t count = std::min(kPacketSize, static_cast<size_t>(lines_.width() - x));
    for (size_t i = 0; i < count; ++i) {
      const size_t pixel = IndexOf(x, y) + i;
      const int surface = packet.surface[i];
      const bool is_seen = surface >= 0, is_lit = is_seen && !shadows.is_dark[i];
      fixed_.depth[pixel] = packet.depth[i];
      fixed_.surface[pixel] = surface;
      fixed_.normal[pixel] = packet.normal[i];
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
    base_scene_.TraceShadows(light_.towards_in_camera, on_moving);
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

bool SceneRenderer::HasOtherKeysAbout(const PixelViews& views, int x, int y) const {
  const int key = views.key[IndexOf(x, y)];
  for (int row = std::max(0, y - 1); row <= std::min(lines_.height() - 1, y + 1); ++row)
    for (int column = std::max(0, x - 1); column <= std::min(lines_.width() - 1, x + 1); ++column)
      if (views.key[IndexOf(column, row)] != key) return true;
  return false;
}

// Whether the brightness of one surface bends so much that a pixel's middle does not stand for its mean.
bool SceneRenderer::Bends(const PixelViews& views, int x, int y) const {
  const size_t pixel = IndexOf(x, y);
  const auto bends = [&](size_t step) {
    const size_t before = pixel - step, after = pixel + step;
    return views.key[before] == views.key[pixel] && views.key[after] == views.key[pixel] &&
           std::abs(views.grey[before] + views.grey[after] - 2 * views.grey[pixel]) > 2 * kLargestBend_grey;
  };
  return (x > 0 && x + 1 < lines_.width() && bends(1)) ||
         (y > 0 && y + 1 < lines_.height() && bends(static_cast<size_t>(lines_.width())));
}

// Of the pixels from (x, y) on.
SceneRenderer::CornerKeys SceneRenderer::KeysAtCorners(const Moving& moving, int x, int y) const {
  SightPacket packet;
  for (size_t i = 0; i < kPacketSize; ++i) {
    const int column = std::min(x + static_cast<int>(i % (kPacketSize / 2)), lines_.width());
    const Eigen::Vector2d line = lines_.AtCorner(column, y + (i < kPacketSize / 2 ? 0 : 1));
    const bool is_seen = line.allFinite();
    packet.direction.Set(i, (is_seen ? line : Eigen::Vector2d(0, 0)).cast<float>().homogeneous());
    packet.depth[i] = is_seen ? kFar_m : 0;
    packet.surface[i] = -1;
  }
  room_scene_.Trace(packet);
  base_scene_.Trace(packet);
  if (moving.scene) moving.scene->Trace(packet);
  ShadowPacket shadows = Shadows(packet);
  base_scene_.TraceShadows(light_.towards_in_camera, shadows);
  if (moving.scene) moving.scene->TraceShadows(light_.towards_in_camera, shadows);
  CornerKeys corners;
  for (size_t i = 0; i < kPacketSize; ++i) corners.keys[i] = KeyOf(packet.surface[i], !shadows.is_dark[i]);
  return corners;
}

// The sight lines of one round through a pixel; where nothing that stands still ends there, what they meet of
// that is known: a surface as good as flat.
SightPacket SceneRenderer::SamplesOf(int x, int y, size_t round) const {
  const size_t pixel = IndexOf(x, y);
  const Eigen::Vector2d shift = SampleShift(pixel);
  const Eigen::Vector3f& normal = fixed_.normal[pixel];
  const float height =
      fixed_.depth[pixel] * normal.dot(lines_.At(x, y, 0.5, 0.5).cast<float>().homogeneous());
  const bool is_known = fixed_.is_even[pixel] != 0;
  SightPacket packet;
  for (size_t i = 0; i < kPacketSize; ++i) {
    const Eigen::Vector2d place = SamplePlace(kRounds * i + round, shift);
    packet.direction.Set(i, lines_.At(x, y, place.x(), place.y()).cast<float>().homogeneous());
    packet.depth[i] = is_known ? height / normal.dot(packet.direction[i]) : kFar_m;
    packet.surface[i] = is_known ? fixed_.surface[pixel] : -1;
    packet.normal.Set(i, normal);
  }
  return packet;
}

// Traces samples of a pixel and their shadows.
ShadowPacket SceneRenderer::Look(const Moving& moving, size_t pixel, SightPacket& packet) const {
  const bool is_known = fixed_.is_even[pixel] != 0;
  if (!is_known) {
    room_scene_.Trace(packet);
    base_scene_.Trace(packet);
  }
  if (moving.scene) moving.scene->Trace(packet);
  ShadowPacket shadows = Shadows(packet);
  const auto wanted = shadows.is_wanted;
  for (size_t i = 0; i < kPacketSize; ++i) {
    if (!is_known || !IsFixed(packet.surface[i])) continue;
    shadows.is_wanted[i] = false;
    shadows.is_dark[i] = fixed_.is_lit[pixel] == 0;
  }
  base_scene_.TraceShadows(light_.towards_in_camera, shadows);
  shadows.is_wanted = wanted;
  if (moving.scene) moving.scene->TraceShadows(light_.towards_in_camera, shadows);
  return shadows;
}

float SceneRenderer::SumOver(const Moving& moving, int x, int y, size_t round) const {
  const size_t pixel = IndexOf(x, y);
  SightPacket packet = SamplesOf(x, y, round);
  const ShadowPacket shadows = Look(moving, pixel, packet);
  float sum = 0;
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
  return sum;
}

float SceneRenderer::MeanOver(const Moving& moving, int x, int y, size_t rounds) const {
  float sum = 0;
  for (size_t round = 0; round < rounds; ++round) sum += SumOver(moving, x, y, round);
  return sum / static_cast<float>(rounds * kPacketSize);
}

// All rounds for what ends in the pixel, one for what bends there or begins to; none where the middle will
// do.
size_t SceneRenderer::RoundsFor(const PixelViews& views, int x, int y, bool shows_edge) const {
  if (shows_edge) return kRounds;
  const bool is_lit_leg = views.key[IndexOf(x, y)] % 2 == 1 && views.is_touched[IndexOf(x, y)] != 0;
  return Bends(views, x, y) || (is_lit_leg && HasOtherKeysAbout(views, x, y)) ? 1 : 0;
}

void SceneRenderer::FillRow(const Moving& moving, const PixelViews& views, int y, float* row) const {
  for (int start = 0; start < lines_.width(); start += kCornered) {
    std::optional<CornerKeys> corners;
    for (int x = start; x < std::min(start + kCornered, lines_.width()); ++x) {
      const size_t pixel = IndexOf(x, y);
      const bool is_new = !moving.scene || IsNearTouched(views, x, y);
      row[x] = is_new ? views.grey[pixel] : fixed_.mean_grey[pixel];
      if (!is_new || !lines_.HasImage(x, y)) continue;
      bool shows_edge = HasOtherKeysAbout(views, x, y);
      if (shows_edge) {
        if (!corners) corners = KeysAtCorners(moving, start, y);
        shows_edge = !corners->AreAll(static_cast<size_t>(x - start), views.key[pixel]);
      }
      const size_t rounds = RoundsFor(views, x, y, shows_edge);
      if (rounds > 0) row[x] = MeanOver(moving, x, y, rounds);
    }
  }
}

}  // namespace legible
