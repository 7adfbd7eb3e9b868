#include "core/vision/blurred_powers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace legible {
namespace {

// Of the half-integer powers, in the order of BlurredPowers.
double ExponentOf(int i) { return i - 0.5; }

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

TEST(BlurredPowers, HalfIntegerOnesAgreeWithExpSinhQuadrature) {
  for (int i = 1; i < 4; ++i) {
    const double p = ExponentOf(i);
    for (double z = -6; z < 14.9; z += 0.37) {
      const BlurredPowers found = BlurredPowersAt(z);
      EXPECT_NEAR(found.value[i], BlurredByExpSinh(p, z), 1e-8) << p << ' ' << z;
      EXPECT_NEAR(found.derivative[i], p * BlurredByExpSinh(p - 1, z), 1e-6) << p << ' ' << z;
    }
  }
}

TEST(BlurredPowers, HalfIntegerOnesFollowTheirExpansionFarInside) {
  for (int i = 1; i < 4; ++i) {
    const double p = ExponentOf(i);
    for (const double z : {15.0, 20.0, 50.0}) {
      // The first term that the expansion leaves out: p (p - 1) (p - 2) (p - 3) / 8 z^-4, and more than all
      // beyond.
      const double left_out = 1.5 * std::abs(p * (p - 1) * (p - 2) * (p - 3) / 8) / std::pow(z, 4);
      const double expected = BlurredByExpSinh(p, z);
      EXPECT_NEAR(BlurredPowersAt(z).value[i] / expected, 1, left_out) << p << ' ' << z;
    }
  }
}

TEST(BlurredPowers, VanishFarOutside) {
  EXPECT_EQ(BlurredPowersAt(-50).value.abs().maxCoeff(), 0);
  EXPECT_LT(BlurredPowersAt(-7.99).value.abs().maxCoeff(), 1e-14);
}

TEST(BlurredPowers, TheZerothIsTheNormalDistribution) {
  for (double z = -7.9; z < 14; z += 0.0137) {
    const BlurredPower step = BlurredStepAt(z);
    EXPECT_NEAR(step.value, std::erfc(-z / std::numbers::sqrt2) / 2, 1e-9);
    EXPECT_NEAR(step.derivative, std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi), 1e-6);
    EXPECT_EQ(step.value, BlurredPowersAt(z).value[0]);
    EXPECT_EQ(step.derivative, BlurredPowersAt(z).derivative[0]);
  }
  EXPECT_EQ(BlurredStepAt(-20).value, 0);
  EXPECT_EQ(BlurredStepAt(20).value, 1);
}

TEST(BlurredPowers, CurvaturesAreTheSlopesOfTheDerivatives) {
  constexpr double kStep = 0.01;
  for (double z = -6; z < 20; z += 0.0731) {
    const Eigen::Array4d numeric =
        (BlurredPowersAt(z + kStep).derivative - BlurredPowersAt(z - kStep).derivative) / (2 * kStep);
    EXPECT_LT((BlurredCurvaturesAt(z) - numeric).abs().maxCoeff(), 2e-3) << z;
  }
}

TEST(BlurredRamp, AgreesWithExpSinhQuadrature) {
  for (double z = -6; z < 14.9; z += 0.37) {
    EXPECT_NEAR(BlurredRampAt(z).value, BlurredByExpSinh(1, z), 1e-6);
    EXPECT_NEAR(BlurredRampAt(z).derivative, BlurredByExpSinh(0, z), 1e-6);
  }
  EXPECT_EQ(BlurredRampAt(20).value, 20);
}

}  // namespace
}  // namespace legible
