#include "core/geometry/cylinder_outline.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;

// A leg by two points of its axis in the camera frame (m) and its radius (m).
struct Cylinder {
  Eigen::Vector3d a_in_camera;
  Eigen::Vector3d b_in_camera;
  double radius_m;

  PluckerLine<double> Axis() const { return LineThrough(a_in_camera, b_in_camera); }
};

// A leg about a metre in front of the camera, of any direction whose line keeps 0.1 m away from it.
Cylinder RandomCylinder(std::mt19937_64& generator) {
  const Eigen::Vector3d centre = Eigen::Vector3d(0, 0, 1) + UniformVector(generator, -0.3, 0.3);
  for (;;) {
    const Eigen::Vector3d half = 0.2 * (UniformRotation(generator) * Eigen::Vector3d::UnitX());
    Cylinder leg{centre - half, centre + half, Uniform(generator, 0.003, 0.03)};
    if (leg.Axis().moment.norm() > 0.1) return leg;
  }
}

// The distance of the axis from the line of sight through a direction of the camera frame, from vector
// algebra.
double DistanceFromSightRay(const Cylinder& leg, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d common_normal = ray.cross(leg.b_in_camera - leg.a_in_camera);
  return std::abs(leg.a_in_camera.dot(common_normal)) / common_normal.norm();
}

// A point of the cylinder's surface: along the axis by `along` lengths, about it by `angle_rad`.
Eigen::Vector3d SurfacePoint(const Cylinder& leg, double along, double angle_rad) {
  const Eigen::Vector3d u = leg.Axis().direction;
  const Eigen::Vector3d across = u.unitOrthogonal();
  return leg.a_in_camera + along * (leg.b_in_camera - leg.a_in_camera) +
         leg.radius_m * (std::cos(angle_rad) * across + std::sin(angle_rad) * u.cross(across));
}

TEST(CylinderOutline, NormalsAreUnitAndHoldTheAxisAtMinusTheRadius) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 1000; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    for (const Eigen::Vector3d& n : CylinderOutline(leg.Axis(), leg.radius_m)) {
      EXPECT_NEAR(n.norm(), 1, 1e-14);
      EXPECT_NEAR(n.dot(leg.Axis().direction), 0, 1e-14);
      EXPECT_NEAR(n.dot(leg.a_in_camera), -leg.radius_m, 1e-14);
      EXPECT_NEAR(n.dot(leg.b_in_camera), -leg.radius_m, 1e-14);
    }
  }
}

TEST(CylinderOutline, EverySightRayOnAnEdgeTouchesTheCylinder) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 1000; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    for (const Eigen::Vector3d& n : CylinderOutline(leg.Axis(), leg.radius_m)) {
      const Eigen::Vector3d foot = leg.a_in_camera + leg.radius_m * n;  // where the plane of sight touches
      const Eigen::Vector3d ray = foot + Uniform(generator, -1, 2) * (leg.b_in_camera - leg.a_in_camera);
      EXPECT_NEAR(n.dot(ray), 0, 1e-14);
      EXPECT_NEAR(DistanceFromSightRay(leg, ray), leg.radius_m, 1e-12);
    }
  }
}

TEST(CylinderOutline, LineOfAnEdgeInTheImageIsTheBorderOfTheDrawnCylinder) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kAngles = 3600;
  for (int i = 0; i < 100; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    for (const Eigen::Vector3d& n : CylinderOutline(leg.Axis(), leg.radius_m)) {
      double outermost = -1;
      for (int j = 0; j < kAngles; ++j) {
        const double angle_rad = 2 * std::numbers::pi * j / kAngles;
        outermost = std::max(outermost, n.dot(SurfacePoint(leg, Uniform(generator, 0, 1), angle_rad)));
      }
      EXPECT_LT(outermost, 1e-14);                 // none of the surface is outside
      EXPECT_GT(outermost, -1e-6 * leg.radius_m);  // 1 - cos of half the spacing of the angles
    }
  }
}

// With the axis vertical in the image of a camera that looks at it squarely, y down, u down: the line of
// sight to an edge leaves the axis at asin(R / d) to either side.
TEST(CylinderOutline, FirstEdgeIsOnTheRightOfADirectionAsTheCameraSeesIt) {
  const double distance_m = 0.8, radius_m = 0.01;
  const Cylinder leg{{0, -0.2, distance_m}, {0, 0.2, distance_m}, radius_m};
  const std::array<Eigen::Vector3d, 2> n = CylinderOutline(leg.Axis(), radius_m);
  const double theta = std::asin(radius_m / distance_m);
  EXPECT_TRUE(AreNear(n[0], Eigen::Vector3d(std::cos(theta), 0, -std::sin(theta)), 1e-15));
  EXPECT_TRUE(AreNear(n[1], Eigen::Vector3d(-std::cos(theta), 0, -std::sin(theta)), 1e-15));
}

