// A hexapod before a camera, and the edges of its legs as the camera sees them: exact, or moved by known
// noise.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <utility>

#include "core/geometry/cylinder_outline.h"
#include "core/geometry/tangents.h"
#include "core/vision/seen_edges.h"
#include "datasets/synthetic_session.h"
#include "tests/accuracy/random_hexapod.h"
#include "tests/testing/random.h"

namespace legible {

struct HexapodView {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base, base_from_platform;
};

// A perturbed desktop robot about home, looked at from 0.8 to 1.1 m away; its joint ranges are wide.
inline HexapodView RandomView(std::mt19937_64& generator) {
  HexapodAtPose hexapod = RandomHexapod(generator);
  for (Leg& leg : hexapod.robot.legs) {
    leg.joint_range_m = {0.1, 1};
    leg.radius_m = Uniform(generator, 0.006, 0.015);
  }
  const double around_rad = Uniform(generator, -3, 3), distance_m = Uniform(generator, 0.8, 1.1);
  const Eigen::Vector3d place(distance_m * std::cos(around_rad), distance_m * std::sin(around_rad),
                              Uniform(generator, 0.1, 0.5));
  return {hexapod.robot, DesktopCamera(false), LookAt(place, {0, 0, 0.15}), hexapod.pose};
}

// Up to that far in each coordinate, m, and ten times as many rad.
inline Rigid3 Nearby(const Rigid3& pose, double most_m, std::mt19937_64& generator) {
  Vector6d displacement;
  displacement << UniformVector(generator, -most_m, most_m),
      10 * UniformVector(generator, -most_m, most_m) / 3;
  return Displaced(pose, displacement);
}

// Both edges of all legs, from joint to joint, without noise: by the outline of a cylinder.
inline SeenEdges EdgesOf(const GoughStewart& robot, const Rigid3& camera_from_base,
                         const Rigid3& base_from_platform) {
  SeenEdges seen;
  for (int i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[static_cast<size_t>(i)];
    const Eigen::Vector3d a = camera_from_base * leg.base_joint_m;
    const Eigen::Vector3d b = camera_from_base * (base_from_platform * leg.platform_joint_m);
    const auto normals = CylinderOutline(LineThrough<double>(a, b), leg.radius_m);
    for (int edge = 0; edge < 2; ++edge) {
      const Eigen::Vector3d& normal = normals[static_cast<size_t>(edge)];
      const Eigen::Vector3d aside = leg.radius_m * normal;
      seen.edges.push_back(
          {i, edge, normal, Eigen::Matrix3d::Zero(), {(a + aside).hnormalized(), (b + aside).hnormalized()}});
    }
  }
  return seen;
}

// Only the edges for which keep(leg, edge) holds.
template <typename Keep>
SeenEdges Only(const SeenEdges& seen, const Keep& keep) {
  SeenEdges kept;
  kept.time_s = seen.time_s;
  for (const SeenEdge& edge : seen.edges)
    if (keep(edge.leg, edge.edge)) kept.edges.push_back(edge);
  return kept;
}

// A covariance of rank 2 of each edge's normal, of its own size and shape: some sigma_rad.
inline void GiveCovariances(SeenEdges& seen, double sigma_rad, std::mt19937_64& generator) {
  for (SeenEdge& edge : seen.edges) {
    Eigen::Matrix2d root;
    root << Uniform(generator, 0.3, 2), 0, Uniform(generator, -1, 1), Uniform(generator, 0.3, 2);
    const Eigen::Matrix<double, 3, 2> spread = sigma_rad * TangentsOf(edge.normal) * root;
    edge.normal_covariance = spread * spread.transpose();
  }
}

// Each normal moved by a draw of its covariance.
inline SeenEdges Moved(SeenEdges seen, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  for (SeenEdge& edge : seen.edges) {
    const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(edge.normal);
    const Eigen::LLT<Eigen::Matrix2d> root(
        Eigen::Matrix2d(tangents.transpose() * edge.normal_covariance * tangents));
    const Eigen::Vector2d draw(normal(generator), normal(generator));
    edge.normal = (edge.normal + tangents * (root.matrixL() * draw)).normalized();
  }
  return seen;
}

}  // namespace legible
