#include "core/hidden/affine_forms.h"

namespace legible {
namespace {

ComplexBallMatrix AsComplex(const RealBallMatrix& real) {
  ComplexBallMatrix matrix(real.rows(), real.cols());
  for (Eigen::Index i = 0; i < real.rows(); ++i)
    for (Eigen::Index j = 0; j < real.cols(); ++j) matrix(i, j) = ComplexBall(real(i, j));
  return matrix;
}

}  // namespace

AffineForm ConstantForm(int unknowns, const RealBall& value) {
  AffineForm form = AffineForm::Zero(unknowns + 1);
  form[0] = value;
  return form;
}

AffineForm UnknownForm(int unknowns, int index) {
  AffineForm form = AffineForm::Zero(unknowns + 1);
  form[index + 1] = RealBall(1.0);
  return form;
}

ComplexBallMatrix SumOfSquares(const std::vector<AffineForm>& forms, const RealBall& value) {
  const Eigen::Index size = forms.front().size();
  RealBallMatrix matrix = RealBallMatrix::Zero(size, size);
  for (const AffineForm& form : forms)
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j) matrix(i, j) += form[i] * form[j];
  matrix(0, 0) -= value;
  return AsComplex(matrix);
}

ComplexBallMatrix AsQuadric(const AffineForm& form) {
  RealBallMatrix matrix = RealBallMatrix::Zero(form.size(), form.size());
  matrix(0, 0) = form[0];
  for (Eigen::Index i = 1; i < form.size(); ++i) {
    matrix(i, 0) = form[i] * RealBall(0.5);
    matrix(0, i) = matrix(i, 0);
  }
  return AsComplex(matrix);
}

}  // namespace legible
