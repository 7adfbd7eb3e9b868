// Convex polyhedra about the origin: Merlet's kinematics polyhedron and what two of them have in common.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace legible {

// In d dimensions: the points x with normals^T x <= offsets.
struct Polyhedron {
  Eigen::MatrixXd vertices;              // d x n
  Eigen::MatrixXd normals;               // d x f, unit, outward
  Eigen::VectorXd offsets;               // f
  std::vector<std::vector<int>> facets;  // of each normal: its vertices; in 3-D counterclockwise from outside
  double volume = 0;
};

// The convex hull of points (d x n, d of 2 to 6), by Qhull. Nothing where they span no volume.
std::optional<Polyhedron> ConvexHull(const Eigen::MatrixXd& points);

// What lies in both. Both must hold the origin inside, as polyhedra of errors do. Throws
// std::invalid_argument where one does not, or the dimensions differ.
Polyhedron Intersection(const Polyhedron& a, const Polyhedron& b);

}  // namespace legible
