#include "core/vision/gray_image.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace legible {
namespace {

class GrayImageFile : public testing::Test {
 protected:
  GrayImageFile() {
    std::ifstream stream(LEGIBLE_SOURCE_DIR "/datasets/hexapod/images/000.png", std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
  }
  ~GrayImageFile() override { std::filesystem::remove(file_); }

  std::optional<GrayImage> ReadBack() const {
    std::ofstream(file_, std::ios::binary).write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    return ReadGrayImage(file_);
  }

  // Of a chunk's type and data, which end where the checksum stands.
  void SetChecksum(size_t first, size_t end) {
    const auto checksum =
        crc32(0, reinterpret_cast<const Bytef*>(bytes_.data() + first), static_cast<uInt>(end - first));
    for (size_t byte = 0; byte < 4; ++byte)
      bytes_[end + byte] = static_cast<char>(checksum >> (24 - 8 * byte));
  }

  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".png");
  std::vector<char> bytes_;
};

TEST_F(GrayImageFile, IsReadWithItsSize) {
  const auto image = ReadBack();
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 1280);
  EXPECT_EQ(image->height, 960);
  EXPECT_EQ(image->pixels.size(), 1280u * 960u);
}

// Wherever it is cut or changed: no image, and no line on stderr but this program's own.
TEST_F(GrayImageFile, ThatIsDamagedIsNoImageAndPrintsNothing) {
  const std::vector<char> whole = bytes_;
  testing::internal::CaptureStderr();
  for (const size_t length : {size_t{0}, size_t{7}, size_t{20}, whole.size() / 2, whole.size() - 1}) {
    bytes_.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(ReadBack()) << length;
  }
  for (const size_t place : {size_t{9}, size_t{17}, size_t{40}, whole.size() / 3, whole.size() - 20}) {
    bytes_ = whole;
    bytes_[place] = static_cast<char>(bytes_[place] ^ 0x55);
    EXPECT_FALSE(ReadBack()) << place;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// The checksums of the chunks can be right, and what the pixels are packed in wrong all the same.
TEST_F(GrayImageFile, WhosePixelsCannotBeUnpackedIsNoImageAndPrintsNothing) {
  const auto big_endian = [&](size_t at) {
    std::uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes_[at + i]);
    return value;
  };
  size_t chunk = 8;
  while (std::string(bytes_.data() + chunk + 4, 4) != "IDAT") chunk += 12 + big_endian(chunk);
  const size_t length = big_endian(chunk);
  for (size_t i = length / 2; i < length / 2 + 40; ++i) bytes_[chunk + 8 + i] = '\xff';
  SetChecksum(chunk + 4, chunk + 8 + length);
  testing::internal::CaptureStderr();
  EXPECT_FALSE(ReadBack());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// OpenCV has a limit of its own, beyond which it throws.
TEST_F(GrayImageFile, ThatClaimsToBeHugeIsNoImage) {
  constexpr size_t kHeader = 12, kHeaderEnd = 29;  // type and data of the first chunk
  for (size_t byte = 16; byte < 24; ++byte) bytes_[byte] = byte % 4 == 1 ? 1 : 0;  // 65536 x 65536
  SetChecksum(kHeader, kHeaderEnd);
  EXPECT_FALSE(ReadBack());
}

TEST_F(GrayImageFile, OfAJpegIsReadWholeOrNotAtAll) {
  const cv::Mat picture(120, 160, CV_8UC1, cv::Scalar(90));
  std::vector<std::uint8_t> jpeg;
  ASSERT_TRUE(cv::imencode(".jpg", picture, jpeg));
  bytes_.assign(jpeg.begin(), jpeg.end());
  EXPECT_TRUE(ReadBack());
  bytes_.insert(bytes_.end(), 100, '\0');  // as some cameras append
  EXPECT_TRUE(ReadBack());
  for (const size_t length : {jpeg.size() / 2, jpeg.size() - 2}) {
    bytes_.assign(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(ReadBack()) << length;
  }
}

TEST_F(GrayImageFile, ThatIsNotThereIsNoImage) { EXPECT_FALSE(ReadGrayImage(file_ / "none.png")); }

}  // namespace
}  // namespace legible
