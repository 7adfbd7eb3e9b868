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
  EXPECT_TRUE(band.cells[5].follows_previous);
  EXPECT_FALSE(band.cells[6].follows_previous);
}

TEST(EdgeBand, StaysInTheImage) {
  StraightEdge edge = EdgeAt(0.4);
  edge.start_px = {-20, -10};
  const GrayImage image = Paint(edge, [](double, double) { return 100; });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  size_t expected = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Vector2d from_start = Eigen::Vector2d(x, y) - edge.start_px;
      const double along = edge.along_px.dot(from_start), inside = -edge.normal_px.dot(from_start);
      expected +=
          along >= 0 && along <= edge.length_px && inside <= kInside_px && inside >= -kOutside_px ? 1 : 0;
    }
  EXPECT_GT(expected, 100);
  EXPECT_EQ(band.pixels.size(), expected);
}

constexpr BinGrid kGrid{kOutside_px, kInside_px, 0.125};

EdgeProfile FlatProfileOf(const EdgeBand& band, size_t first, size_t last) {
  return FlatProfile(BinBand(band, first, last, kGrid), SoftStep(kGrid), kGrid, 2.5);
}

// Mean brightness of a profile 2 to 5 px outside, and 2 to 5 px inside.
std::pair<double, double> LevelsOf(const EdgeProfile& profile) {
  double outside = 0, outside_count = 0, inside = 0, inside_count = 0;
  for (const ProfileBin& bin : profile) {
    if (bin.inside_px < -2 && bin.inside_px > -5) {
      outside += bin.count * bin.brightness;
      outside_count += bin.count;
    } else if (bin.inside_px > 2 && bin.inside_px < 5) {
      inside += bin.count * bin.brightness;
      inside_count += bin.count;
    }
  }
  return {outside / outside_count, inside / inside_count};
}

TEST(FlatProfile, HasTheSameLevelsAllAlongARamp) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(
      edge, [](double along, double inside) { return inside > 0 ? 140 + 0.4 * along : 30 + 0.2 * along; });
  EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  MeasureLevels(band);
  ASSERT_EQ(band.cells.size(), 20);
  // The first and the last cell are averaged with one neighbour only: a third of a cell's rise remains.
  for (size_t i = 1; i + 1 < band.cells.size(); ++i) {
    const auto [outside, inside] = LevelsOf(FlatProfileOf(band, i, i + 1));
    EXPECT_NEAR(outside, 30 + 0.2 * 60, 1) << i;
    EXPECT_NEAR(inside, 140 + 0.4 * 60, 1) << i;
  }
}

TEST(MeasureLevels, DropsCellsThatSomethingCovers) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(edge, [](double along, double inside) {
    return along > 42 && along < 60 ? 100.0 : inside > 0 ? 160.0 : 40.0;
  });
  EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  MeasureLevels(band);
  // Three cells are covered; those beside them may go too, for the jump to a neighbour is not texture.
  EXPECT_GE(band.cells.size(), 15);
  EXPECT_LE(band.cells.size(), 17);
  for (const BandCell& cell : band.cells) EXPECT_TRUE(cell.share < 0.35 || cell.share > 0.5) << cell.share;
}

TEST(MeasureLevels, DropsACellTooShortToMeasureAndLeavesItsNeighbours) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(edge, [](double, double inside) { return inside > 0 ? 160 : 40; });
  std::vector<PredictedEdgePoint> points = PointsOf(edge, 20);
  PredictedEdgePoint close = points[10];
  close.point_px += 0.2 * edge.along_px;
  points.insert(points.begin() + 11, close);
  EdgeBand band = CollectBand(image, points, kOutside_px, kInside_px);
  ASSERT_EQ(band.cells.size(), 21);
  MeasureLevels(band);
  EXPECT_EQ(band.cells.size(), 20);
}

