#include "tests/testing/board_of_camera.h"

#include <random>
#include <string>

#include "core/vision/board_detection.h"
#include "tests/testing/render_board.h"

namespace legible {
namespace {

constexpr double kTag_m = 0.03, kGap_m = 0.009;
constexpr double kSize_m = 6 * kTag_m + 5 * kGap_m;

// The views' middles go round a grid over the image, their tilts round the compass.
Rigid3 PoseOf(const Camera& camera, int view) {
  const Eigen::Vector2d share(0.25 + 0.25 * (view % 3), 0.3 + 0.2 * (view / 3 % 3));
  const Eigen::Vector2d x =
      Unproject(camera, share.cwiseProduct(Eigen::Vector2d(camera.width_px, camera.height_px))).value();
  const double shown_px = camera.height_px * (view % 2 == 0 ? 0.75 : 0.55);
  const double depth_m = kSize_m * camera.fx_px / shown_px;
  const double tilt_rad = view % 4 == 0 ? 0.1 : 0.45 + 0.25 * (view % 3) / 2;
  return BoardPose(tilt_rad, 2.4 * view, 0.4 * (view % 5 - 2), depth_m * x.homogeneous());
}

}  // namespace

Board SixBySixTags() { return {"board", TagGrid("tag36h11", 6, 6, kTag_m, kGap_m), std::nullopt}; }

std::vector<GrayImage> RenderViewsOfBoard(const Camera& camera, int views) {
  std::mt19937_64 generator(31);
  std::vector<GrayImage> images;
  images.reserve(static_cast<size_t>(views));
  for (int view = 0; view < views; ++view)
    images.push_back(WithNoise(RenderBoard(SixBySixTags(), camera, PoseOf(camera, view)), 2, generator));
  return images;
}

CameraByBoard CalibrateByRenderedBoard(const Camera& camera, int views) {
  const Board board = SixBySixTags();
  const BoardDetector detector(board);
  CameraByBoard found;
  found.input = {PointsOf(board), {}, camera.width_px, camera.height_px};
  for (const GrayImage& image : RenderViewsOfBoard(camera, views))
    found.input.views.push_back(
        {std::to_string(found.input.views.size()), {}, detector.Detect(image).corners});
  found.options.lens = camera.lens;
  found.result = CalibrateCamera(found.input, found.options);
  return found;
}

}  // namespace legible
