#include "core/algebra/root_certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "core/algebra/three_quadrics.h"
#include "tests/core/algebra/quadrics.h"

namespace legible {
namespace {

using Complex = std::complex<double>;

// constant + linear z + z^2.
QuadricSystem Quadratic(const ComplexBall& constant, double linear) {
  ComplexBallMatrix matrix(2, 2);
  matrix(0, 0) = constant;
  matrix(1, 0) = ComplexBall(0.5 * linear);
  matrix(1, 1) = ComplexBall(1);
  return QuadricSystem({matrix});
}

Eigen::VectorXcd Scalar(Complex z) { return Eigen::VectorXcd::Constant(1, z); }

TEST(QuadricSystem, ValuesAndDerivativesAreThoseOfTheQuadrics) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::MatrixXd> matrices = RandomQuadrics(generator);
  const QuadricSystem system = ExactSystem(matrices);
  const Eigen::Vector3cd z =
      UniformVector(generator, -1, 1) + Complex(0, 1) * UniformVector(generator, -1, 1);
  Eigen::Vector4cd w;
  w << 1, z;
  const auto at = Evaluate(system, Eigen::VectorXcd(z));
  const auto in_balls = Evaluate(system, ComplexBallVector(z.cast<ComplexBall>()));
  for (int k = 0; k < 3; ++k) {
    const Complex value = w.transpose() * matrices[static_cast<size_t>(k)].cast<Complex>() * w;
    EXPECT_NEAR(std::abs(at.values[k] - value), 0, 1e-13);
    EXPECT_NEAR(std::abs(MidpointOf(in_balls.values[k]) - value), 0, 1e-13);
    for (int i = 0; i < 3; ++i) {
      constexpr double kStep = 1e-3;  // the central difference of a quadric is exact but for rounding
      Eigen::Vector3cd before = z, after = z;
      before[i] -= kStep;
      after[i] += kStep;
      const Complex difference = (Evaluate(system, Eigen::VectorXcd(after)).values[k] -
                                  Evaluate(system, Eigen::VectorXcd(before)).values[k]) /
                                 (2 * kStep);
      EXPECT_NEAR(std::abs(at.jacobian(k, i) - difference), 0, 1e-10);
      EXPECT_NEAR(std::abs(MidpointOf(in_balls.jacobian(k, i)) - difference), 0, 1e-10);
    }
  }
}

TEST(QuadricSystem, RefusesMatricesOfOtherSizes) {
  EXPECT_THROW(QuadricSystem({ComplexBallMatrix(3, 3)}), std::invalid_argument);
  EXPECT_THROW(QuadricSystem({ComplexBallMatrix(3, 3), ComplexBallMatrix(3, 2)}), std::invalid_argument);
}

// Newton's method stops where its steps grow, and a proof may hold far around: neither is where the search
// ends.
TEST(CertifyRoot, KnowsWellConditionedRootsToRoundingFromRoughApproximations) {
  std::mt19937_64 generator = TestGenerator();
  int certified = 0;
  for (int n = 0; n < 200; ++n) {
    const QuadricSystem system = ExactSystem(RandomQuadrics(generator));
    for (const CertifiedRoot& root : AllRoots(system).roots) {
      const Eigen::VectorXcd offset = UniformVector(generator, -0.1, 0.1).cast<Complex>();
      const auto again = CertifyRoot(system, root.midpoint + offset);
      if (!again) continue;
      ++certified;
      EXPECT_LT(again->radius, 1e-9 * (1 + again->midpoint.norm())) << n;
    }
  }
  EXPECT_GT(certified, 1000);
}

TEST(CertifyRoot, EnclosesTheRootOfTwo) {
  const std::optional<CertifiedRoot> root = CertifyRoot(Quadratic(ComplexBall(-2), 0), Scalar({1.4, 0.1}));
  ASSERT_TRUE(root);
  EXPECT_TRUE(root->is_real);
  EXPECT_LT(root->radius, 1e-15);
  // The square of what lies within the radius comes to both sides of 2.
  const RealBall enclosure(root->midpoint[0].real(), root->radius);
  EXPECT_TRUE(Contains(enclosure * enclosure, 2));
  EXPECT_GT(root->unique_radius, 0.5);  // the other root is 2.8 away
  EXPECT_LT(root->unique_radius, 2.83);
}

TEST(CertifyRoot, TellsRealRootsFromOthers) {
  const std::optional<CertifiedRoot> root = CertifyRoot(Quadratic(ComplexBall(1), 0), Scalar({0.1, 1.1}));
  ASSERT_TRUE(root);
  EXPECT_FALSE(root->is_real);
  EXPECT_NEAR(std::abs(root->midpoint[0] - Complex(0, 1)), 0, 1e-15);
  // The conjugate roots 1 +- 1e-7 i are neither real nor one.
  const auto pair =
      CertifyRoots(Quadratic(ComplexBall(1 + 1e-14), -2), {Scalar({1, 1e-6}), Scalar({1, -1e-6})});
  EXPECT_EQ(pair.roots.size(), 2);
  for (const CertifiedRoot& one : pair.roots) EXPECT_FALSE(one.is_real);
}

TEST(CertifyRoot, TellsRootsApartDownToTheirDistance) {
  for (const double half : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8}) {  // the roots are 1 +- half
    const ComplexBall constant(RealBall(1) - RealBall(half) * RealBall(half));
    const std::optional<CertifiedRoot> root = CertifyRoot(Quadratic(constant, -2), Scalar(1 + 1.1 * half));
    ASSERT_TRUE(root) << half;
    EXPECT_TRUE(root->is_real);
    const RealBall error = RealBall(root->midpoint[0].real()) - RealBall(1) - RealBall(half);
    EXPECT_LE(LowerBound(error * error), root->radius * root->radius * (1 + 1e-15));
    EXPECT_LT(root->radius, half);
    EXPECT_LT(root->unique_radius, 2 * half);
  }
}