TEST(BinBand, HoldsEveryPixelOfItsCells) {
  const StraightEdge edge = EdgeAt(0.4);
  const GrayImage image = Paint(edge, [](double, double inside) { return inside > 0 ? 160 : 40; });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  const BandBins bins = BinBand(band, 0, band.cells.size(), kGrid);
  double count = 0;
  for (size_t i = 0; i < bins.size(); ++i) {
    count += bins[i].count;
    if (bins[i].count == 0) continue;
    EXPECT_EQ(bins[i].sums[1] / bins[i].count, kGrid.Middle(i) > 0 ? 160 : 40);
    EXPECT_NEAR(bins[i].sums[0] / bins[i].count, kGrid.Middle(i), kGrid.width_px / 2 + 1e-5);
  }
  EXPECT_EQ(count, static_cast<double>(band.pixels.size()));
}

TEST(BinBand, OfTheWholeIsTheSumOfItsStretches) {
  const StraightEdge edge = EdgeAt(0.4);
  std::mt19937_64 generator = TestGenerator();
  const GrayImage image = Paint(edge, [&](double, double) { return Uniform(generator, 0, 255); });
  const EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
  BandBins sum = BinBand(band, 0, 7, kGrid);
  Add(BinBand(band, 7, band.cells.size(), kGrid), sum);
  const BandBins whole = BinBand(band, 0, band.cells.size(), kGrid);
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(sum[i].count, whole[i].count);
    EXPECT_LT((sum[i].sums - whole[i].sums).abs().maxCoeff(), 1e-5 * (1 + whole[i].sums.abs().maxCoeff()));
  }
}

TEST(FlatProfile, IsCoarserFarFromTheEdgeAndKeepsPixelsAndMeans) {
  const StraightEdge edge = EdgeAt(0.4);
  std::mt19937_64 generator = TestGenerator();
  const GrayImage image = Paint(edge, [&](double, double) { return Uniform(generator, 0, 255); });
  const EdgeBand band =
      CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);  // levels unmeasured: 0
  const BandBins bins = BinBand(band, 0, band.cells.size(), kGrid);
  const EdgeProfile fine = FlatProfile(bins, SoftStep(kGrid), kGrid, 100),
                    coarser = FlatProfile(bins, SoftStep(kGrid), kGrid, 2);
  EXPECT_EQ(fine.size(), bins.size());
  EXPECT_LT(coarser.size(), fine.size() * 3 / 4);
  const auto moments = [](const EdgeProfile& profile) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const ProfileBin& bin : profile)
      sum += bin.count * Eigen::Vector3d(1, bin.inside_px, bin.brightness);
    return sum;
  };
  EXPECT_LT((moments(coarser) - moments(fine)).norm(), 1e-9 * moments(fine).norm());
  const auto near = [](const EdgeProfile& profile) {
    return std::count_if(profile.begin(), profile.end(),
                         [](const ProfileBin& b) { return std::abs(b.inside_px) < 2; });
  };
  EXPECT_EQ(near(coarser), near(fine));
}

// A leg whose light fades along it: what is brightest across it changes most.
TEST(ShapeOf, FollowsTheBrightnessAcrossTheEdge) {
  ProfileFit fit;
  fit.model = ShadingModel::kFlat;
  fit.coefficients = Eigen::Vector2d(40, 160);
  ProfileFitOptions options;
  const LevelShape shape = ShapeOf(fit, options, kGrid);
  for (size_t i = 0; i < shape.size(); ++i) {
    const double x = kGrid.Middle(i);
    const double leg = std::erfc(-x / std::sqrt(2 * (options.blur_px * options.blur_px + 1.0 / 12))) / 2;
    EXPECT_NEAR(shape[i].leg, leg, 0.02) << x;
    EXPECT_NEAR(shape[i].background, 1 - leg, 0.02) << x;
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
    EdgeBand band = CollectBand(image, PointsOf(edge, 20), kOutside_px, kInside_px);
    MeasureLevels(band);
    variance += std::pow(GreyNoise(band), 2) / 20;
  }
  EXPECT_NEAR(std::sqrt(variance), std::hypot(3, std::sqrt(1.0 / 12)), 0.15);
}

}  // namespace
}  // namespace legible
