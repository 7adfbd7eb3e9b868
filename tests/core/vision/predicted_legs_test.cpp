#include "core/vision/predicted_legs.h"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/edge_distance.h"
#include "tests/core/vision/scene.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

TEST(EdgePointNear, LiesOnTheOutlineWithItsNormalAcrossIt) {
  for (const bool is_distorted : {false, true}) {
    const Scene scene(is_distorted);
    for (const LegInCamera& leg : scene.Legs())
      for (const Eigen::Vector3d& normal :
           CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera), leg.radius_m))
        for (const double share : {0.1, 0.4, 0.8}) {
          const auto at = [&](double s) {
            return EdgePointNear(scene.camera, normal, leg.AxisPoint(s) + leg.radius_m * normal).value();
          };
          const ImagePointOnEdge found = at(share);
          const Eigen::Vector3d x = Unproject(scene.camera, found.point_px).value().homogeneous();
          EXPECT_NEAR(normal.dot(x) / normal.head<2>().norm(), 0, 1e-12);
          EXPECT_NEAR(found.normal_px.norm(), 1, 1e-12);
          const Eigen::Vector2d tangent =
              (at(share + 1e-4).point_px - at(share - 1e-4).point_px).normalized();
          EXPECT_NEAR(found.normal_px.dot(tangent), 0, 1e-6);
          const Eigen::Vector2d outward = found.point_px - Project(scene.camera, leg.AxisPoint(share));
          EXPECT_GT(found.normal_px.dot(outward), 0);
        }
  }
}

TEST(EdgePointNear, HasNoValueBehindTheCamera) {
  EXPECT_FALSE(EdgePointNear(DesktopCamera(true), {1, 0, 0}, {0, 0, -1}));
}

TEST(PlaceLegs, PutsTheJointsIntoTheCameraFrame) {
  const Scene scene(false);
  const LegsInCamera legs = scene.Legs();
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = scene.robot.legs[i];
    EXPECT_TRUE(AreNear(legs[i].a_in_camera, scene.camera_from_base * leg.base_joint_m, 1e-15));
    EXPECT_TRUE(AreNear(legs[i].b_in_camera,
                        (scene.camera_from_base * scene.base_from_platform) * leg.platform_joint_m, 1e-15));
    EXPECT_EQ(legs[i].radius_m, leg.radius_m);
  }
}

// Depth at which the sight line meets the cylinder between its ends; infinite where it does not.
double DepthOf(const LegInCamera& leg, const Eigen::Vector3d& sight) {
  const Eigen::Vector3d axis = leg.b_in_camera - leg.a_in_camera, u = axis.normalized();
  const Eigen::Vector3d across = sight - sight.dot(u) * u, a = leg.a_in_camera - leg.a_in_camera.dot(u) * u;
  const double p = across.squaredNorm(), q = across.dot(a);
  const double root = q * q - p * (a.squaredNorm() - leg.radius_m * leg.radius_m);
  if (root < 0) return std::numeric_limits<double>::infinity();
  const double depth = (q - std::sqrt(root)) / p;
  const double along = (depth * sight - leg.a_in_camera).dot(u);
  return along < 0 || along > axis.norm() ? std::numeric_limits<double>::infinity() : depth;
}

TEST(PredictEdges, WhatIsVisibleHasNoLegInFront) {
  std::mt19937_64 generator = TestGenerator();
  int visible = 0, hidden = 0;
  for (int pose = 0; pose < 20; ++pose) {
    Scene scene(true);
    Vector6d displacement;
    displacement << UniformVector(generator, -0.04, 0.04), UniformVector(generator, -0.2, 0.2);
    scene.base_from_platform = Displaced(scene.base_from_platform, displacement);
    const LegsInCamera legs = scene.Legs();
    const PredictedEdges edges = PredictEdges(legs, scene.camera, {});
    for (size_t leg = 0; leg < kLegCount; ++leg)
      for (const PredictedEdge& edge : edges[leg])
        for (const PredictedEdgePoint& point : edge.points) {
          const Eigen::Vector3d touch = legs[leg].AxisPoint(point.share) + legs[leg].radius_m * edge.normal;
          double nearest = std::numeric_limits<double>::infinity();
          for (size_t other = 0; other < kLegCount; ++other)
            if (other != leg) nearest = std::min(nearest, DepthOf(legs[other], touch / touch.z()));
          if (point.obstacle == EdgeObstacle::kNone) {
            ++visible;
            EXPECT_GT(nearest, touch.z()) << "leg " << leg + 1 << " at " << point.share;
          } else if (nearest < touch.z()) {
            ++hidden;
          }
        }
  }
  EXPECT_GT(visible, 1000);
  EXPECT_GT(hidden, 100);
}

