#include "servo/pseudo_inverse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <limits>
#include <stdexcept>

namespace legible {

// A third of the time of a singular value decomposition by Jacobi rotations. The eigenvalues of M^T M alone
// would have lost half of the digits; what M makes of the eigenvectors has not. Solutions lose the condition
// number's square in rounding: 1e-8 at the worst conditioning that a law moves on.
RightSingular RightSingularOf(const Matrix6d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(matrix.transpose() * matrix);
  RightSingular singular;
  singular.vectors = eigen.eigenvectors().rowwise().reverse();
  singular.values = (matrix * singular.vectors).colwise().norm();
  return singular;
}

void PseudoInverseOptions::Check() const {
  if (!(truncation >= 0 && truncation < 1))
    throw std::invalid_argument("PseudoInverseOptions: truncation must be in [0, 1)");
  if (!(damping >= 0 && damping < 1))
    throw std::invalid_argument("PseudoInverseOptions: damping must be in [0, 1)");
}

LeastSquares SolveLeastSquares(const TaskMatrix& matrix, const TaskVector& right,
                               const PseudoInverseOptions& options) {
  if (matrix.rows() < 6 || matrix.rows() != right.rows())
    throw std::invalid_argument("SolveLeastSquares: six rows at least, and as many on the right");
  LeastSquares result;
  if (!matrix.allFinite() || !right.allFinite()) {
    result.singular_values.setConstant(std::numeric_limits<double>::quiet_NaN());
    return result;
  }
  // First to a triangle: the singular values of six columns are then those of six rows.
  const Eigen::HouseholderQR<TaskMatrix> qr(matrix);
  result.triangle = qr.matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  TaskVector rotated = right;
  rotated.applyOnTheLeft(qr.householderQ().adjoint());
  const RightSingular singular = RightSingularOf(result.triangle);
  result.singular_values = singular.values;
  const double largest = result.singular_values[0];
  const double damping = options.damping * largest;
  // s times the components along the left singular vectors.
  Vector6d answers = (result.triangle * singular.vectors).transpose() * rotated.head<6>();
  for (int i = 0; i < 6; ++i) {
    const double s = result.singular_values[i];
    const bool counts = s > options.truncation * largest;
    answers[i] *= counts ? 1 / (s * s + damping * damping) : 0;
    result.rank += counts;
  }
  result.solution = singular.vectors * answers;
  return result;
}

}  // namespace legible
