#include "apps/report_pictures.h"

#include <openssl/evp.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace legible {
namespace {

constexpr int kJpegQuality = 80;

std::string Base64(const std::vector<unsigned char>& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP_EncodeBlock ends with a zero
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                                   static_cast<int>(bytes.size()));
  text.resize(static_cast<size_t>(size));
  return text;
}

std::string EmbedPixels(const cv::Mat& image) {
  std::vector<unsigned char> jpeg;
  if (image.empty() || !cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality}))
    return "";
  return "data:image/jpeg;base64," + Base64(jpeg);
}

std::string EmbedPicture(const std::filesystem::path& file) {
  return EmbedPixels(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
}

}  // namespace

std::string EmbedPicture(const GrayImage& image) {
  return EmbedPixels(
      cv::Mat(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())));
}

std::vector<std::string> EmbedPictures(const std::vector<std::filesystem::path>& files, int threads) {
  std::vector<std::string> pictures(files.size());
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, files.size(), [&](size_t i) { pictures[i] = EmbedPicture(files[i]); });
  });
  return pictures;
}

}  // namespace legible
