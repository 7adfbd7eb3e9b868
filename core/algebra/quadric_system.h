// As many quadrics as unknowns, their coefficients known as balls.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/algebra/ball.h"

namespace legible {

// n quadrics in z, an n-vector of complex unknowns: quadric k is (1, z)^T Q_k (1, z) = 0 with Q_k symmetric.
// The balls of the coefficients say what rounding, or anything else, left open of them: what is proved of
// such a system holds for every choice of coefficients in their balls.
class QuadricSystem {
 public:
  // Of the n matrices Q_k, (n+1) x (n+1), whose lower triangles alone are read. Throws std::invalid_argument
  // where their sizes do not fit.
  explicit QuadricSystem(std::vector<ComplexBallMatrix> matrices);

  Eigen::Index size() const { return static_cast<Eigen::Index>(matrices_.size()); }  // n
  const std::vector<ComplexBallMatrix>& matrices() const { return matrices_; }
  const std::vector<Eigen::MatrixXcd>& midpoints() const { return midpoints_; }
  // For each quadric a bound of the sum of the moduli of its second derivatives by z.
  const std::vector<double>& second_derivative_bounds() const { return second_derivative_bounds_; }
  bool is_real() const { return is_real_; }  // every coefficient is exactly real

 private:
  std::vector<ComplexBallMatrix> matrices_;
  std::vector<Eigen::MatrixXcd> midpoints_;
  std::vector<double> second_derivative_bounds_;
  bool is_real_ = true;
};

// The quadrics' values (n) and their derivatives by z (n x n, a row a quadric).
template <typename Scalar>
struct QuadricValues {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> values;
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> jacobian;
};

// In doubles, of the coefficients' midpoints.
QuadricValues<std::complex<double>> Evaluate(const QuadricSystem& system, const Eigen::VectorXcd& z);

// Enclosures for all coefficients and all z in their balls.
QuadricValues<ComplexBall> Evaluate(const QuadricSystem& system, const ComplexBallVector& z);

}  // namespace legible