// Two legs that cross in the image, the first in front; the others stand far to the side. A platform without
// margin.
LegsInCamera CrossingLegs() {
  LegsInCamera legs;
  legs[0] = {{-0.1, 0.2, 0.8}, {0.1, -0.2, 0.8}, 0.01};
  legs[1] = {{0.1, 0.2, 1.0}, {-0.1, -0.2, 1.0}, 0.01};
  for (int i = 2; i < kLegCount; ++i)
    legs[static_cast<size_t>(i)] = {{0.2 + 0.05 * i, 0.2, 1.0}, {0.2 + 0.05 * i, -0.2, 1.0}, 0.005};
  return legs;
}

TEST(PredictEdges, ALegInFrontHidesTheOneBehindWhereTheyCrossAndNowhereElse) {
  const LegsInCamera legs = CrossingLegs();
  Camera camera = DesktopCamera(false);
  const PredictedEdges edges = PredictEdges(legs, camera, {});
  for (const PredictedEdge& edge : edges[1]) {
    ASSERT_FALSE(edge.points.empty());
    for (const PredictedEdgePoint& point : edge.points) {
      const Eigen::Vector3d touch = legs[1].AxisPoint(point.share) + legs[1].radius_m * edge.normal;
      if (std::isfinite(DepthOf(legs[0], touch / touch.z()))) {
        EXPECT_EQ(point.obstacle, EdgeObstacle::kOtherLeg);
        EXPECT_EQ(point.obstacle_leg, 0);
        EXPECT_EQ(Describe(point), "hidden or crossed by leg 1");
      }
      if (point.share > 0.1 && point.share < 0.35) {
        EXPECT_EQ(point.obstacle, EdgeObstacle::kNone) << point.share;
      }
    }
  }
}

TEST(PredictEdges, KeepsAwayFromTheJointsAndTheImageBorder) {
  const Scene scene(false);
  VisibilityOptions options;
  options.margin_px = 12;
  for (const auto& leg : PredictEdges(scene.Legs(), scene.camera, options))
    for (const PredictedEdge& edge : leg) {
      ASSERT_FALSE(edge.points.empty());
      EXPECT_EQ(edge.points.front().obstacle, EdgeObstacle::kJoint);
      EXPECT_EQ(edge.points.back().obstacle, EdgeObstacle::kJoint);
      for (const PredictedEdgePoint& point : edge.points)
        if (point.obstacle == EdgeObstacle::kNone) {
          EXPECT_GE(point.point_px.minCoeff(), 12);
          EXPECT_LE(point.point_px.x(), scene.camera.width_px - 13);
          EXPECT_LE(point.point_px.y(), scene.camera.height_px - 13);
        }
    }
}

TEST(PredictEdges, HalfWidthIsThatOfTheLegInTheImage) {
  const LegsInCamera legs = CrossingLegs();
  const Camera camera = DesktopCamera(false);
  EXPECT_NEAR(PredictEdges(legs, camera, {})[1][0].half_width_px, camera.fx_px * 0.01 / 1.0, 0.2);
}

TEST(PredictEdges, ALegBehindTheCameraHasNone) {
  LegsInCamera legs = CrossingLegs();
  legs[3].b_in_camera.z() = -0.1;
  const PredictedEdges edges = PredictEdges(legs, DesktopCamera(false), {});
  EXPECT_TRUE(edges[3][0].points.empty());
  EXPECT_TRUE(edges[3][1].points.empty());
}

}  // namespace
}  // namespace legible
