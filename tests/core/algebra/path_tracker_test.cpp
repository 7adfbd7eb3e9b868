#include "core/algebra/path_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/algebra/three_quadrics.h"
#include "tests/core/algebra/quadrics.h"

namespace legible {
namespace {

using Complex = std::complex<double>;
using Point = PathTracker<4>::Point;

constexpr double kTolerance = 1e-4;

// factor_i (x_i^2 - square_i x_0^2).
HomogeneousQuadrics<4> Boxes(const std::array<Complex, 3>& squares, const std::array<Complex, 3>& factors) {
  HomogeneousQuadrics<4> quadrics;
  for (size_t i = 0; i < 3; ++i) {
    quadrics[i].setZero();
    quadrics[i](0, 0) = -squares[i] * factors[i];
    quadrics[i](static_cast<int>(i) + 1, static_cast<int>(i) + 1) = factors[i];
  }
  return quadrics;
}

TEST(PathTracker, FollowsRootsOfSquares) {
  // Along the squares' straight ways each coordinate stays the principal root that it starts as.
  const PathTracker<4> tracker(Boxes({1, 1, 1}, {1, 1, 1}),
                               Boxes({Complex(0, 4), Complex(-3, 4), 9}, {1, 1, 1}));
  const PathEnd<4> end = tracker.Track(Point(1, 1, -1, 1), kTolerance);
  ASSERT_EQ(end.s, 1);
  const Point found = end.point / end.point[0];
  const double root_half = std::numbers::sqrt2;
  EXPECT_LT((found - Point(1, Complex(root_half, root_half), Complex(-1, -2), 3)).norm(), 1e-12);
}

// A general start, of which all paths arrive: an independent way to the roots that elimination finds.
TEST(PathTracker, ArrivesAtTheRootsThatEliminationFinds) {
  std::mt19937_64 generator = TestGenerator();
  const auto unit = [&] { return std::polar(1.0, Uniform(generator, 0, 2 * std::numbers::pi)); };
  for (int i = 0; i < 20; ++i) {
    const std::vector<Eigen::MatrixXd> matrices = RandomQuadrics(generator);
    const ThreeQuadricsRoots expected = AllRoots(ExactSystem(matrices));
    if (!expected.is_complete) continue;
    HomogeneousQuadrics<4> target;
    for (size_t k = 0; k < 3; ++k) target[k] = matrices[k].cast<Complex>() / matrices[k].norm();
    const PathTracker<4> tracker(Boxes({1, 1, 1}, {unit(), unit(), unit()}), target);
    std::vector<bool> is_found(8);
    for (int signs = 0; signs < 8; ++signs) {
      const Point start(1, (signs & 1) != 0 ? 1 : -1, (signs & 2) != 0 ? 1 : -1, (signs & 4) != 0 ? 1 : -1);
      const PathEnd<4> end = tracker.Track(start, kTolerance);
      ASSERT_EQ(end.s, 1);
      for (size_t root = 0; root < 8; ++root) {
        Point w;
        w << 1, expected.roots[root].midpoint;
        if (std::abs(w.normalized().dot(end.point)) > 1 - 1e-12) is_found[root] = true;
      }
    }
    EXPECT_EQ(std::count(is_found.begin(), is_found.end(), true), 8) << "system " << i;
  }
}

TEST(PathTracker, SaysThatItDidNotArriveAtADoubleRoot) {
  const PathTracker<4> tracker(Boxes({1, 1, 1}, {Complex(0, 1), 1, 1}), Boxes({0, 1, 1}, {1, 1, 1}));
  const PathEnd<4> end = tracker.Track(Point(1, 1, 1, 1), kTolerance);
  EXPECT_LT(end.s, 1);
  EXPECT_GT(end.s, 1 - 1e-6);
  EXPECT_LT(std::abs(end.point[1]), 1e-3);
}

}  // namespace
}  // namespace legible