TEST(CertifyRoot, CoversTheRootsOfAllCoefficientsInTheirBalls) {
  const std::optional<CertifiedRoot> root =
      CertifyRoot(Quadratic(ComplexBall(RealBall(-2, 1e-3)), 0), Scalar(1.4));
  ASSERT_TRUE(root);
  for (const double constant : {1.999, 2.0, 2.001})
    EXPECT_LE(std::abs(root->midpoint[0] - std::sqrt(constant)), root->radius);
  EXPECT_LT(root->radius, 1e-3);
}

TEST(CertifyRoot, ProvesNothingOfDoubleRoots) {
  EXPECT_FALSE(CertifyRoot(Quadratic(ComplexBall(1), -2), Scalar({1.01, 0.02})));
  // Nor of what may be one.
  EXPECT_FALSE(CertifyRoot(Quadratic(ComplexBall(RealBall(1 - 1e-8, 1e-7)), -2), Scalar(1.0001)));
}

TEST(CertifyRoots, TakesARootOnce) {
  const CertifiedRoots found = CertifyRoots(Quadratic(ComplexBall(-2), 0),
                                            {Scalar(1.5), Scalar(-1.5), Scalar({1.3, 0.2}), Scalar(-1.4)});
  ASSERT_EQ(found.roots.size(), 2);
  EXPECT_EQ(found.uncertified, 0);
  EXPECT_GT(found.roots[0].midpoint[0].real(), 0);
  EXPECT_LT(found.roots[1].midpoint[0].real(), 0);
}

TEST(CertifyRoots, CountsWhatLeadsToNoRoot) {
  const CertifiedRoots found = CertifyRoots(Quadratic(ComplexBall(1), -2), {Scalar(1.5), Scalar(0.5)});
  EXPECT_TRUE(found.roots.empty());
  EXPECT_EQ(found.uncertified, 2);
}

}  // namespace
}  // namespace legible
