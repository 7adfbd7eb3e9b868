// Systems of quadrics for tests.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <random>
#include <vector>

#include "core/algebra/quadric_system.h"
#include "tests/testing/random.h"

namespace legible {

// Exactly these coefficients.
inline QuadricSystem ExactSystem(const std::vector<Eigen::MatrixXd>& matrices) {
  std::vector<ComplexBallMatrix> balls;
  balls.reserve(matrices.size());
  for (const Eigen::MatrixXd& matrix : matrices)
    balls.emplace_back(matrix.cast<RealBall>().cast<ComplexBall>());
  return QuadricSystem(balls);
}

// Symmetric, of whole numbers from -9 to 9.
inline Eigen::MatrixXd RandomQuadric(std::mt19937_64& generator) {
  std::uniform_int_distribution<int> whole(-9, 9);
  Eigen::MatrixXd matrix(4, 4);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = whole(generator);
  return matrix;
}

inline std::vector<Eigen::MatrixXd> RandomQuadrics(std::mt19937_64& generator) {
  return {RandomQuadric(generator), RandomQuadric(generator), RandomQuadric(generator)};
}

// The largest modulus of the quadrics' values, computed in doubles.
inline double LargestValue(const QuadricSystem& system, const Eigen::VectorXcd& z) {
  return Evaluate(system, z).values.cwiseAbs().maxCoeff();
}

}  // namespace legible
