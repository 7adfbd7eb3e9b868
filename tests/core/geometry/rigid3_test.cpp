#include "core/geometry/rigid3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kPi = std::numbers::pi;

Rigid3 RandomTransform(std::mt19937_64& generator) {
  return {UniformRotation(generator), UniformVector(generator, -1, 1)};
}

// A displacement of up to `size` m and up to `size` rad.
Vector6d RandomDisplacement(std::mt19937_64& generator, double size) {
  Vector6d displacement;
  displacement << UniformVector(generator, -1, 1).normalized(), UniformVector(generator, -1, 1).normalized();
  return size * Uniform(generator, 0, 1) * displacement;
}

// The exponential of a skew matrix by its power series: the truth about RotationFromVector.
Eigen::Matrix3d ExponentialSeries(const Eigen::Vector3d& rotation_vector) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = sum;
  for (int i = 1; i < 40; ++i) {
    term = term * Skew(rotation_vector) / i;
    sum += term;
  }
  return sum;
}

TEST(Rigid3, ProductAppliesTheRightFactorFirst) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 100; ++i) {
    const Rigid3 c_from_b = RandomTransform(generator), b_from_a = RandomTransform(generator);
    const Eigen::Vector3d x_in_a = UniformVector(generator, -1, 1);
    EXPECT_TRUE(AreNear((c_from_b * b_from_a) * x_in_a, c_from_b * (b_from_a * x_in_a), 1e-14));
  }
}

TEST(Rigid3, InverseUndoesFromBothSides) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 100; ++i) {
    const Rigid3 b_from_a = RandomTransform(generator);
    const Eigen::Vector3d x = UniformVector(generator, -1, 1);
    EXPECT_TRUE(AreNear(Inverse(b_from_a) * (b_from_a * x), x, 1e-14));
    EXPECT_TRUE(AreNear(b_from_a * (Inverse(b_from_a) * x), x, 1e-14));
  }
}

TEST(Rigid3, LeftJacobianTakesASmallChangeOfTheVectorToTheTurnBeforeIt) {
  std::mt19937_64 generator = TestGenerator();
  for (const double size : {0.0, 1e-6, 1e-4, 0.3, 3.0}) {
    const Eigen::Vector3d vector = size * UniformVector(generator, -1, 1).normalized();
    const Eigen::Vector3d change = 1e-6 * UniformVector(generator, -1, 1);
    const Eigen::Quaterniond before =
        RotationFromVector(vector + change) * RotationFromVector(vector - change).conjugate();
    EXPECT_TRUE(AreNear(LeftJacobian(vector) * change, VectorFromRotation(before) / 2, 1e-14)) << size;
  }
}

TEST(Rigid3, SkewIsTheCrossProduct) {
  std::mt19937_64 generator = TestGenerator();
  const Eigen::Vector3d a = UniformVector(generator, -1, 1), b = UniformVector(generator, -1, 1);
  EXPECT_TRUE(AreNear(Skew(a) * b, a.cross(b), 1e-16));
}

TEST(Rigid3, RotationFromVectorIsTheMatrixExponential) {
  std::mt19937_64 generator = TestGenerator();
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-8, 2e-8, 1e-3, 1.0, kPi - 1e-8, kPi, 4.0}) {
    const Eigen::Vector3d vector = angle * UniformVector(generator, -1, 1).normalized();
    const Eigen::Matrix3d rotation = RotationFromVector(vector).toRotationMatrix();
    EXPECT_TRUE(AreNear(rotation, ExponentialSeries(vector), 1e-14)) << "angle " << angle;
  }
}

TEST(Rigid3, VectorFromRotationInvertsRotationFromVectorAtEveryAngleAndQuaternionSign) {
  std::mt19937_64 generator = TestGenerator();
  for (const double angle : {0.0, 1e-200, 1e-12, 9e-9, 1e-8, 2e-8, 1e-4, 1.0, 3.0, kPi - 1e-8, kPi - 1e-15}) {
    const Eigen::Vector3d vector = angle * UniformVector(generator, -1, 1).normalized();
    const Eigen::Quaterniond rotation = RotationFromVector(vector);
    const Eigen::Quaterniond negative(-rotation.coeffs());
    const double tolerance = 1e-15 * angle;  // relative: small rotations keep all their digits
    EXPECT_TRUE(AreNear(VectorFromRotation(rotation), vector, tolerance)) << "angle " << angle;
    EXPECT_TRUE(AreNear(VectorFromRotation(negative), vector, tolerance)) << "angle " << angle;
  }
}

TEST(Rigid3, VectorFromRotationTurnsByAtMostPi) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Quaterniond rotation = UniformRotation(generator);
    const Eigen::Vector3d vector = VectorFromRotation(rotation);
    EXPECT_LE(vector.norm(), kPi);
    EXPECT_TRUE(AreNear(ExponentialSeries(vector), rotation.toRotationMatrix(), 1e-14));
  }
  const Eigen::Vector3d half_turn = VectorFromRotation(Eigen::Quaterniond(0, 0, -1, 0));
  EXPECT_TRUE(AreNear(half_turn, Eigen::Vector3d(0, -kPi, 0), 1e-15));
}

TEST(Rigid3, DisplacedMovesTheOriginByVAndTurnsAboutIt) {
  std::mt19937_64 generator = TestGenerator();
  const Rigid3 b_from_a = RandomTransform(generator);
  const Vector6d displacement = RandomDisplacement(generator, 1);
  const Eigen::Vector3d x_in_a = UniformVector(generator, -1, 1);
  const Eigen::Vector3d arm_in_b = b_from_a.rotation * x_in_a;
  const Eigen::Vector3d expected =
      b_from_a.translation + displacement.head<3>() + ExponentialSeries(displacement.tail<3>()) * arm_in_b;
  EXPECT_TRUE(AreNear(Displaced(b_from_a, displacement) * x_in_a, expected, 1e-14));
}

