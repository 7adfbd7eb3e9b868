#include "core/vision/tags.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>

#include "datasets/synthetic_session.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/render_legs.h"

namespace legible {
namespace {

constexpr double kTag_m = 0.06;  // across the black border

Tag SquareTag(int id, const Eigen::Vector3d& centre_m) {
  constexpr double h = kTag_m / 2;
  return {id,
          {centre_m + Eigen::Vector3d(-h, -h, 0), centre_m + Eigen::Vector3d(h, -h, 0),
           centre_m + Eigen::Vector3d(h, h, 0), centre_m + Eigen::Vector3d(-h, h, 0)}};
}

TagGroup Board() {
  TagGroup group;
  group.name = "board";
  group.tags = {SquareTag(3, {-0.06, 0, 0}), SquareTag(7, {0.06, 0.02, 0})};
  return group;
}

// A board before the camera, its x to the right and its y up in the image, turned by some tens of degrees.
Rigid3 TruePose() {
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  return {RotationFromVector({0.3, -0.4, 0.2}) * facing, {0.02, -0.03, 0.6}};
}

// libapriltag's own picture of a tag, one pixel a module, row by row, with its white border.
struct TagPicture {
  int modules = 0, modules_of_border = 0;  // across the picture, across the black border
  std::vector<std::uint8_t> grey;
};

TagPicture DrawTag(int id) {
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* image = apriltag_to_image(family, static_cast<uint32_t>(id));
  TagPicture picture{image->width, family->width_at_border, {}};
  for (int row = 0; row < image->height; ++row)
    picture.grey.insert(picture.grey.end(), image->buf + row * image->stride,
                        image->buf + row * image->stride + image->width);
  std::free(image->buf);  // the library does not export image_u8_destroy
  std::free(image);
  tag36h11_destroy(family);
  return picture;
}

// Brightness of a board of tags at places of its plane.
class BoardPicture {
 public:
  explicit BoardPicture(const TagGroup& group) : group_(group) {
    for (const Tag& tag : group.tags) pictures_.push_back(DrawTag(tag.id));
  }

  double At(const Eigen::Vector2d& place_m) const {
    for (size_t i = 0; i < pictures_.size(); ++i) {
      const TagPicture& picture = pictures_[i];
      const auto& corners_m = group_.tags[i].corners_m;
      const Eigen::Vector2d centre = (corners_m[0] + corners_m[2]).head<2>() / 2;
      const Eigen::Vector2d module = (place_m - centre) / kTag_m * picture.modules_of_border;
      const double column = picture.modules / 2.0 + module.x(), row = picture.modules / 2.0 - module.y();
      if (std::min(column, row) < 0 || std::max(column, row) >= picture.modules) continue;
      const int at = static_cast<int>(row) * picture.modules + static_cast<int>(column);
      return picture.grey[static_cast<size_t>(at)] > 0 ? 220 : 30;
    }
    return 220;
  }

 private:
  const TagGroup& group_;
  std::vector<TagPicture> pictures_;
};

GrayImage RenderBoard(const Camera& camera, std::mt19937_64& generator) {
  const TagGroup board = Board();
  const BoardPicture picture(board);
  const Rigid3 group_from_camera = Inverse(TruePose());
  CleanImage image{camera.width_px, camera.height_px, {}};
  constexpr int kSide = 4;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      double sum = 0;
      for (int ray = 0; ray < kSide * kSide; ++ray) {
        const int row = ray / kSide, column = ray % kSide;
        const Eigen::Vector2d offset((column + 0.5) / kSide - 0.5, (row + 0.5) / kSide - 0.5);
        const Eigen::Vector3d sight = Unproject(camera, Eigen::Vector2d(x, y) + offset).value().homogeneous();
        const Eigen::Vector3d direction = group_from_camera.rotation * sight;
        const double depth = -group_from_camera.translation.z() / direction.z();
        sum += picture.At((group_from_camera.translation + depth * direction).head<2>());
      }
      image.grey.push_back(static_cast<float>(sum / (kSide * kSide)));
    }
  cv::Mat mat(image.height, image.width, CV_32FC1, image.grey.data());
  cv::GaussianBlur(mat, mat, cv::Size(), 0.7);  // as a lens would
  return WithNoise(image, 2, generator);
}

Camera SmallCamera() {
  Camera camera = DesktopCamera(true);
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 1000;
  camera.cx_px = 310;
  camera.cy_px = 250;
  return camera;
}

TEST(TagDetector, FindsTheCornersOfRenderedTagsInThisPixelConvention) {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = SmallCamera();
  const std::vector<TagDetection> found = TagDetector("tag36h11").Detect(RenderBoard(camera, generator));
  ASSERT_EQ(found.size(), 2);
  for (const Tag& tag : Board().tags) {
    const auto detection =
        std::find_if(found.begin(), found.end(), [&](const TagDetection& d) { return d.id == tag.id; });
    ASSERT_NE(detection, found.end());
    for (size_t corner = 0; corner < 4; ++corner)
      EXPECT_TRUE(
          AreNear(detection->corners_px[corner], Project(camera, TruePose() * tag.corners_m[corner]), 0.1));
  }
}

TEST(TagDetector, FindsNothingInAnEmptyImage) {
  const GrayImage image{200, 200, std::vector<std::uint8_t>(40000, 100)};
  EXPECT_TRUE(TagDetector("tag36h11").Detect(image).empty());
}

TEST(TagDetector, RejectsAnUnknownFamilyAndNamesTheKnown) {
  try {
    const TagDetector detector("tag99h1");
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("tag36h11"), std::string::npos) << error.what();
  }
}

