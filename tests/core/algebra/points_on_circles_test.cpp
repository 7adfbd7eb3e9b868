#include "core/algebra/points_on_circles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/testing/random.h"

namespace legible {
namespace {

using Angles = std::array<double, 3>;

// (1, cos, sin).
Eigen::Vector3d Point(double angle_rad) { return {1, std::cos(angle_rad), std::sin(angle_rad)}; }

// The line through two points of the circle.
Eigen::Vector3d LineThrough(double a_rad, double b_rad) { return Point(a_rad).cross(Point(b_rad)); }

int RealCount(const PointsOnCirclesRoots& found) {
  return static_cast<int>(std::count_if(found.roots.begin(), found.roots.end(),
                                        [](const CertifiedRoot& root) { return root.is_real; }));
}

bool Has(const PointsOnCirclesRoots& found, const Angles& angles) {
  Eigen::Matrix<double, 6, 1> wanted;
  for (int k = 0; k < 3; ++k) wanted.segment<2>(2 * k) = Point(angles[static_cast<size_t>(k)]).tail<2>();
  return std::any_of(found.roots.begin(), found.roots.end(), [&](const CertifiedRoot& root) {
    return root.is_real && (root.midpoint.real() - wanted).cwiseAbs().maxCoeff() < 1e-9;
  });
}

// Conditions that are products of two lines each: all points on the first lines, or all on the second.
TEST(PointsOnCircles, OfPairsOfLinesAreTheSixteenThatAreOnThem) {
  std::mt19937_64 generator = TestGenerator();
  std::array<std::array<Angles, 2>, 2> on;  // by line, by point on it, by circle
  for (auto& line : on)
    for (Angles& points : line)
      for (double& angle_rad : points) angle_rad = Uniform(generator, -3.1, 3.1);
  CircleConditions conditions;
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    const Eigen::Matrix3d product =
        LineThrough(on[0][0][k], on[0][1][k]) * LineThrough(on[1][0][next], on[1][1][next]).transpose();
    conditions[k] = product.cast<RealBall>();
  }
  const PointsOnCirclesRoots found = AllRoots(conditions);
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(RealCount(found), 16);
  for (const auto& line : on)
    for (int choice = 0; choice < 8; ++choice) {
      Angles angles{};
      for (size_t k = 0; k < 3; ++k) angles[k] = line[static_cast<size_t>(choice >> k & 1)][k];
      EXPECT_TRUE(Has(found, angles)) << choice;
    }
}

TEST(PointsOnCircles, OfRandomConditionsThroughAPointAreSixteenAndHaveIt) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 100; ++n) {
    Angles angles{};
    for (double& angle_rad : angles) angle_rad = Uniform(generator, -3.1, 3.1);
    CircleConditions conditions;
    for (size_t k = 0; k < 3; ++k) {
      Eigen::Matrix3d condition = Eigen::Matrix3d::NullaryExpr([&] { return Uniform(generator, -1, 1); });
      condition(0, 0) -= Point(angles[k]).dot(condition * Point(angles[(k + 1) % 3]));
      conditions[k] = condition.cast<RealBall>();
    }
    const PointsOnCirclesRoots found = AllRoots(conditions);
    EXPECT_TRUE(found.is_complete) << n << ": " << found.missing << " are missing";
    EXPECT_TRUE(Has(found, angles)) << n;
    EXPECT_EQ(RealCount(found) % 2, 0) << n;
  }
}

TEST(PointsOnCircles, OfConditionsThatHoldEverywhereAreNotClaimedComplete) {
  CircleConditions conditions;
  for (auto& condition : conditions) condition.setZero();
  const PointsOnCirclesRoots found = AllRoots(conditions);
  EXPECT_FALSE(found.is_complete);
  EXPECT_GT(found.missing, 0);
}

}  // namespace
}  // namespace legible
