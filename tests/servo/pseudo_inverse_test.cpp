#include "servo/pseudo_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>

#include "servo/adaptive_gain.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

struct Problem {
  TaskMatrix matrix;
  TaskVector right;
};

// Of so many rows, with singular values from 1 down to `smallest`.
Problem RandomProblem(int rows, double smallest, std::mt19937_64& generator) {
  const auto draw = [&](int r, int c) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(r, c, [&] { return Uniform(generator, -1, 1); }));
  };
  const Eigen::MatrixXd left = Eigen::HouseholderQR<Eigen::MatrixXd>(draw(rows, 6)).householderQ() *
                               Eigen::MatrixXd::Identity(rows, 6);
  const Eigen::MatrixXd turn = Eigen::HouseholderQR<Eigen::MatrixXd>(draw(6, 6)).householderQ();
  Vector6d values;
  for (int i = 0; i < 6; ++i) values[i] = std::pow(smallest, i / 5.0);
  return {left * values.asDiagonal() * turn.transpose(), draw(rows, 1)};
}

// sum over the singular directions of v u^T right answer(s).
template <typename Answer>
Vector6d BySingularValues(const Problem& problem, const Answer& answer) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(problem.matrix),
                                           Eigen::ComputeThinU | Eigen::ComputeThinV);
  Vector6d coordinates = svd.matrixU().transpose() * problem.right;
  for (int i = 0; i < 6; ++i) coordinates[i] *= answer(svd.singularValues()[i], svd.singularValues()[0]);
  return svd.matrixV() * coordinates;
}

TEST(SolveLeastSquares, IsEigensLeastSquaresSolution) {
  std::mt19937_64 generator = TestGenerator();
  for (int rows = 6; rows <= kMostTaskRows; ++rows) {
    const Problem problem = RandomProblem(rows, 1e-2, generator);
    const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {});
    const Eigen::MatrixXd matrix = problem.matrix;
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal(matrix);
    EXPECT_TRUE(AreNear(found.solution, orthogonal.solve(problem.right), 1e-11));
    EXPECT_TRUE(
        AreNear(found.singular_values, Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues(), 1e-13));
    EXPECT_TRUE(AreNear(found.triangle.transpose() * found.triangle, matrix.transpose() * matrix, 1e-13));
    EXPECT_TRUE(found.triangle.isUpperTriangular());
    EXPECT_EQ(found.rank, 6);
  }
}

TEST(SolveLeastSquares, KeepsEightDigitsWhereAMotionIsHardlyTold) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Problem problem = RandomProblem(12, 3e-5, generator);
    const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {});
    const Eigen::MatrixXd matrix = problem.matrix;
    const Vector6d expected =
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(matrix).solve(problem.right);
    EXPECT_TRUE(AreNear(found.solution, expected, 1e-6 * expected.norm()));
    EXPECT_TRUE(
        AreNear(found.singular_values, Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues(), 1e-13));
  }
}

TEST(SolveLeastSquares, LeavesDirectionsBelowTheTruncationAlone) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Problem problem = RandomProblem(12, 1e-5, generator);  // a tenth from each to the next
    const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {3e-3, 0});
    EXPECT_EQ(found.rank, 3);
    const auto answer = [](double s, double largest) { return s > 3e-3 * largest ? 1 / s : 0; };
    EXPECT_TRUE(AreNear(found.solution, BySingularValues(problem, answer), 1e-9));
  }
}

TEST(SolveLeastSquares, OfAMatrixWithoutFullRankIsTheShortestSolution) {
  std::mt19937_64 generator = TestGenerator();
  Problem problem = RandomProblem(9, 0.1, generator);
  problem.matrix.col(2) = problem.matrix.col(4);
  const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {});
  EXPECT_EQ(found.rank, 5);
  const Eigen::MatrixXd matrix = problem.matrix;
  EXPECT_TRUE(AreNear(found.solution,
                      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(matrix).solve(problem.right),
                      1e-11));
}

TEST(SolveLeastSquares, AnswersDampedAsTikhonovDoes) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Problem problem = RandomProblem(15, 1e-2, generator);
    const double damping = Uniform(generator, 0.001, 0.3);
    const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {1e-9, damping});
    // The largest singular value is 1.
    const Matrix6d system =
        problem.matrix.transpose() * problem.matrix + damping * damping * Matrix6d::Identity();
    EXPECT_TRUE(AreNear(found.solution,
                        system.fullPivHouseholderQr().solve(problem.matrix.transpose() * problem.right),
                        1e-9));
  }
}

TEST(SolveLeastSquares, HasNoSingularValuesOfWhatIsNoNumber) {
  std::mt19937_64 generator = TestGenerator();
  Problem problem = RandomProblem(8, 0.1, generator);
  problem.matrix(3, 2) = std::numeric_limits<double>::quiet_NaN();
  const LeastSquares found = SolveLeastSquares(problem.matrix, problem.right, {});
  EXPECT_EQ(found.rank, 0);
  EXPECT_TRUE(found.singular_values.array().isNaN().all());
}

TEST(SolveLeastSquares, NeedsSixRowsAndAsManyNumbers) {
  EXPECT_THROW(SolveLeastSquares(TaskMatrix::Zero(5, 6), TaskVector::Zero(5), {}), std::invalid_argument);
  EXPECT_THROW(SolveLeastSquares(TaskMatrix::Zero(7, 6), TaskVector::Zero(6), {}), std::invalid_argument);
  EXPECT_THROW((PseudoInverseOptions{1, 0}.Check()), std::invalid_argument);
  EXPECT_THROW((PseudoInverseOptions{0, -0.1}.Check()), std::invalid_argument);
}

TEST(AdaptiveGain, StartsAtZeroWithItsSlopeAndFallsToInfinity) {
  const AdaptiveGain gain{4, 0.5, 30};
  EXPECT_DOUBLE_EQ(gain.At(0), 4);
  EXPECT_DOUBLE_EQ(gain.At(1e6), 0.5);
  // (4 - 0.5) exp(-30 x / 3.5) + 0.5 where the exponent is -1.
  EXPECT_NEAR(gain.At(3.5 / 30), 3.5 / std::exp(1.0) + 0.5, 1e-14);
  const auto at = [&](const Eigen::Matrix<double, 1, 1>& x) -> Eigen::Matrix<double, 1, 1> {
    return Eigen::Matrix<double, 1, 1>(gain.At(x[0]));
  };
  EXPECT_NEAR(NumericJacobian(at, Eigen::Matrix<double, 1, 1>(0.0))(0, 0), -30, 1e-6);
  for (double error = 0; error < 2; error += 0.01) EXPECT_GE(gain.At(error), gain.At(error + 0.01));
}

TEST(AdaptiveGain, MayBeConstant) {
  const AdaptiveGain gain = AdaptiveGain::Constant(2);
  for (const double error : {0.0, 1e-3, 1e3}) EXPECT_EQ(gain.At(error), 2);
  EXPECT_NO_THROW(gain.Check());
}

TEST(AdaptiveGain, RefusesWhatIsNotPositiveOrRises) {
  EXPECT_THROW((AdaptiveGain{0, 0, 0}.Check()), std::invalid_argument);
  EXPECT_THROW((AdaptiveGain{1, 2, 0}.Check()), std::invalid_argument);
  EXPECT_THROW((AdaptiveGain{2, 1, -1}.Check()), std::invalid_argument);
  EXPECT_THROW((AdaptiveGain{std::numeric_limits<double>::infinity(), 1, 0}.Check()), std::invalid_argument);
}

}  // namespace
}  // namespace legible
