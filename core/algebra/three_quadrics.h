// All common points of three quadrics in space.
#pragma once

#include <vector>

#include "core/algebra/quadric_system.h"
#include "core/algebra/root_certificate.h"

namespace legible {

inline constexpr int kThreeQuadricsRootCount = 8;  // by Bezout, with multiplicity and those at infinity

struct ThreeQuadricsRoots {
  std::vector<CertifiedRoot> roots;  // complex, proved to differ
  bool is_complete = false;          // all eight, so that there is no other
  int missing = 0;  // eight less what was certified: multiple, at infinity, or too close to tell
};

// The roots of a system of three quadrics in three unknowns, by elimination: the quadrics give y^2, yz and
// z^2 as linear in y, z and 1 with polynomials in x for coefficients; y(yz) = z(y^2), y(z^2) = z(yz) and
// (yz)^2 = y^2 z^2 then are three equations linear in y, z and 1 whose determinant, of degree 8 in x,
// vanishes at the roots (after Z. Kukelova, J. Heller and A. Fitzgibbon, Efficient intersection of three
// quadrics and applications in computer vision, CVPR 2016). Each root is then certified on the system itself.
// Throws std::invalid_argument unless there are three quadrics.
ThreeQuadricsRoots AllRoots(const QuadricSystem& system);

}  // namespace legible