TEST(Rigid3, DisplacementInvertsDisplaced) {
  std::mt19937_64 generator = TestGenerator();
  for (const double size : {0.0, 1e-8, 3.0}) {
    for (int i = 0; i < 100; ++i) {
      const Rigid3 from = RandomTransform(generator);
      const Vector6d displacement = RandomDisplacement(generator, size);
      EXPECT_TRUE(AreNear(Displacement(from, Displaced(from, displacement)), displacement, 4e-15));
    }
  }
}

TEST(Rigid3, MovedPointsAndTheirDerivativesAreThoseOfTheDisplacedTransform) {
  std::mt19937_64 generator = TestGenerator();
  for (const double size : {0.0, 1e-8, 3.0}) {
    for (int i = 0; i < 100; ++i) {
      const Rigid3 b_from_a = RandomTransform(generator);
      const Vector6d displacement = RandomDisplacement(generator, size);
      const Eigen::Vector3d x_in_a = UniformVector(generator, -1, 1);
      const MovedPoint moved = Move(b_from_a, displacement, x_in_a);
      const auto by_displacement = [&](const Vector6d& d) -> Eigen::Vector3d {
        return Displaced(b_from_a, d) * x_in_a;
      };
      const auto by_point = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        return Displaced(b_from_a, displacement) * x;
      };
      EXPECT_TRUE(AreNear(moved.x_in_b, by_point(x_in_a), 1e-14));
      EXPECT_TRUE(AreNear(moved.d_x_in_a, NumericJacobian(by_point, x_in_a), 1e-10));
      EXPECT_TRUE(AreNear(moved.d_displacement, NumericJacobian(by_displacement, displacement), 1e-9));
    }
  }
}

TEST(Rigid3, DisplacedKeepsTheRotationAUnitOverManySteps) {
  std::mt19937_64 generator = TestGenerator();
  Rigid3 pose = RandomTransform(generator);
  for (int i = 0; i < 100000; ++i) pose = Displaced(pose, Vector6d::Constant(1e-3));
  EXPECT_NEAR(pose.rotation.norm(), 1, 1e-15);
}

std::vector<Eigen::Vector3d> Transformed(const Rigid3& b_from_a, const std::vector<Eigen::Vector3d>& x_in_a) {
  std::vector<Eigen::Vector3d> x_in_b;
  x_in_b.reserve(x_in_a.size());
  for (const Eigen::Vector3d& x : x_in_a) x_in_b.push_back(b_from_a * x);
  return x_in_b;
}

TEST(FitRigid, RecoversTheTransformOfPointsInSpaceAndInAPlane) {
  std::mt19937_64 generator = TestGenerator();
  for (const double height : {0.0, 1e-8, 1.0}) {
    for (const size_t count : {3, 4, 6, 50}) {
      std::vector<Eigen::Vector3d> x_in_a = {{1, 0, 0}, {0, 1, 0}};  // far apart: no sliver of a triangle
      while (x_in_a.size() < count) {
        x_in_a.push_back(UniformVector(generator, -1, 0).cwiseProduct(Eigen::Vector3d(1, 1, height)));
      }
      const Rigid3 b_from_a = RandomTransform(generator);
      const Rigid3 fit = FitRigid(x_in_a, Transformed(b_from_a, x_in_a));
      EXPECT_TRUE(AreNear(Displacement(b_from_a, fit), Vector6d::Zero(), 1e-12));
    }
  }
}

double SumOfSquares(const Rigid3& b_from_a, const std::vector<Eigen::Vector3d>& x_in_a,
                    const std::vector<Eigen::Vector3d>& x_in_b) {
  double sum = 0;
  for (size_t i = 0; i < x_in_a.size(); ++i) sum += (b_from_a * x_in_a[i] - x_in_b[i]).squaredNorm();
  return sum;
}

// Noise as large as the points themselves also makes the best orthogonal matrix a reflection now and then.
TEST(FitRigid, NoNeighbourFitsNoisyPointsBetter) {
  std::mt19937_64 generator = TestGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Eigen::Vector3d> x_in_a, x_in_b;
    for (int i = 0; i < 4; ++i) {
      x_in_a.push_back(UniformVector(generator, -1, 1));
      x_in_b.push_back(UniformVector(generator, -1, 1));
    }
    const Rigid3 fit = FitRigid(x_in_a, x_in_b);
    const double least = SumOfSquares(fit, x_in_a, x_in_b);
    EXPECT_NEAR(fit.rotation.norm(), 1, 1e-14);
    for (int i = 0; i < 20; ++i) {
      const Rigid3 neighbour = Displaced(fit, RandomDisplacement(generator, 0.1));
      EXPECT_GE(SumOfSquares(neighbour, x_in_a, x_in_b), least - 1e-14);
    }
  }
}

TEST(FitRigid, RefusesPointsThatDetermineNoTransform) {
  const std::vector<Eigen::Vector3d> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Eigen::Vector3d> two = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<Eigen::Vector3d> line = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  const std::vector<Eigen::Vector3d> same = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  const std::vector<Eigen::Vector3d> not_finite = {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(FitRigid(two, two), std::invalid_argument);
  EXPECT_THROW(FitRigid(three, two), std::invalid_argument);
  EXPECT_THROW(FitRigid(line, three), std::invalid_argument);
  EXPECT_THROW(FitRigid(three, line), std::invalid_argument);
  EXPECT_THROW(FitRigid(same, same), std::invalid_argument);
  EXPECT_THROW(FitRigid(three, not_finite), std::invalid_argument);
}

}  // namespace
}  // namespace legible
