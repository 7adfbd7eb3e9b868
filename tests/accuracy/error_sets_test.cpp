#include "accuracy/error_sets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "accuracy/maximal_errors.h"
#include "accuracy/vertex_check.h"
#include "accuracy/zonotope.h"
#include "tests/accuracy/random_hexapod.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

Eigen::Matrix3Xd RandomGenerators(std::mt19937_64& generator, int count) {
  Eigen::Matrix3Xd generators(3, count);
  for (int k = 0; k < count; ++k) generators.col(k) = UniformVector(generator, -1, 1);
  return generators;
}

double FarthestOfAllCorners(const Eigen::Matrix3Xd& generators) {
  return SignVertices(generators).colwise().norm().maxCoeff();
}

// Volume of a zonotope: 8 times the sum of |det| over all triples of generators (McMullen).
double ZonotopeVolume(const Eigen::Matrix3Xd& g) {
  double sum = 0;
  for (Eigen::Index i = 0; i < g.cols(); ++i)
    for (Eigen::Index j = i + 1; j < g.cols(); ++j)
      for (Eigen::Index k = j + 1; k < g.cols(); ++k) sum += std::abs(g.col(i).cross(g.col(j)).dot(g.col(k)));
  return 8 * sum;
}

struct Case {
  HexapodAtPose at;
  PlatformJacobian jacobian;
  Vector6d bounds_m;
};
Case RandomCase(std::mt19937_64& generator) {
  const HexapodAtPose at = RandomHexapod(generator);
  Case drawn{at, Invert(FullInverseJacobianOf(at.robot, at.pose)), {}};
  drawn.bounds_m << UniformVector(generator, 1e-5, 2e-4), UniformVector(generator, 1e-5, 2e-4);
  return drawn;
}

TEST(FarthestPoint, IsThatOfAllSignVertices) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 200; ++n) {
    const Eigen::Matrix3Xd generators = RandomGenerators(generator, 1 + n % 12);
    EXPECT_NEAR(FarthestPoint(generators).norm(), FarthestOfAllCorners(generators), 1e-12);
  }
}

TEST(FarthestPoint, IsExactForParallelCoplanarAndZeroGenerators) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 100; ++n) {
    Eigen::Matrix3Xd generators = RandomGenerators(generator, 10);
    generators.row(2).head(n % 11).setZero();  // many in one plane
    generators.col(3) = -2 * generators.col(0);
    generators.col(4).setZero();
    generators.col(5) = generators.col(1) + generators.col(2);
    EXPECT_NEAR(FarthestPoint(generators).norm(), FarthestOfAllCorners(generators), 1e-12);
  }
  EXPECT_EQ(FarthestPoint(Eigen::Matrix3Xd::Zero(3, 4)).norm(), 0);
  EXPECT_NEAR(FarthestPoint(Eigen::Vector3d(3, 4, 0)).norm(), 5, 1e-15);
}

TEST(MaximalErrors, AreThoseOfTheWorstCornerOfTheJointErrors) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const Case drawn = RandomCase(generator);
    const MaximalErrors errors = MaximalErrorsOf(drawn.jacobian, drawn.bounds_m);
    const Eigen::Matrix<double, 6, 64> corners = [&] {
      Eigen::Matrix<double, 6, 64> all;
      for (int corner = 0; corner < 64; ++corner) {
        Vector6d error_m = drawn.bounds_m;
        for (int i = 0; i < 6; ++i)
          if ((corner >> i & 1) != 0) error_m[i] = -error_m[i];
        all.col(corner) = drawn.jacobian.matrix * error_m;
      }
      return all;
    }();
    EXPECT_TRUE(AreNear(errors.of_coordinate, corners.cwiseAbs().rowwise().maxCoeff(), 1e-15));
    EXPECT_NEAR(errors.position_m(), corners.topRows<3>().colwise().norm().maxCoeff(), 1e-15);
    EXPECT_NEAR(errors.rotation_rad(), corners.bottomRows<3>().colwise().norm().maxCoeff(), 1e-14);
  }
}

