#include "tests/testing/render_scene.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace legible {
namespace {

constexpr int kFine = 4;  // fine pixels across a pixel: blurred before the pixels are filled
constexpr int kRays = 13,
              kGenerator = 8;  // Fibonacci's lattice of rays in a fine pixel, even on both sides of an edge

// Where a ray of a fine pixel goes, in pixels from the pixel's centre.
Eigen::Vector2d PlaceInPixel(int column, int row, int ray) {
  const Eigen::Vector2d in_fine(ray + 0.5, ray * kGenerator % kRays + 0.5);
  return (Eigen::Vector2d(column, row) + in_fine / kRays) / kFine - Eigen::Vector2d(0.5, 0.5);
}

// Fills the fine pixels of one pixel.
void FillPixel(const RenderedScene& scene, const Camera& camera, double background, int x, int y,
               cv::Mat& fine) {
  cv::Mat block = fine(cv::Rect(kFine * x, kFine * y, kFine, kFine));
  const auto centre = Unproject(camera, {x, y});
  if (!centre || !scene.VariesInPixel(*centre, 1 / camera.fx_px)) {
    block = centre ? scene.Brightness(*centre) : background;
    return;
  }
  const Eigen::Matrix2d d_pixel =
      Eigen::Vector2d(camera.fx_px, camera.fy_px).asDiagonal() *
      DistortWithJacobians(camera.lens, camera.distortion, *centre).d_point_d_undistorted;
  const Eigen::Matrix2d d_undistorted = d_pixel.inverse();
  for (int row = 0; row < kFine; ++row)
    for (int column = 0; column < kFine; ++column) {
      double sum = 0;
      for (int ray = 0; ray < kRays; ++ray)
        sum += scene.Brightness(*centre + d_undistorted * PlaceInPixel(column, row, ray));
      block.at<float>(row, column) = static_cast<float>(sum / kRays);
    }
}

}  // namespace

CleanImage RenderScene(const RenderedScene& scene, const Camera& camera, double background, double blur_px) {
  cv::Mat fine(kFine * camera.height_px, kFine * camera.width_px, CV_32FC1);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) FillPixel(scene, camera, background, x, y, fine);
  cv::GaussianBlur(fine, fine, cv::Size(), kFine * blur_px);
  CleanImage image{camera.width_px, camera.height_px, {}};
  image.grey.resize(static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px));
  cv::Mat mat(image.height, image.width, CV_32FC1, image.grey.data());
  cv::resize(fine, mat, mat.size(), 0, 0, cv::INTER_AREA);  // the mean of each pixel's fine pixels
  return image;
}

GrayImage WithNoise(const CleanImage& clean, double sigma_grey, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  GrayImage image{clean.width, clean.height, {}};
  for (const float grey : clean.grey)
    image.pixels.push_back(
        static_cast<std::uint8_t>(std::clamp(std::lround(grey + sigma_grey * normal(generator)), 0L, 255L)));
  return image;
}

}  // namespace legible
