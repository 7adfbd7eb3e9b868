// Three points on circles that satisfy a condition for each two of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/algebra/ball.h"
#include "core/algebra/root_certificate.h"

namespace legible {

// By the multihomogeneous Bezout theorem: in the tangents of half the angles every condition is of degree 2
// in each of its two.
inline constexpr int kPointsOnCirclesRootCount = 16;

// Condition k between points k and k + 1, the last one between points 2 and 0: for their angles a and b
//   (1, cos a, sin a) matrix (1, cos b, sin b)^T = 0.
using CircleConditions = std::array<Eigen::Matrix<RealBall, 3, 3>, 3>;

struct PointsOnCirclesRoots {
  std::vector<CertifiedRoot> roots;  // (cos, sin) of points 0, 1, 2; complex, proved to differ
  bool is_complete = false;          // all sixteen, so that there is no other
  int missing = 0;                   // sixteen less what was certified
};

// By paths from the roots of a system whose conditions are products of a factor for each angle, so that its
// sixteen roots are known; their ends are certified on the system itself.
PointsOnCirclesRoots AllRoots(const CircleConditions& conditions);

}  // namespace legible