TEST(MaximalErrors, DoNotDependOnTheBaseFrameWhereTheyHaveNoDirection) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Case drawn = RandomCase(generator);
    const HexapodAtPose elsewhere = InAnotherBase(drawn.at, generator);
    const auto here = MaximalErrorsOf(drawn.jacobian, drawn.bounds_m);
    const auto there =
        MaximalErrorsOf(Invert(FullInverseJacobianOf(elsewhere.robot, elsewhere.pose)), drawn.bounds_m);
    EXPECT_NEAR(there.position_m() / here.position_m(), 1, 1e-9);
    EXPECT_NEAR(there.rotation_rad() / here.rotation_rad(), 1, 1e-9);
  }
}

TEST(MaximalErrors, RefuseBoundsThatDoNotFitAndSingularPoses) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  EXPECT_THROW(MaximalErrorsOf(drawn.jacobian, Eigen::VectorXd::Ones(5)), std::invalid_argument);
  EXPECT_THROW(MaximalErrorsOf(drawn.jacobian, -drawn.bounds_m), std::invalid_argument);
  EXPECT_THROW(MaximalErrorsOf(PlatformJacobian(), drawn.bounds_m), std::invalid_argument);
}

TEST(KinematicsPolyhedron, HasTheVolumeOfItsZonotopeAndTheExtentsOfTheMaximalErrors) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const Case drawn = RandomCase(generator);
    const ErrorSets sets = ErrorSetsOf(drawn.jacobian, drawn.bounds_m);
    const MaximalErrors errors = MaximalErrorsOf(drawn.jacobian, drawn.bounds_m);
    const Eigen::MatrixXd generators = drawn.jacobian.matrix * drawn.bounds_m.asDiagonal();
    ASSERT_TRUE(sets.position.polyhedron && sets.rotation.polyhedron);
    const Polyhedron& position = *sets.position.polyhedron;
    const Polyhedron& rotation = *sets.rotation.polyhedron;
    EXPECT_NEAR(position.volume / ZonotopeVolume(generators.topRows<3>()), 1, 1e-9);
    EXPECT_NEAR(rotation.volume / ZonotopeVolume(generators.bottomRows<3>()), 1, 1e-9);
    EXPECT_TRUE(
        AreNear(position.vertices.cwiseAbs().rowwise().maxCoeff(), errors.of_coordinate.head<3>(), 1e-14));
    EXPECT_TRUE(
        AreNear(rotation.vertices.cwiseAbs().rowwise().maxCoeff(), errors.of_coordinate.tail<3>(), 1e-13));
    EXPECT_NEAR(position.vertices.colwise().norm().maxCoeff(), errors.position_m(), 1e-15);
    EXPECT_NEAR(sets.volume_6d, 64 * std::abs(generators.determinant()), 1e-12 * sets.volume_6d);
  }
}

TEST(KinematicsPolyhedron, HasThirtyParallelogramsFacingOutwardsAndEulersNumbers) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const Polyhedron polyhedron = *ErrorSetsOf(drawn.jacobian, drawn.bounds_m).position.polyhedron;
  EXPECT_EQ(polyhedron.facets.size(), 30u);   // 2 for each pair of six generators
  EXPECT_EQ(polyhedron.vertices.cols(), 32);  // m (m - 1) + 2
  size_t edges_twice = 0;
  for (size_t i = 0; i < polyhedron.facets.size(); ++i) {
    const std::vector<int>& facet = polyhedron.facets[i];
    edges_twice += facet.size();
    ASSERT_EQ(facet.size(), 4u);
    const Eigen::Vector3d a = polyhedron.vertices.col(facet[0]), b = polyhedron.vertices.col(facet[1]),
                          c = polyhedron.vertices.col(facet[2]);
    EXPECT_GT((b - a).cross(c - b).dot(polyhedron.normals.col(static_cast<Eigen::Index>(i))), 0);
    EXPECT_NEAR(polyhedron.normals.col(static_cast<Eigen::Index>(i)).dot(a),
                polyhedron.offsets[static_cast<Eigen::Index>(i)], 1e-15);
  }
  EXPECT_EQ(polyhedron.vertices.cols() - static_cast<Eigen::Index>(edges_twice / 2) + 30, 2);
}

