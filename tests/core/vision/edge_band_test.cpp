#include "core/vision/edge_band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kOutside_px = 9, kInside_px = 7;

struct StraightEdge {
  Eigen::Vector2d start_px, along_px, normal_px;  // unit vectors; the normal points away from the leg
  double length_px;
};

StraightEdge EdgeAt(double angle_rad) {
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
  return {{100.37, 80.11}, along, {-along.y(), along.x()}, 120};
}

std::vector<PredictedEdgePoint> PointsOf(const StraightEdge& edge, int cells) {
  std::vector<PredictedEdgePoint> points;
  for (int i = 0; i <= cells; ++i) {
    PredictedEdgePoint point;
    point.share = static_cast<double>(i) / cells;
    point.point_px = edge.start_px + point.share * edge.length_px * edge.along_px;
    point.normal_px = edge.normal_px;
    points.push_back(point);
  }
  return points;
}

// Brightness as a function of the distances along the edge and into the leg.
GrayImage Paint(const StraightEdge& edge,
                const std::function<double(double along, double inside)>& brightness) {
  GrayImage image{320, 300, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Vector2d from_start = Eigen::Vector2d(x, y) - edge.start_px;
      const double grey = brightness(edge.along_px.dot(from_start), -edge.normal_px.dot(from_start));
      image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L)));
    }
  return image;
}

class BandAtAngle : public testing::TestWithParam<double> {};

TEST_P(BandAtAngle, CountsEveryPixelOnceWithItsDistance) {
  const StraightEdge edge = EdgeAt(GetParam());
  std::mt19937_64 generator = TestGenerator();
  const GrayImage image = Paint(edge, [&](double, double) { return Uniform(generator, 0, 255); });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);

  std::vector<double> expected, found;
  double expected_brightness = 0, found_brightness = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Vector2d from_start = Eigen::Vector2d(x, y) - edge.start_px;
      const double along = edge.along_px.dot(from_start), inside = -edge.normal_px.dot(from_start);
      if (along < 0 || along > edge.length_px || inside > kInside_px || inside < -kOutside_px) continue;
      expected.push_back(inside);
      expected_brightness += (inside + 100) * image(x, y);
    }
  for (const BandPixel& pixel : band.pixels) {
    found.push_back(pixel.inside_px);
    found_brightness += (pixel.inside_px + 100.0) * pixel.brightness;
  }
  ASSERT_EQ(found.size(), expected.size());
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-5);
  EXPECT_NEAR(found_brightness / expected_brightness, 1, 1e-7);  // each brightness at its own distance
  EXPECT_NEAR(band.length_px, edge.length_px, 1e-9);
  size_t of_cells = 0;
  for (const BandCell& cell : band.cells) of_cells += cell.last - cell.first;
  EXPECT_EQ(of_cells, band.pixels.size());
}

INSTANTIATE_TEST_SUITE_P(Angles, BandAtAngle, testing::Values(0.013, 0.4, 0.79, 1.2, 1.56, 0.9));

TEST(EdgeBand, LeavesOutHiddenStretches) {
  const StraightEdge edge = EdgeAt(0.4);
  std::vector<PredictedEdgePoint> points = PointsOf(edge, 20);
  points[7].obstacle = EdgeObstacle::kOtherLeg;
  const GrayImage image = Paint(edge, [](double, double) { return 100; });
  const EdgeBand band = CollectBand(image, points, kOutside_px, kInside_px);
  ASSERT_EQ(band.cells.size(), 18);
  EXPECT_NEAR(band.length_px, 18 * edge.length_px / 20, 1e-9);
  EXPECT_TRUE(band.cells[5].follows_previous);
  EXPECT_FALSE(band.cells[6].follows_previous);
}

TEST(EdgeBand, StaysInTheImage) {
  StraightEdge edge = EdgeAt(0.4);
  edge.start_px = {-20, -10};
  const GrayImage image = Paint(edge, [](double, double) { return 100; });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  EXPECT_FALSE(band.pixels.empty());
}

// Levels of each cell: the mean 2 to 5 px outside, and 2 to 5 px inside.
std::pair<double, double> LevelsOf(const EdgeBand& band, const BandCell& cell) {
  double outside = 0, outside_count = 0, inside = 0, inside_count = 0;
  for (size_t i = cell.first; i < cell.last; ++i) {
    const BandPixel& pixel = band.pixels[i];
    if (pixel.inside_px < -2 && pixel.inside_px > -5) {
      outside += pixel.brightness;
      ++outside_count;
    } else if (pixel.inside_px > 2 && pixel.inside_px < 5) {
      inside += pixel.brightness;
      ++inside_count;
    }
  }
  return {outside / outside_count, inside / inside_count};
}

