#include "core/vision/gray_image.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace legible {
namespace {

GrayImage FromMat(const cv::Mat& mat) {
  GrayImage image{mat.cols, mat.rows, std::vector<std::uint8_t>(mat.total())};
  mat.copyTo(cv::Mat(mat.rows, mat.cols, CV_8UC1, image.pixels.data()));
  return image;
}

}  // namespace

std::optional<GrayImage> ReadGrayImage(const std::filesystem::path& file) {
  const cv::Mat mat = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (mat.empty()) return std::nullopt;
  return FromMat(mat);
}

GrayImage Blurred(const GrayImage& image, double sigma_px) {
  const cv::Mat source(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat blurred;
  cv::GaussianBlur(source, blurred, cv::Size(), sigma_px);
  return FromMat(blurred);
}

}  // namespace legible