TEST(CylinderOutline, EdgesMeetInTheVanishingPointOfTheAxis) {  // Andreff et al., eq. 13
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 1000; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    const std::array<Eigen::Vector3d, 2> n = CylinderOutline(leg.Axis(), leg.radius_m);
    EXPECT_TRUE(AreNear(n[0].cross(n[1]).normalized(), leg.Axis().direction, 1e-12));
  }
}

TEST(CylinderOutline, ReversedAxisSwapsTheEdges) {
  std::mt19937_64 generator = TestGenerator();
  const Cylinder leg = RandomCylinder(generator);
  const Cylinder reversed{leg.b_in_camera, leg.a_in_camera, leg.radius_m};
  const std::array<Eigen::Vector3d, 2> n = CylinderOutline(leg.Axis(), leg.radius_m);
  const std::array<Eigen::Vector3d, 2> swapped = CylinderOutline(reversed.Axis(), leg.radius_m);
  EXPECT_TRUE(AreNear(swapped[0], n[1], 1e-14));
  EXPECT_TRUE(AreNear(swapped[1], n[0], 1e-14));
}

TEST(CylinderOutline, CameraIsOutsideExactlyWhereTheAxisIsFartherThanTheRadius) {
  const PluckerLine<double> axis = LineThrough<double>({0, -1, 0.5}, {0, 1, 0.5});
  EXPECT_TRUE(CameraIsOutside(axis, 0.499999));
  EXPECT_FALSE(CameraIsOutside(axis, 0.5));
  EXPECT_FALSE(CameraIsOutside(axis, 0.6));
}

// The normal of one edge as a function of (A, B, R), through the closed form of the outline.
struct OutlineNormal {
  int edge;

  template <typename T>
  Eigen::Matrix<T, 3, 1> operator()(const Eigen::Matrix<T, 7, 1>& a_b_radius) const {
    const Eigen::Matrix<T, 3, 1> a = a_b_radius.template head<3>(), b = a_b_radius.template segment<3>(3);
    return CylinderOutline(LineThrough(a, b), T(a_b_radius[6]))[edge];
  }
};

TEST(OutlineJacobian, MatchesJetsAndCentralDifferencesOfTheClosedForm) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 200; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    Vector7d parameters;
    parameters << leg.a_in_camera, leg.b_in_camera, leg.radius_m;
    for (const int edge : {0, 1}) {
      const OutlineNormal normal{edge};
      const auto found = OutlineJacobian(leg.a_in_camera, leg.b_in_camera, normal(parameters));
      const double size = found.cwiseAbs().maxCoeff();
      EXPECT_TRUE(AreNear(found, JetJacobian(normal, parameters), 1e-12 * size));
      EXPECT_TRUE(AreNear(found, NumericJacobian(normal, parameters, 3e-5), 1e-9 * size));
    }
  }
}

// Andreff et al., eq. 27: with A and R fixed, dn = ((A.u / A.(u x n)) (u x n) - u) n^T du.
TEST(OutlineJacobian, IsThePapersForAFixedBaseJointAndRadius) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 100; ++i) {
    const Cylinder leg = RandomCylinder(generator);
    const Eigen::Vector3d a = leg.a_in_camera, u = leg.Axis().direction;
    const double length_m = (leg.b_in_camera - a).norm();
    const Eigen::Matrix3d direction_by_b = (Eigen::Matrix3d::Identity() - u * u.transpose()) / length_m;
    for (const Eigen::Vector3d& n : CylinderOutline(leg.Axis(), leg.radius_m)) {
      const Eigen::Vector3d t = u.cross(n);
      const Eigen::Matrix3d normal_by_direction = (a.dot(u) / a.dot(t) * t - u) * n.transpose();
      const auto found = OutlineJacobian(a, leg.b_in_camera, n);
      EXPECT_TRUE(AreNear(found.middleCols<3>(3), normal_by_direction * direction_by_b, 1e-11));
    }
  }
}

}  // namespace
}  // namespace legible