std::vector<TagDetection> ExactDetections(const Camera& camera) {
  std::vector<TagDetection> detections;
  for (const Tag& tag : Board().tags) {
    TagDetection detection{tag.id, {}};
    for (size_t i = 0; i < 4; ++i) detection.corners_px[i] = Project(camera, TruePose() * tag.corners_m[i]);
    detections.push_back(detection);
  }
  return detections;
}

TEST(LocateGroup, RecoversThePoseOfExactCorners) {
  const Camera camera = SmallCamera();
  const auto found = LocateGroup(camera, Match(Board(), ExactDetections(camera)));
  ASSERT_TRUE(found);
  EXPECT_TRUE(AreNear(Displacement(TruePose(), found->camera_from_group), Vector6d::Zero(), 1e-6));
  EXPECT_LT(found->rms_px, 1e-3);
}

TEST(LocateGroup, RecoversThePoseOfARenderedBoard) {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = SmallCamera();
  const auto detections = TagDetector("tag36h11").Detect(RenderBoard(camera, generator));
  const auto found = LocateGroup(camera, Match(Board(), detections));
  ASSERT_TRUE(found);
  const Vector6d error = Displacement(TruePose(), found->camera_from_group);
  EXPECT_LT(error.head<3>().norm(), 1e-3);
  EXPECT_LT(error.tail<3>().norm(), 5e-3);
  EXPECT_LT(found->rms_px, 0.1);
}

TEST(LocateGroup, HasNoPoseWithoutItsTags) {
  const Camera camera = SmallCamera();
  EXPECT_FALSE(LocateGroup(camera, Match(Board(), {})));
}

TEST(Match, TakesOnlyTheGroupsOwnTags) {
  const Camera camera = SmallCamera();
  std::vector<TagDetection> detections = ExactDetections(camera);
  detections[0].id = 99;
  EXPECT_EQ(Match(Board(), detections).corners_px.size(), 4);
}

TEST(TagDetector, KnowsEveryFamilyThatASessionMayName) {
  try {
    TagDetector detector("none of them");
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const TagFamily& family : kTagFamilies)
      EXPECT_NE(std::string(error.what()).find(family.name), std::string::npos) << family.name;
  }
}

TEST(TagFamilies, HaveAsManyTagsAsLibapriltagHas) {
  struct Made {
    const char* name;
    apriltag_family_t* (*create)();
    void (*destroy)(apriltag_family_t*);
  };
  const std::vector<Made> all = {
      {"tag36h11", tag36h11_create, tag36h11_destroy},
      {"tag36h10", tag36h10_create, tag36h10_destroy},
      {"tag25h9", tag25h9_create, tag25h9_destroy},
      {"tag16h5", tag16h5_create, tag16h5_destroy},
      {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
      {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
      {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
      {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
      {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
  };
  ASSERT_EQ(all.size(), kTagFamilies.size());
  for (size_t i = 0; i < all.size(); ++i) {
    apriltag_family_t* family = all[i].create();
    EXPECT_EQ(kTagFamilies[i].name, all[i].name);
    EXPECT_EQ(kTagFamilies[i].tags, static_cast<int>(family->ncodes)) << all[i].name;
    all[i].destroy(family);
  }
}

}  // namespace
}  // namespace legible
