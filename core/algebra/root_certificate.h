// Proofs that systems of quadrics have roots where Newton's method found them: Krawczyk's test, with balls.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/algebra/quadric_system.h"

namespace legible {

// Every system with coefficients in the balls has exactly one root within `radius` of the midpoint, largest
// modulus over the unknowns, and no other within `unique_radius`.
struct CertifiedRoot {
  Eigen::VectorXcd midpoint;
  double radius = 0;
  double unique_radius = 0;
  bool is_real = false;  // proved, as not being real is where this is false; the midpoint then is real
};

// The root near z: Newton's method on the coefficients' midpoints, then the proof. None where the proof
// fails: z leads nowhere, or to a multiple root or one so close to another that the balls cannot tell, or it
// stays open whether the root is real.
std::optional<CertifiedRoot> CertifyRoot(const QuadricSystem& system, const Eigen::VectorXcd& z);

struct CertifiedRoots {
  std::vector<CertifiedRoot> roots;  // proved to differ
  int uncertified = 0;  // approximations for which the proof failed, or that of being another or the same
};

// The distinct roots near the approximations, in their order; what two lead to is taken once.
CertifiedRoots CertifyRoots(const QuadricSystem& system, const std::vector<Eigen::VectorXcd>& approximations);

}  // namespace legible