TEST(Flatten, TakesOutALinearRampAlongTheEdge) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(
      edge, [](double along, double inside) { return inside > 0 ? 140 + 0.4 * along : 30 + 0.2 * along; });
  EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  Flatten(band, 0, LevelShape());
  ASSERT_EQ(band.cells.size(), 20);
  // The first and the last cell are averaged with one neighbour only: a third of a cell's rise remains.
  for (size_t i = 1; i + 1 < band.cells.size(); ++i) {
    const auto [outside, inside] = LevelsOf(band, band.cells[i]);
    EXPECT_NEAR(outside, 30 + 0.2 * 60, 1) << i;
    EXPECT_NEAR(inside, 140 + 0.4 * 60, 1) << i;
  }
}

TEST(Flatten, DropsCellsThatSomethingCovers) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(edge, [](double along, double inside) {
    return along > 42 && along < 60 ? 100.0 : inside > 0 ? 160.0 : 40.0;
  });
  EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  Flatten(band, 0, LevelShape());
  // Three cells are covered; those beside them may go too, for the jump to a neighbour is not texture.
  EXPECT_GE(band.cells.size(), 15);
  EXPECT_LE(band.cells.size(), 17);
  for (const BandCell& cell : band.cells) EXPECT_TRUE(cell.share < 0.35 || cell.share > 0.5) << cell.share;
}

TEST(BinProfile, HoldsEveryPixelOfItsCells) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(edge, [](double, double inside) { return inside > 0 ? 160 : 40; });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  const EdgeProfile profile = BinProfile(band, 0, band.cells.size(), kOutside_px, kInside_px, 0.125);
  double count = 0;
  for (const ProfileBin& bin : profile) {
    count += bin.count;
    if (bin.count > 0) {
      EXPECT_EQ(bin.brightness, bin.inside_px > 0 ? 160 : 40);
    }
  }
  EXPECT_EQ(count, static_cast<double>(band.pixels.size()));
}

TEST(CoarserFarFromTheEdge, KeepsPixelsAndMeansAndTheBinsNearTheEdge) {
  EdgeProfile profile;
  for (int i = 0; i < 64; ++i) profile.push_back({-4 + (i + 0.5) / 8, 10.0 * i, 1.0 + i % 3});
  const EdgeProfile coarser = CoarserFarFromTheEdge(profile, 2);
  EXPECT_LT(coarser.size(), profile.size() * 3 / 4);
  const auto moments = [](const EdgeProfile& bins) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const ProfileBin& bin : bins) sum += bin.count * Eigen::Vector3d(1, bin.inside_px, bin.brightness);
    return sum;
  };
  EXPECT_LT((moments(coarser) - moments(profile)).norm(), 1e-9 * moments(profile).norm());
  const auto near = [](const EdgeProfile& bins) {
    return std::count_if(bins.begin(), bins.end(),
                         [](const ProfileBin& b) { return std::abs(b.inside_px) < 2; });
  };
  EXPECT_EQ(near(coarser), near(profile));
}

// A leg whose light fades along it: what is brightest across it changes most.
TEST(LevelShape, FollowsTheBrightnessAcrossTheEdge) {
  ProfileFit fit;
  fit.model = ShadingModel::kFlat;
  fit.coefficients = Eigen::Vector2d(40, 160);
  ProfileFitOptions options;
  const LevelShape shape(fit, options);
  for (const float x : {-4.0f, -0.3f, 0.0f, 0.4f, 3.0f}) {
    const double leg = std::erfc(-x / std::sqrt(2 * (options.blur_px * options.blur_px + 1.0 / 12))) / 2;
    EXPECT_NEAR(shape.At(x).leg, leg, 0.03) << x;  // half a step of the table
    EXPECT_NEAR(shape.At(x).background, 1 - leg, 0.03) << x;
  }
}

TEST(GreyNoise, IsTheScatterOfTheBackground) {
  std::mt19937_64 generator = TestGenerator();
  std::normal_distribution<double> normal(0, 3);
  const StraightEdge edge = EdgeAt(0.4);
  double variance = 0;
  for (int i = 0; i < 20; ++i) {
    const GrayImage image = Paint(edge, [&](double along, double inside) {
      return (inside > 0 ? 160 : 40) + 0.2 * along + normal(generator);
    });
    const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
    variance += std::pow(GreyNoise(band), 2) / 20;
  }
  EXPECT_NEAR(std::sqrt(variance), std::hypot(3, std::sqrt(1.0 / 12)), 0.15);
}

}  // namespace
}  // namespace legible
