#include "core/algebra/quadric_system.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace legible {
namespace {

Eigen::MatrixXcd MidpointsOf(const ComplexBallMatrix& matrix) {
  Eigen::MatrixXcd midpoints(matrix.rows(), matrix.cols());
  for (Eigen::Index j = 0; j < matrix.cols(); ++j)
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) midpoints(i, j) = MidpointOf(matrix(i, j));
  return midpoints;
}

// Copies the lower triangle; whether all of it is exactly real.
bool MakeSymmetric(ComplexBallMatrix& matrix) {
  bool is_real = true;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j)
    for (Eigen::Index i = j; i < matrix.rows(); ++i) {
      is_real = is_real && IsExactlyReal(matrix(i, j));
      matrix(j, i) = matrix(i, j);
    }
  return is_real;
}

// Bilinear, of vectors of n elements.
std::complex<double> Dot(const std::complex<double>* a, const std::complex<double>* b, Eigen::Index n) {
  using Elements = Eigen::Map<const Eigen::VectorXcd>;
  return Elements(a, n).cwiseProduct(Elements(b, n)).sum();
}

// With one rounding at the end.
ComplexBall Dot(const ComplexBall* a, const ComplexBall* b, Eigen::Index n) {
  static_assert(sizeof(ComplexBall) == sizeof(acb_struct), "Arb reads vectors of balls as its own");
  ComplexBall dot;
  acb_dot(dot.get(), nullptr, 0, a->get(), 1, b->get(), 1, n, kBallPrecision_bits);
  return dot;
}

// Bounds twice the sum of the moduli of what multiplies products of two unknowns; the sum of doubles is
// rounded by far less than what is added.
double SecondDerivativeBound(const ComplexBallMatrix& matrix) {
  double sum = 0;
  for (Eigen::Index j = 1; j < matrix.cols(); ++j)
    for (Eigen::Index i = 1; i < matrix.rows(); ++i) sum += LargestModulus(matrix(i, j));
  return 2 * sum * (1 + 1e-12);
}

template <typename Scalar>
using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <typename Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

// With w = (1, z): value k is w^T (Q_k w), its derivative by z_i is 2 (Q_k w)_i.
template <typename Scalar>
QuadricValues<Scalar> EvaluateAt(const std::vector<Matrix<Scalar>>& matrices, const Vector<Scalar>& z) {
  const Eigen::Index n = z.size();
  Vector<Scalar> w(n + 1), product(n + 1);
  w[0] = Scalar(1);
  w.tail(n) = z;
  QuadricValues<Scalar> result{Vector<Scalar>(n), Matrix<Scalar>(n, n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i <= n; ++i)
      product[i] = Dot(w.data(), matrices[static_cast<size_t>(k)].col(i).data(), n + 1);  // row i, too
    result.values[k] = Dot(w.data(), product.data(), n + 1);
    for (Eigen::Index i = 0; i < n; ++i) result.jacobian(k, i) = product[i + 1] + product[i + 1];
  }
  return result;
}

}  // namespace

QuadricSystem::QuadricSystem(std::vector<ComplexBallMatrix> matrices) : matrices_(std::move(matrices)) {
  const Eigen::Index rows = size() + 1;
  for (ComplexBallMatrix& matrix : matrices_) {
    if (matrix.rows() != rows || matrix.cols() != rows)
      throw std::invalid_argument("QuadricSystem: the matrices of " + std::to_string(size()) +
                                  " quadrics need as many rows and columns and one more");
    if (!MakeSymmetric(matrix)) is_real_ = false;
    midpoints_.push_back(MidpointsOf(matrix));
    second_derivative_bounds_.push_back(SecondDerivativeBound(matrix));
  }
}

QuadricValues<std::complex<double>> Evaluate(const QuadricSystem& system, const Eigen::VectorXcd& z) {
  return EvaluateAt<std::complex<double>>(system.midpoints(), z);
}

QuadricValues<ComplexBall> Evaluate(const QuadricSystem& system, const ComplexBallVector& z) {
  return EvaluateAt<ComplexBall>(system.matrices(), z);
}

}  // namespace legible
