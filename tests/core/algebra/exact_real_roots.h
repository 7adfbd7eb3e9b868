// How many real points three quadrics have in common, counted exactly.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace legible {

// Of three quadrics (1, z)^T Q (1, z) of whole coefficients, by a way of its own, in rational numbers: the
// null space of their multiples up to degree 4 (Macaulay) gives the matrix of the multiplication by x; its
// characteristic polynomial has the roots' x for roots, the real ones of which FLINT counts. None where that
// polynomial has a double root, or the quadrics have not eight points in common.
std::optional<int> ExactRealRootCount(const std::vector<Eigen::MatrixXd>& quadrics);

}  // namespace legible
