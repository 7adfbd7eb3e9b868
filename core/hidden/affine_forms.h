// Quadrics made of affine forms of the unknowns, with balls for coefficients so that their rounding is
// covered.
#pragma once

#include <vector>

#include "core/algebra/quadric_system.h"

namespace legible {

// form . (1, z) for n unknowns z: n + 1 coefficients.
using AffineForm = RealBallVector;

AffineForm ConstantForm(int unknowns, const RealBall& value);
AffineForm UnknownForm(int unknowns, int index);  // z[index], from 0

// The square of a vector of forms less a number: sum f_k^2 - value, as the matrix of a quadric.
ComplexBallMatrix SumOfSquares(const std::vector<AffineForm>& forms, const RealBall& value);

// A form as the matrix of a quadric.
ComplexBallMatrix AsQuadric(const AffineForm& form);

}  // namespace legible
