#include "accuracy/conditioning.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace legible {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kGolden = 0.6180339887498949;
constexpr int kGoldenSteps = 50;                 // narrow the bracket by 0.618^50 = 4e-11
constexpr double kBracket = 13.815510557964274;  // ln(10^6), to either side of the Frobenius length

double RowSumNorm(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

Eigen::MatrixXd WithAngularColumnsOver(const FullInverseJacobian& inverse_jacobian, double length_m) {
  Eigen::MatrixXd matrix = inverse_jacobian.matrix;
  matrix.rightCols(matrix.cols() - inverse_jacobian.linear) /= length_m;
  return matrix;
}

// Where a function that falls and then rises is least.
double GoldenSection(const std::function<double(double)>& f, double low, double high) {
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double f_left = f(left), f_right = f(right);
  for (int step = 0; step < kGoldenSteps; ++step) {
    if (f_left <= f_right) {
      high = right, right = left, f_right = f_left;
      left = high - kGolden * (high - low), f_left = f(left);
    } else {
      low = left, left = right, f_left = f_right;
      right = low + kGolden * (high - low), f_right = f(right);
    }
  }
  return (low + high) / 2;
}

// kappa_F^2 = (a + b / L^2) (c + d L^2) is least at L^4 = b c / (a d).
double NaturalFrobeniusLength(const FullInverseJacobian& inverse_jacobian) {
  const Eigen::MatrixXd jacobian = inverse_jacobian.matrix.inverse();
  const Eigen::Index linear = inverse_jacobian.linear, angular = jacobian.rows() - linear;
  const double a = inverse_jacobian.matrix.leftCols(linear).squaredNorm();
  const double b = inverse_jacobian.matrix.rightCols(angular).squaredNorm();
  const double c = jacobian.topRows(linear).squaredNorm(), d = jacobian.bottomRows(angular).squaredNorm();
  return std::pow(b * c / (a * d), 0.25);
}

// By themselves, for the search: of square matrices of full rank.
double TwoNormCondition(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values[0] / values[values.size() - 1];
}
double InfinityNormCondition(const Eigen::MatrixXd& matrix) {
  return RowSumNorm(matrix) * RowSumNorm(matrix.inverse());
}

}  // namespace

ConditionNumbers ConditionNumbersOf(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() > matrix.cols())
    throw std::invalid_argument("ConditionNumbersOf: the matrix has more rows than columns");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd values = svd.singularValues().array();
  if (!(values.minCoeff() > std::numeric_limits<double>::epsilon() * values.maxCoeff()))
    return {kInfinite, kInfinite, kInfinite, kInfinite};
  const Eigen::MatrixXd pseudo_inverse =
      svd.matrixV() * values.inverse().matrix().asDiagonal() * svd.matrixU().transpose();
  return {values.maxCoeff() / values.minCoeff(),
          std::sqrt(values.square().sum() * values.square().inverse().sum()),
          RowSumNorm(matrix) * RowSumNorm(pseudo_inverse),
          std::sqrt(values.pow(4).sum() * values.pow(-4).sum())};
}

CharacteristicLengths NaturalLengths(const FullInverseJacobian& inverse_jacobian) {
  const double frobenius_m = NaturalFrobeniusLength(inverse_jacobian);
  const auto least = [&](double (*condition)(const Eigen::MatrixXd&)) {
    const auto at = [&](double log_length) {
      return condition(WithAngularColumnsOver(inverse_jacobian, std::exp(log_length)));
    };
    return std::exp(GoldenSection(at, std::log(frobenius_m) - kBracket, std::log(frobenius_m) + kBracket));
  };
  return {least(TwoNormCondition), frobenius_m, least(InfinityNormCondition)};
}

ConditionNumbers NormalizedConditionNumbers(const FullInverseJacobian& inverse_jacobian,
                                            const CharacteristicLengths& lengths) {
  const auto at = [&](double length_m) {
    return ConditionNumbersOf(WithAngularColumnsOver(inverse_jacobian, length_m));
  };
  const ConditionNumbers frobenius = at(lengths.frobenius_m);
  return {at(lengths.two_m).two, frobenius.frobenius, at(lengths.infinity_m).infinity,
          frobenius.frobenius_of_gram};
}

double DeterminantOf(const FullInverseJacobian& inverse_jacobian) {
  return inverse_jacobian.matrix.determinant();
}

double ManipulabilityOf(const FullInverseJacobian& inverse_jacobian) {
  return 1 / std::abs(DeterminantOf(inverse_jacobian));
}

FullInverseJacobian InLengthUnit(const FullInverseJacobian& inverse_jacobian, double unit_m) {
  FullInverseJacobian scaled = inverse_jacobian;
  const Eigen::Index angular = scaled.matrix.cols() - scaled.linear;
  scaled.matrix.topRightCorner(scaled.actuated, angular) /= unit_m;
  return scaled;
}

}  // namespace legible
