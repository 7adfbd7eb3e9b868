// What the camera saw of the legs in one image: points on their edges.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/rigid3.h"

namespace legible {

// A measured point of a leg's edge, in distorted pixels.
struct EdgeSample {
  Eigen::Vector2d point_px;
  Eigen::Vector2d normal_px;  // unit, away from the leg: the direction along which the place was measured
  double sigma_px = 0;        // of the place along normal_px, independent of the other samples
};

// One edge of one leg in one image.
struct EdgeObservation {
  int leg = 0;                      // 0-based
  int edge = 0;                     // 0 or 1: outline normal n1 or n2 of CylinderOutline
  std::vector<EdgeSample> samples;  // in order along the edge
  // Of an error that all samples share because one model of the leg's shading gave them all; 0: none.
  double common_sigma_px = 0;
};

// Where the samples lie along their edge, from -1 (first) to 1 (last).
inline Eigen::VectorXd PlacesAlong(const EdgeObservation& edge) {
  const Eigen::Index count = static_cast<Eigen::Index>(edge.samples.size());
  Eigen::VectorXd places = Eigen::VectorXd::Zero(count);
  if (count < 2) return places;
  const Eigen::Vector2d first = edge.samples.front().point_px;
  const Eigen::Vector2d span = edge.samples.back().point_px - first;
  for (Eigen::Index i = 0; i < count; ++i)
    places[i] = 2 * span.dot(edge.samples[static_cast<size_t>(i)].point_px - first) / span.squaredNorm() - 1;
  return places;
}

// One image's measurements: everything the estimator takes from it.
struct ImageObservation {
  std::string name;
  std::optional<Vector6d> joint_readings_m;
  std::vector<EdgeObservation> edges;
};

}  // namespace legible
