// What bounded joint errors can do to the platform at a pose, as sets: the kinematics polyhedron of the
// infinity norm and the ellipsoid of the 2-norm (Merlet 2006, section 3, figure 2).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "accuracy/platform_jacobian.h"
#include "accuracy/polyhedron.h"

namespace legible {

// Semi-axes (descending) and their directions, a unit column each.
struct Ellipsoid {
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
};

// Position errors (m) or rotation errors (rotation vectors, rad) of all joint errors within their bounds, and
// of all whose bound-wise 2-norm is at most 1. The polyhedron is missing where it is flat.
struct ErrorSet {
  std::optional<Polyhedron> polyhedron;
  Ellipsoid ellipsoid;
};

struct ErrorSets {
  ErrorSet position, rotation;
  // Of the polyhedron in all six coordinates, a parallelepiped of 64 vertices and 12 facets: |det J| prod(2
  // bound), m^3 rad^3; 0 where there are fewer joints than coordinates.
  double volume_6d = 0;
};

// Throws std::invalid_argument for a singular pose or bounds that do not fit.
ErrorSets ErrorSetsOf(const PlatformJacobian& jacobian, const Eigen::VectorXd& bounds);

}  // namespace legible
