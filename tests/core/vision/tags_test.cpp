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
#include <map>
#include <opencv2/aruco.hpp>
#include <random>
#include <stdexcept>

#include "datasets/synthetic_session.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/render_board.h"

namespace legible {
namespace {

constexpr double kTag_m = 0.06;  // across the black border

Tag SquareTag(int id, const Eigen::Vector3d& centre_m) {
  constexpr double h = kTag_m / 2;
  return {id,
          {centre_m + Eigen::Vector3d(-h, -h, 0), centre_m + Eigen::Vector3d(h, -h, 0),
           centre_m + Eigen::Vector3d(h, h, 0), centre_m + Eigen::Vector3d(-h, h, 0)}};
}

TagGroup TwoTags() {
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

Camera SmallCamera() {
  Camera camera = DesktopCamera(true);
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 1000;
  camera.cx_px = 310;
  camera.cy_px = 250;
  return camera;
}

GrayImage RenderGroup(const Camera& camera, std::mt19937_64& generator) {
  const Board board{"board", TagBoard{"tag36h11", 1, false, TwoTags().tags}, std::nullopt};
  return WithNoise(RenderBoard(board, camera, TruePose()), 2, generator);
}

TEST(TagDetector, FindsTheCornersOfRenderedTagsInThisPixelConvention) {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = SmallCamera();
  const std::vector<TagDetection> found = TagDetector("tag36h11").Detect(RenderGroup(camera, generator));
  ASSERT_EQ(found.size(), 2);
  for (const Tag& tag : TwoTags().tags) {
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
  for (const Tag& tag : TwoTags().tags) {
    TagDetection detection{tag.id, {}};
    for (size_t i = 0; i < 4; ++i) detection.corners_px[i] = Project(camera, TruePose() * tag.corners_m[i]);
    detections.push_back(detection);
  }
  return detections;
}

TEST(LocateGroup, RecoversThePoseOfExactCorners) {
  const Camera camera = SmallCamera();
  const auto found = LocateGroup(camera, Match(TwoTags(), ExactDetections(camera)));
  ASSERT_TRUE(found);
  EXPECT_TRUE(AreNear(Displacement(TruePose(), found->camera_from_group), Vector6d::Zero(), 1e-6));
  EXPECT_LT(found->rms_px, 1e-3);
}

TEST(LocateGroup, RecoversThePoseOfARenderedBoard) {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = SmallCamera();
  const auto detections = TagDetector("tag36h11").Detect(RenderGroup(camera, generator));
  const auto found = LocateGroup(camera, Match(TwoTags(), detections));
  ASSERT_TRUE(found);
  const Vector6d error = Displacement(TruePose(), found->camera_from_group);
  EXPECT_LT(error.head<3>().norm(), 1e-3);
  EXPECT_LT(error.tail<3>().norm(), 5e-3);
  EXPECT_LT(found->rms_px, 0.1);
}

TEST(LocateGroup, HasNoPoseWithoutItsTags) {
  const Camera camera = SmallCamera();
  EXPECT_FALSE(LocateGroup(camera, Match(TwoTags(), {})));
}

TEST(Match, TakesOnlyTheGroupsOwnTags) {
  const Camera camera = SmallCamera();
  std::vector<TagDetection> detections = ExactDetections(camera);
  detections[0].id = 99;
  EXPECT_EQ(Match(TwoTags(), detections).corners_px.size(), 4);
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

// The same tags drawn by cv::aruco, whose pictures are upside down compared with libapriltag's.
TEST(TagPicture, WithAWideBorderIsThatOfAruco) {
  const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME> dictionaries = {
      {"tag16h5", cv::aruco::DICT_APRILTAG_16h5},
      {"tag25h9", cv::aruco::DICT_APRILTAG_25h9},
      {"tag36h10", cv::aruco::DICT_APRILTAG_36h10},
      {"tag36h11", cv::aruco::DICT_APRILTAG_36h11},
  };
  for (const std::string& family : kWideBorderFamilies) {
    const TagDetector detector(family, {.decimation = 1, .border_bits = 2});
    const auto dictionary = cv::aruco::getPredefinedDictionary(dictionaries.at(family));
    for (const int id : {0, 1, 17, 29}) {
      const TagPicture picture = detector.PictureOf(id);
      cv::Mat drawn;
      cv::aruco::drawMarker(dictionary, id, picture.modules, drawn, 2);
      cv::rotate(drawn, drawn, cv::ROTATE_180);
      for (int at = 0; at < picture.modules * picture.modules; ++at)
        EXPECT_EQ(picture.is_light[static_cast<size_t>(at)],
                  drawn.at<std::uint8_t>(at / picture.modules, at % picture.modules) > 0)
            << family << " " << id << " " << at;
    }
  }
}

// Kalibr draws bit 6 i + j of the code, light where it is 1, in row i and column j counted from the
// bottom-right of the tag (kalibr_create_target_pdf: rotation = 2); tag 0 is 0xd5d628584.
TEST(TagPicture, WithATwoBitBorderIsWhatKalibrPrints) {
  const TagPicture picture = TagDetector("tag36h11", {.decimation = 1, .border_bits = 2}).PictureOf(0);
  ASSERT_EQ(picture.modules, 10);
  EXPECT_EQ(picture.ring, 0);
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 10; ++column) {
      const int i = 7 - row, j = 7 - column;
      const bool is_code = i >= 0 && i < 6 && j >= 0 && j < 6;
      EXPECT_EQ(picture.is_light[static_cast<size_t>(10 * row + column)],
                is_code && (0xd5d628584 >> (6 * i + j) & 1) == 1)
          << row << " " << column;
    }
}

TEST(TagDetector, RefusesWideBordersThatNobodyReads) {
  EXPECT_THROW(TagDetector("tagStandard41h12", {.decimation = 1, .border_bits = 2}), std::invalid_argument);
  EXPECT_THROW(TagDetector("tag36h11").PictureOf(587), std::invalid_argument);
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
