#include "core/vision/blurred_powers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace legible {
namespace {

constexpr HalfPower kHalfPowers[] = {HalfPower::kOneHalf, HalfPower::kThreeHalves, HalfPower::kFiveHalves};

double ExponentOf(HalfPower power) { return 0.5 + static_cast<double>(power); }

// Integral over u > 0 of u^p phi(z - u) by the exp-sinh rule, which the root at 0 does not disturb.
double BlurredByExpSinh(double p, double z) {
  constexpr double kStep = 1.0 / 256;
  double sum = 0;
  for (int i = -1536; i <= 1024; ++i) {
    const double t = i * kStep;
    const double u = std::exp(std::numbers::pi / 2 * std::sinh(t));
    const double density = std::exp(-(z - u) * (z - u) / 2) / std::sqrt(2 * std::numbers::pi);
    if (density > 0) sum += std::pow(u, p + 1) * std::numbers::pi / 2 * std::cosh(t) * density;
  }
  return sum * kStep;
}

TEST(BlurredHalfPower, AgreesWithExpSinhQuadrature) {
  for (const HalfPower power : kHalfPowers) {
    const double p = ExponentOf(power);
    for (double z = -6; z < 14.9; z += 0.37) {
      const BlurredPower found = BlurredHalfPower(power, z);
      EXPECT_NEAR(found.value, BlurredByExpSinh(p, z), 1e-8) << p << ' ' << z;
      EXPECT_NEAR(found.derivative, p * BlurredByExpSinh(p - 1, z), 1e-6) << p << ' ' << z;
    }
  }
}

TEST(BlurredHalfPower, FollowsItsExpansionFarInside) {
  for (const HalfPower power : kHalfPowers) {
    const double p = ExponentOf(power);
    for (const double z : {15.0, 20.0, 50.0}) {
      // The first term that the expansion leaves out: p (p - 1) (p - 2) (p - 3) / 8 z^-4, and more than all
      // beyond.
      const double left_out = 1.5 * std::abs(p * (p - 1) * (p - 2) * (p - 3) / 8) / std::pow(z, 4);
      const double expected = BlurredByExpSinh(p, z);
      EXPECT_NEAR(BlurredHalfPower(power, z).value / expected, 1, left_out) << p << ' ' << z;
    }
  }
}

TEST(BlurredHalfPower, VanishesFarOutside) {
  for (const HalfPower power : kHalfPowers) {
    EXPECT_EQ(BlurredHalfPower(power, -50).value, 0);
    EXPECT_NEAR(BlurredHalfPower(power, -7.99).value, 0, 1e-14);
  }
}

TEST(BlurredStep, IsTheNormalDistribution) {
  for (double z = -7.9; z < 14; z += 0.0137) {
    EXPECT_NEAR(BlurredStep(z).value, std::erfc(-z / std::numbers::sqrt2) / 2, 1e-9);
    EXPECT_NEAR(BlurredStep(z).derivative, std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi), 1e-6);
  }
  EXPECT_EQ(BlurredStep(-20).value, 0);
  EXPECT_EQ(BlurredStep(20).value, 1);
}

TEST(BlurredRamp, AgreesWithExpSinhQuadrature) {
  for (double z = -6; z < 14.9; z += 0.37) {
    EXPECT_NEAR(BlurredRamp(z).value, BlurredByExpSinh(1, z), 1e-6);
    EXPECT_NEAR(BlurredRamp(z).derivative, BlurredByExpSinh(0, z), 1e-6);
  }
  EXPECT_EQ(BlurredRamp(20).value, 20);
}

}  // namespace
}  // namespace legible
