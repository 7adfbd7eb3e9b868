// Roots of polynomials in one unknown.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace legible {

// The complex roots of coefficients[0] + coefficients[1] x + …, the last of which is not 0: eigenvalues of
// the companion matrix, as many as the degree.
std::vector<std::complex<double>> RootsOf(const Eigen::VectorXcd& coefficients);

}  // namespace legible
