#include "core/vision/layout_tags.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/testing/random.h"
#include "tests/testing/render_board.h"

namespace legible {
namespace {

// A lens that the detector knows nothing of.
Camera DistortedCamera() {
  Camera camera;
  camera.width_px = 1280;
  camera.height_px = 960;
  camera.fx_px = camera.fy_px = 1100;
  camera.cx_px = 630;
  camera.cy_px = 490;
  camera.distortion << -0.22, 0.08, 0.0006, -0.0004, 0, 0, 0, 0;
  return camera;
}

// Four tags of 38 mm in a row, as a session has them on its base.
TagGroup Row() {
  TagGroup group;
  group.name = "row";
  group.tags = TagGrid("tag36h11", 4, 1, 0.038, 0.0114).tags;
  return group;
}

GrayImage ImageOf(const TagGroup& group, const Rigid3& pose, std::mt19937_64& generator) {
  const Board board{"row", TagBoard{"tag36h11", 1, false, group.tags}, std::nullopt};
  return WithNoise(RenderBoard(board, DistortedCamera(), pose), 2, generator);
}

// Tilted by up to 45 degrees, wholly inside the image.
Rigid3 RandomPose(std::mt19937_64& generator) {
  const double depth_m = Uniform(generator, 0.4, 0.75);
  return BoardPose(
      Uniform(generator, 0, M_PI / 4), Uniform(generator, -M_PI, M_PI), Uniform(generator, -M_PI, M_PI),
      {depth_m * Uniform(generator, -0.15, 0.15), depth_m * Uniform(generator, -0.1, 0.1), depth_m});
}

bool IsLibrarys(const Eigen::Matrix2d& covariance_px2) {
  return covariance_px2 == TagDetection::LibraryCovariances_px2()[0];
}

struct Errors {
  int corners = 0, fitted = 0;
  double squares_px2 = 0, normalised_squares = 0;

  double Rms_px() const { return std::sqrt(squares_px2 / (2 * corners)); }
  double Normalised() const { return normalised_squares / (2 * corners); }
};

void Add(const std::vector<TagDetection>& detections, const TagGroup& group, const Rigid3& pose,
         Errors& errors) {
  for (const TagDetection& detection : detections)
    for (const Tag& tag : group.tags)
      for (size_t k = 0; tag.id == detection.id && k < 4; ++k) {
        const Eigen::Vector2d error_px =
            detection.corners_px[k] - Project(DistortedCamera(), pose * tag.corners_m[k]);
        errors.squares_px2 += error_px.squaredNorm();
        errors.normalised_squares += error_px.dot(detection.covariances_px2[k].inverse() * error_px);
        errors.fitted += IsLibrarys(detection.covariances_px2[k]) ? 0 : 1;
        ++errors.corners;
      }
}

// At a blur of 0.8 px and a noise of 2 grey levels.
TEST(LayoutTagDetector, FitsCornersBetterThanLibapriltagAndSaysHowWell) {
  std::mt19937_64 generator = TestGenerator();
  const LayoutTagDetector detector({"tag36h11", {Row()}});
  const TagDetector library("tag36h11");
  constexpr int kImages = 15;
  Errors fitted, found;
  for (int i = 0; i < kImages; ++i) {
    const Rigid3 pose = RandomPose(generator);
    const GrayImage image = ImageOf(Row(), pose, generator);
    Add(detector.Detect(image), Row(), pose, fitted);
    Add(library.Detect(image), Row(), pose, found);
  }
  std::cout << "rms " << fitted.Rms_px() << " px, libapriltag's " << found.Rms_px()
            << " px; normalised squares " << fitted.Normalised() << "; " << fitted.fitted << " of "
            << fitted.corners << " fitted" << std::endl;
  EXPECT_GE(fitted.corners, kImages * 4 * 4 * 0.98);
  EXPECT_EQ(fitted.corners, found.corners);
  EXPECT_GE(fitted.fitted, 0.99 * fitted.corners);
  EXPECT_LT(fitted.Rms_px(), 0.03);
  EXPECT_LT(fitted.Rms_px(), 0.5 * found.Rms_px());
  EXPECT_LT(found.Rms_px(), kLibraryCornerSigma_px);
  EXPECT_NEAR(fitted.Normalised(), 1, 0.3);
}

// Of a tag whose left side lies so near to the image's border that what surrounds it is not seen.
TEST(LayoutTagDetector, LeavesCornersThatCannotBeFittedToLibapriltagWithItsSigma) {
  std::mt19937_64 generator = TestGenerator();
  TagGroup one;
  one.tags = TagGrid("tag36h11", 1, 1, 0.038, 0.0114).tags;
  const auto pose_at = [](double x_m) { return BoardPose(0, 0, 0, {x_m, 0, 0.4}); };
  double x_m = 0;
  while (Project(DistortedCamera(), pose_at(x_m) * one.tags[0].corners_m[0]).x() > 4) x_m -= 1e-4;
  const GrayImage image = ImageOf(one, pose_at(x_m), generator);
  const std::vector<TagDetection> found = TagDetector("tag36h11").Detect(image);
  const std::vector<TagDetection> fitted = LayoutTagDetector({"tag36h11", {one}}).Detect(image);
  ASSERT_EQ(found.size(), 1);
  ASSERT_EQ(fitted.size(), 1);
  for (const size_t left : {0, 3}) {
    EXPECT_TRUE(IsLibrarys(fitted[0].covariances_px2[left]));
    EXPECT_EQ(fitted[0].corners_px[left], found[0].corners_px[left]);
  }
  for (const size_t right : {1, 2}) EXPECT_FALSE(IsLibrarys(fitted[0].covariances_px2[right]));
}

// A tag beside the layout's, of another id.
TEST(LayoutTagDetector, LeavesOtherTagsAsLibapriltagHasThem) {
  std::mt19937_64 generator = TestGenerator();
  TagLayout layout{"tag36h11", {Row()}};
  const int foreign = layout.groups[0].tags.back().id;
  layout.groups[0].tags.pop_back();
  const GrayImage image = ImageOf(Row(), BoardPose(0.3, 1, 0.2, {0, 0, 0.5}), generator);
  const std::vector<TagDetection> detections = LayoutTagDetector(layout).Detect(image);
  EXPECT_EQ(detections.size(), 4);
  for (const TagDetection& detection : detections)
    for (const Eigen::Matrix2d& covariance_px2 : detection.covariances_px2)
      EXPECT_EQ(IsLibrarys(covariance_px2), detection.id == foreign) << detection.id;
}

TEST(LayoutTagDetector, FindsNothingInAnEmptyImage) {
  const GrayImage image{200, 200, std::vector<std::uint8_t>(40000, 100)};
  EXPECT_TRUE(LayoutTagDetector({"tag36h11", {Row()}}).Detect(image).empty());
}

}  // namespace
}  // namespace legible
