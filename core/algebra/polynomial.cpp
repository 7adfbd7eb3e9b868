#include "core/algebra/polynomial.h"

#include <Eigen/Eigenvalues>

namespace legible {

std::vector<std::complex<double>> RootsOf(const Eigen::VectorXcd& coefficients) {
  const Eigen::Index degree = coefficients.size() - 1;
  if (degree < 1) return {};
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  companion.rightCols<1>() = -coefficients.head(degree) / coefficients[degree];
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(companion, false);
  const Eigen::VectorXcd& roots = solver.eigenvalues();
  return {roots.begin(), roots.end()};
}

}  // namespace legible
