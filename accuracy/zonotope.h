// The set of errors that independently bounded parameters can add up to: a zonotope, the image of a box under
// a linear map.
#pragma once

#include <Eigen/Core>

namespace legible {

// All sums of +-generators (3 x m, a column each): the images of the box's 2^m corners, some of which lie
// inside the zonotope. Throws std::invalid_argument for more than 12 generators.
Eigen::Matrix3Xd SignVertices(const Eigen::Matrix3Xd& generators);

// The point of the zonotope that lies farthest from its centre: exact for any number of generators, from its
// O(m^2) vertices. Parallel, coplanar and zero generators are allowed.
Eigen::Vector3d FarthestPoint(const Eigen::Matrix3Xd& all_generators);

}  // namespace legible