TEST(KinematicsPolyhedron, HoldsTheEllipsoidOfTheTwoNorm) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const ErrorSet set = ErrorSetsOf(drawn.jacobian, drawn.bounds_m).position;
  // The ellipsoid reaches sqrt(n^T E n) along n, E = J diag(bounds^2) J^T.
  const Eigen::Matrix3d e = set.ellipsoid.directions * set.ellipsoid.semi_axes.cwiseAbs2().asDiagonal() *
                            set.ellipsoid.directions.transpose();
  const Eigen::MatrixXd generators = (drawn.jacobian.matrix * drawn.bounds_m.asDiagonal()).topRows<3>();
  EXPECT_TRUE(AreNear(e, generators * generators.transpose(), 1e-16));
  for (Eigen::Index i = 0; i < set.polyhedron->normals.cols(); ++i) {
    const Eigen::Vector3d n = set.polyhedron->normals.col(i);
    EXPECT_LE(std::sqrt(n.dot(e * n)), set.polyhedron->offsets[i] * (1 + 1e-12));
  }
}

TEST(ConvexHull, OfTheCubesCornersAndInnerPointsIsTheCubeInThreeAndSixDimensions) {
  for (const int dimension : {3, 6}) {
    const int corners = 1 << dimension;
    Eigen::MatrixXd points = Eigen::MatrixXd::Zero(dimension, corners + 1);
    for (int i = 0; i < corners; ++i)
      for (int axis = 0; axis < dimension; ++axis) points(axis, i) = (i >> axis & 1) != 0 ? 0.5 : -0.5;
    const auto cube = ConvexHull(points);
    ASSERT_TRUE(cube);
    EXPECT_NEAR(cube->volume, 1, 1e-12);
    EXPECT_EQ(cube->vertices.cols(), corners);
  }
}

TEST(ConvexHull, OfPointsInAPlaneIsNone) {
  Eigen::MatrixXd flat(3, 5);
  flat << 0, 1, 0, 1, 0.5, 0, 0, 1, 1, 0.5, 1, 1, 1, 1, 1;
  EXPECT_FALSE(ConvexHull(flat));
}

TEST(Intersection, OfTwoBoxesIsTheBoxOfTheSmallerSides) {
  const auto box = [](const Eigen::Vector3d& half) {
    return *ConvexHull(half.asDiagonal() * SignVertices(Eigen::Matrix3d::Identity()));
  };
  const Polyhedron common = Intersection(box({1, 2, 3}), box({2, 1, 3.5}));
  EXPECT_NEAR(common.volume, 8 * 1 * 1 * 3, 1e-12);
  EXPECT_EQ(common.vertices.cols(), 8);
  EXPECT_EQ(common.facets.size(), 6u);
}

TEST(Intersection, OfTwoPosesErrorsHoldsWhatBothHoldAndNothingElse) {
  std::mt19937_64 generator = TestGenerator();
  const Case first = RandomCase(generator), second = RandomCase(generator);
  const Polyhedron a = *ErrorSetsOf(first.jacobian, first.bounds_m).position.polyhedron;
  const Polyhedron b = *ErrorSetsOf(second.jacobian, second.bounds_m).position.polyhedron;
  const Polyhedron common = Intersection(a, b);
  const auto holds = [](const Polyhedron& p, const Eigen::Vector3d& x) {
    return ((p.normals.transpose() * x).array() <= p.offsets.array()).all();
  };
  const Eigen::Vector3d half = a.vertices.cwiseAbs().rowwise().maxCoeff();
  int inside = 0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d x = half.cwiseProduct(UniformVector(generator, -1, 1));
    EXPECT_EQ(holds(common, x), holds(a, x) && holds(b, x));
    inside += holds(common, x);
  }
  const double share = static_cast<double>(inside) / kPoints;
  EXPECT_NEAR(common.volume / (8 * half.prod()), share, 5 * std::sqrt(share / kPoints));
  EXPECT_THROW(Intersection(a, Polyhedron()), std::invalid_argument);
}

TEST(VertexCheck, DifferenceFromTheLinearAnswerGrowsWithTheSquareOfTheJointErrors) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const VertexCheck once = CheckAtVertices(drawn.at.robot, drawn.at.pose, drawn.bounds_m);
  const VertexCheck ten = CheckAtVertices(drawn.at.robot, drawn.at.pose, 10 * drawn.bounds_m);
  ASSERT_TRUE(once.converged && ten.converged);
  EXPECT_GT(once.relative, 0);
  EXPECT_LT(once.relative, 0.01);
  EXPECT_NEAR(ten.position_difference_m / once.position_difference_m, 100, 5);
  EXPECT_NEAR(ten.rotation_difference_rad / once.rotation_difference_rad, 100, 5);
}

}  // namespace
}  // namespace legible
