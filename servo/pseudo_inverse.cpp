#include "servo/pseudo_inverse.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>
#include <stdexcept>

namespace legible {

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
  const Eigen::JacobiSVD<Matrix6d> svd(result.triangle, Eigen::ComputeFullU | Eigen::ComputeFullV);
  result.singular_values = svd.singularValues();
  const double largest = result.singular_values[0];
  const double damping = options.damping * largest;
  Vector6d answers = svd.matrixU().transpose() * rotated.head<6>();
  for (int i = 0; i < 6; ++i) {
    const double s = result.singular_values[i];
    const bool counts = s > options.truncation * largest;
    answers[i] *= counts ? s / (s * s + damping * damping) : 0;
    result.rank += counts;
  }
  result.solution = svd.matrixV() * answers;
  return result;
}

}  // namespace legible
