#include "calib/tag_weights.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

std::vector<TagErrors> NormalErrors(std::mt19937_64& generator, size_t count, double scale) {
  std::normal_distribution<double> normal(0, scale);
  std::vector<TagErrors> tags(count);
  for (TagErrors& tag : tags)
    for (double& error : tag.error) error = normal(generator);
  return tags;
}

TEST(TagScale, IsThatOfTheCornersWhetherOrNotSomeTagsAreMisread) {
  std::mt19937_64 generator = TestGenerator();
  std::vector<TagErrors> tags = NormalErrors(generator, 500, 0.7);
  for (size_t i = 0; i < 50; ++i) tags[i].error.setConstant(120);
  WeighTags(tags, MedianTagScale(tags));
  EXPECT_NEAR(TagScale(tags, 1), 0.7, 0.05);
  for (size_t i = 0; i < tags.size(); ++i) EXPECT_EQ(tags[i].weight, i < 50 ? 0 : 1) << i;
}

// Eight rows of one sigma beside the tag's own eight, of which its place takes six.
TEST(TagScale, OfASingleTagIsDrawnTowardsOne) {
  std::vector<TagErrors> tags(1);
  tags[0].error.setZero();
  EXPECT_NEAR(TagScale(tags, 1), std::sqrt(8.0 / 10), 1e-12);
  tags[0].error.setConstant(2);
  EXPECT_NEAR(TagScale(tags, 1), std::sqrt((8 + 8 * 4) / 10.0), 1e-12);
}

TEST(MedianCorners, AreNotMovedByAMisreadImage) {
  std::vector<TagDetection> seen(5);
  for (TagDetection& tag : seen) {
    tag.corners_px.fill({100, 200});
    tag.covariances_px2.fill(1e-4 * Eigen::Matrix2d::Identity());
  }
  seen[2].corners_px.fill({300, 10});
  seen[2].covariances_px2.fill(Eigen::Matrix2d::Identity());
  const TagCorners median = MedianCorners(seen);
  for (size_t corner = 0; corner < 4; ++corner) {
    EXPECT_EQ(median.corners_px[corner], Eigen::Vector2d(100, 200));
    EXPECT_EQ(median.covariances_px2[corner], 1e-4 * Eigen::Matrix2d::Identity());
  }
}

}  // namespace
}  // namespace legible
