#include "core/algebra/three_quadrics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/core/algebra/exact_real_roots.h"
#include "tests/core/algebra/quadrics.h"

namespace legible {
namespace {

int RealCount(const ThreeQuadricsRoots& found) {
  return static_cast<int>(std::count_if(found.roots.begin(), found.roots.end(),
                                        [](const CertifiedRoot& root) { return root.is_real; }));
}

// Whether a root lies within 1e-9 of the point.
bool Has(const ThreeQuadricsRoots& found, const Eigen::Vector3cd& point) {
  return std::any_of(found.roots.begin(), found.roots.end(), [&](const CertifiedRoot& root) {
    return (root.midpoint - point).cwiseAbs().maxCoeff() < 1e-9;
  });
}

// (coordinate)^2 = square.
Eigen::MatrixXd PairOfPlanes(int coordinate, double square) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4, 4);
  matrix(coordinate + 1, coordinate + 1) = 1;
  matrix(0, 0) = -square;
  return matrix;
}

// (1, p) lies on it: the constant makes it so.
Eigen::MatrixXd Through(const Eigen::Vector3d& p, Eigen::MatrixXd quadric) {
  Eigen::Vector4d w;
  w << 1, p;
  quadric(0, 0) -= w.dot(quadric * w);
  return quadric;
}

TEST(AllRoots, AreTheCornersOfABox) {
  const ThreeQuadricsRoots found =
      AllRoots(ExactSystem({PairOfPlanes(0, 4), PairOfPlanes(1, 9), PairOfPlanes(2, 0.25)}));
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(found.missing, 0);
  EXPECT_EQ(RealCount(found), 8);
  for (const double x : {-2, 2})
    for (const double y : {-3, 3})
      for (const double z : {-0.5, 0.5})
        EXPECT_TRUE(Has(found, Eigen::Vector3d(x, y, z).cast<std::complex<double>>()));
}

TEST(AllRoots, OfImaginaryBoxesAreImaginary) {
  const ThreeQuadricsRoots found =
      AllRoots(ExactSystem({PairOfPlanes(0, -4), PairOfPlanes(1, 9), PairOfPlanes(2, 0.25)}));
  EXPECT_TRUE(found.is_complete);
  EXPECT_EQ(RealCount(found), 0);
  EXPECT_TRUE(Has(found, Eigen::Vector3cd({0, 2}, 3, -0.5)));
}

TEST(AllRoots, AreAsManyRealOnesAsAnExactCountSays) {
  std::mt19937_64 generator = TestGenerator();
  int checked = 0, real = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<Eigen::MatrixXd> quadrics = RandomQuadrics(generator);
    const std::optional<int> expected = ExactRealRootCount(quadrics);
    if (!expected) continue;
    const QuadricSystem system = ExactSystem(quadrics);
    const ThreeQuadricsRoots found = AllRoots(system);
    ASSERT_TRUE(found.is_complete) << found.missing << " missing of system " << i;
    EXPECT_EQ(RealCount(found), *expected) << "system " << i;
    for (const CertifiedRoot& root : found.roots) {
      const double size = 1 + root.midpoint.cwiseAbs().maxCoeff();
      EXPECT_LT(LargestValue(system, root.midpoint), 1e-11 * size * size);
    }
    ++checked;
    real += *expected;
  }
  EXPECT_GE(checked, 300);
  EXPECT_GT(real, checked);  // some have real roots
}

TEST(AllRoots, AreNotCompleteWithADoubleRoot) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    // All through p; there the gradient of the third depends on the others'.
    const Eigen::Vector3d p(1, -2, 1);
    std::vector<Eigen::MatrixXd> quadrics = RandomQuadrics(generator);
    Eigen::Vector4d w;
    w << 1, p;
    const Eigen::Vector3d wanted = ((quadrics[0] + quadrics[1] - quadrics[2]) * w).tail<3>();
    quadrics[2].block<3, 1>(1, 0) += wanted;
    quadrics[2].block<1, 3>(0, 1) += wanted.transpose();
    for (Eigen::MatrixXd& quadric : quadrics) quadric = Through(p, quadric);
    const ThreeQuadricsRoots found = AllRoots(ExactSystem(quadrics));
    EXPECT_FALSE(found.is_complete);
    EXPECT_GE(found.missing, 2);
    EXPECT_FALSE(Has(found, p.cast<std::complex<double>>()));
  }
}

TEST(AllRoots, AreNotCompleteWithARootAtInfinity) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    std::vector<Eigen::MatrixXd> quadrics;
    for (int k = 0; k < 3; ++k) {
      Eigen::MatrixXd quadric(4, 4);
      for (double& coefficient : quadric.reshaped()) coefficient = Uniform(generator, -1, 1);
      quadric(3, 3) = 0;  // all through z at infinity
      quadrics.push_back(quadric);
    }
    const ThreeQuadricsRoots found = AllRoots(ExactSystem(quadrics));
    EXPECT_FALSE(found.is_complete);
    EXPECT_EQ(found.roots.size(), 7);
    EXPECT_EQ(found.missing, 1);
  }
}

TEST(AllRoots, OfQuadricsWithACurveInCommonAreNotComplete) {
  std::mt19937_64 generator = TestGenerator();
  const Eigen::MatrixXd a = RandomQuadric(generator), b = RandomQuadric(generator);
  EXPECT_FALSE(AllRoots(ExactSystem({a, b, a + b})).is_complete);
  EXPECT_FALSE(AllRoots(ExactSystem({a, b, Eigen::MatrixXd::Zero(4, 4)})).is_complete);
}

TEST(AllRoots, NeedsThreeQuadrics) {
  EXPECT_THROW(AllRoots(ExactSystem({Eigen::MatrixXd::Identity(2, 2)})), std::invalid_argument);
}

}  // namespace
}  // namespace legible
