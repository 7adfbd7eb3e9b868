#include "core/algebra/ball_jet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/random.h"

namespace legible {
namespace {

// Of all operations, in the scalar's own.
template <typename T>
T Composed(const T& x) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const Eigen::Matrix<T, 2, 1> point(x * x - T(0.3), sin(x) / (T(2) + cos(x)));
  T value = -sqrt(T(1) + point.dot(point));
  value *= x;
  value -= point[0] / x;
  return value;
}

TEST(RealBallJet, EnclosesValuesAndDerivativesOnAPiece) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 200; ++n) {
    const double middle = Uniform(generator, 0.5, 5), radius = std::pow(10, Uniform(generator, -12, -1.5));
    const RealBallJet found = Composed<RealBallJet>({RealBall(middle, radius), 1.0});
    for (int draw = 0; draw < 10; ++draw) {
      const double x = middle + Uniform(generator, -radius, radius), step = 1e-5;
      const double rate = (Composed(x + step) - Composed(x - step)) / (2 * step);
      constexpr double kRounding = 1e-11, kDifferences = 1e-7;
      EXPECT_LE(LowerBound(found.value()) - kRounding, Composed(x));
      EXPECT_GE(UpperBound(found.value()) + kRounding, Composed(x));
      EXPECT_LE(LowerBound(found.rate()) - kDifferences, rate);
      EXPECT_GE(UpperBound(found.rate()) + kDifferences, rate);
    }
    EXPECT_LT(RadiusOf(found.rate()), 1e3 * radius + 1e-12);
  }
}

TEST(RealBallJet, ComparesValuesAlone) {
  EXPECT_TRUE(RealBallJet(RealBall(2, 0.5), 1.0) > RealBallJet(1.0));
  EXPECT_FALSE(RealBallJet(RealBall(2, 1.5), 1.0) > RealBallJet(1.0));
  EXPECT_TRUE(RealBallJet(1.0) == RealBallJet(1.0));
  EXPECT_FALSE(RealBallJet(1.0) == RealBallJet(RealBall(1.0), 1.0));
}

TEST(RealBallJet, WhatMayDivideByZeroIsNotANumber) {
  EXPECT_FALSE(std::isfinite(LowerBound((RealBallJet(1.0) / RealBallJet(RealBall(0, 1), 1.0)).rate())));
  EXPECT_FALSE(std::isfinite(LowerBound(sqrt(RealBallJet(RealBall(0, 1), 1.0)).rate())));
}

}  // namespace
}  // namespace legible
