#include "core/vision/gray_image.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace legible {
namespace {

GrayImage FromMat(const cv::Mat& mat) {
  GrayImage image{mat.cols, mat.rows, std::vector<std::uint8_t>(mat.total())};
  mat.copyTo(cv::Mat(mat.rows, mat.cols, CV_8UC1, image.pixels.data()));
  return image;
}

using Bytes = std::vector<std::uint8_t>;

std::uint32_t BigEndian(const Bytes& bytes, size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | bytes[at + 3];
}

bool IsPng(const Bytes& bytes) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return bytes.size() >= 8 && std::memcmp(bytes.data(), kSignature, 8) == 0;
}

// Unpacks a zlib stream that comes in pieces, for nothing but to see whether it is whole.
class InflateTrial {
 public:
  InflateTrial() { is_whole_so_far_ = inflateInit(&stream_) == Z_OK; }
  ~InflateTrial() { inflateEnd(&stream_); }
  InflateTrial(const InflateTrial&) = delete;
  InflateTrial& operator=(const InflateTrial&) = delete;

  void Feed(const std::uint8_t* bytes, size_t count) {
    stream_.next_in = const_cast<Bytef*>(bytes);
    stream_.avail_in = static_cast<uInt>(count);
    while (is_whole_so_far_ && !has_ended_ && stream_.avail_in > 0) {
      stream_.next_out = unpacked_.data();
      stream_.avail_out = static_cast<uInt>(unpacked_.size());
      const int result = inflate(&stream_, Z_NO_FLUSH);
      has_ended_ = result == Z_STREAM_END;
      is_whole_so_far_ = has_ended_ || result == Z_OK;
    }
  }
  bool IsWhole() const { return is_whole_so_far_ && has_ended_; }

 private:
  z_stream stream_ = {};
  Bytes unpacked_ = Bytes(1 << 16);
  bool is_whole_so_far_ = true, has_ended_ = false;
};

// Whether every chunk up to the end's is whole, and so is what the pixels are packed in. libpng would print
// its own line to stderr where one is not.
bool IsIntactPng(const Bytes& bytes) {
  constexpr size_t kFrame = 12;  // of a chunk: length, type, checksum
  InflateTrial pixels;
  for (size_t at = 8; at + kFrame <= bytes.size();) {
    const size_t length = BigEndian(bytes, at);
    if (length > bytes.size() - at - kFrame) return false;
    const std::uint8_t* const type = bytes.data() + at + 4;
    if (crc32(0, type, static_cast<uInt>(length + 4)) != BigEndian(bytes, at + 8 + length)) return false;
    if (std::memcmp(type, "IEND", 4) == 0) return pixels.IsWhole();
    if (std::memcmp(type, "IDAT", 4) == 0) pixels.Feed(type + 4, length);
    at += kFrame + length;
  }
  return false;
}

// A JPEG that breaks off would be filled up with grey. Cameras may append some bytes of their own to its end.
bool IsTruncatedJpeg(const Bytes& bytes) {
  constexpr std::uint8_t kStart[] = {0xff, 0xd8}, kEnd[] = {0xff, 0xd9};
  constexpr std::ptrdiff_t kAppended = 4096;
  if (bytes.size() < 2 || std::memcmp(bytes.data(), kStart, 2) != 0) return false;
  const auto from = bytes.end() - std::min(kAppended, std::ssize(bytes));
  return std::search(from, bytes.end(), std::begin(kEnd), std::end(kEnd)) == bytes.end();
}

// Empty where it cannot be decoded; OpenCV throws where it claims to be too large.
cv::Mat Decoded(const Bytes& bytes) {
  try {
    return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

std::optional<GrayImage> ReadGrayImage(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
  if (bytes.empty() || (IsPng(bytes) && !IsIntactPng(bytes)) || IsTruncatedJpeg(bytes)) return std::nullopt;
  const cv::Mat mat = Decoded(bytes);
  if (mat.empty()) return std::nullopt;
  return FromMat(mat);
}

std::string EncodePng(const GrayImage& image) {
  const cv::Mat pixels(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", pixels, bytes))
    throw std::runtime_error("EncodePng: the image cannot be encoded");
  return {bytes.begin(), bytes.end()};
}

GrayImage Blurred(const GrayImage& image, double sigma_px) {
  const cv::Mat source(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat blurred;
  cv::GaussianBlur(source, blurred, cv::Size(), sigma_px);
  return FromMat(blurred);
}

}  // namespace legible
