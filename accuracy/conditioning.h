// The indices that are in use to judge a robot's accuracy, each by its definition (Merlet 2006, sections 3
// and 4).
#pragma once

#include <Eigen/Core>

#include "core/robots/full_inverse_jacobian.h"

namespace legible {

// Condition numbers of a matrix M with more or as many columns than rows; M^+ is its pseudo-inverse. All are
// infinite for a matrix without full rank.
struct ConditionNumbers {
  double two = 0;        // |M|_2 |M^+|_2: largest over smallest singular value, at least 1
  double frobenius = 0;  // |M|_F |M^+|_F, at least the number of rows
  double infinity = 0;   // |M|_inf |M^+|_inf, of largest absolute row sums
  // |M M^T|_F |(M M^T)^-1|_F = sqrt(sum l^2 sum l^-2), l the eigenvalues of M M^T: the other reading of
  // "Frobenius condition number" in Merlet's tables (C_F^3), at least the number of rows.
  double frobenius_of_gram = 0;
};
ConditionNumbers ConditionNumbersOf(const Eigen::MatrixXd& matrix);

// A length for each norm: angular columns are divided by it before the condition number is taken.
struct CharacteristicLengths {
  double two_m = 0, frobenius_m = 0, infinity_m = 0;
};

// The natural lengths (Ma and Angeles 1991): those that minimise each condition number at this pose. Of the
// Frobenius norm in closed form; the logarithm of the others is convex in the logarithm of the length
// (Hadamard's three lines), so that a search finds the only minimum. Needs linear and angular columns and an
// invertible matrix.
CharacteristicLengths NaturalLengths(const FullInverseJacobian& inverse_jacobian);

// Condition numbers of the matrix with its angular columns divided by the length of each norm (of the
// Frobenius norm for both its readings).
ConditionNumbers NormalizedConditionNumbers(const FullInverseJacobian& inverse_jacobian,
                                            const CharacteristicLengths& lengths);

// Indices that depend on the unit of length and not only on ratios; SI.
double DeterminantOf(const FullInverseJacobian& inverse_jacobian);
// Yoshikawa's sqrt(det(J J^T)) of the Jacobian J, the inverse of this matrix: 1 / |determinant|; infinite
// where singular.
double ManipulabilityOf(const FullInverseJacobian& inverse_jacobian);

// The same matrix for lengths in units of unit_m: linear velocities and prismatic joints' speeds in that
// unit. A row whose joint is prismatic keeps its linear columns, and its angular ones are divided by the
// unit.
FullInverseJacobian InLengthUnit(const FullInverseJacobian& inverse_jacobian, double unit_m);

}  // namespace legible
