#include "calib/tag_weights.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

std::vector<TagErrors> NormalErrors(std::mt19937_64& generator, size_t count, double sigma_px) {
  std::normal_distribution<double> normal(0, sigma_px);
  std::vector<TagErrors> tags(count);
  for (TagErrors& tag : tags)
    for (double& error : tag.error_px) error = normal(generator);
  return tags;
}

TEST(TagSigma, IsThatOfTheCornersWhetherOrNotSomeTagsAreMisread) {
  std::mt19937_64 generator = TestGenerator();
  std::vector<TagErrors> tags = NormalErrors(generator, 500, 0.07);
  for (size_t i = 0; i < 50; ++i) tags[i].error_px.setConstant(12);
  WeighTags(tags, MedianTagSigma(tags));
  EXPECT_NEAR(TagSigma(tags, 1), 0.07, 0.005);
  for (size_t i = 0; i < tags.size(); ++i) EXPECT_EQ(tags[i].weight, i < 50 ? 0 : 1) << i;
}

// Eight rows at 0.1 px beside the tag's own eight, of which its place takes six.
TEST(TagSigma, OfASingleTagIsDrawnTowardsTheUsualOne) {
  std::vector<TagErrors> tags(1);
  tags[0].error_px.setZero();
  EXPECT_NEAR(TagSigma(tags, 1), 0.1 * std::sqrt(8.0 / 10), 1e-12);
  tags[0].error_px.setConstant(0.2);
  EXPECT_NEAR(TagSigma(tags, 1), std::sqrt((8 * 0.01 + 8 * 0.04) / 10), 1e-12);
}

TEST(MedianCorners, AreNotMovedByAMisreadImage) {
  std::vector<std::array<Eigen::Vector2d, 4>> seen(5);
  for (auto& image : seen) image.fill({100, 200});
  seen[2].fill({300, 10});
  for (const Eigen::Vector2d& corner : MedianCorners(seen)) EXPECT_EQ(corner, Eigen::Vector2d(100, 200));
}

}  // namespace
}  // namespace legible
