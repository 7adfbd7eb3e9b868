// Derivatives from elsewhere, for checking hand-written ones. A test that includes this links Ceres.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>

namespace legible {

// d f / d x by central differences of the fourth order: the error is some step^4 / 30 times the fifth
// derivative, and rounding some 1e-16 / step of f. f: Matrix<double, N, 1> -> Matrix<double, M, 1>.
template <typename F, int N>
auto NumericJacobian(const F& f, const Eigen::Matrix<double, N, 1>& x, double step = 3e-4) {
  constexpr int kRows = decltype(f(x))::RowsAtCompileTime;
  Eigen::Matrix<double, kRows, N> jacobian;
  for (int i = 0; i < N; ++i) {
    const auto at = [&](double steps) -> Eigen::Matrix<double, kRows, 1> {
      return f((x + Eigen::Matrix<double, N, 1>::Unit(i) * steps * step).eval());
    };
    jacobian.col(i) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
  }
  return jacobian;
}

// d f / d x, exact up to rounding. f: Matrix<T, N, 1> -> Matrix<T, M, 1> for T = ceres::Jet<double, N>.
template <typename F, int N>
auto JetJacobian(const F& f, const Eigen::Matrix<double, N, 1>& x) {
  using Jet = ceres::Jet<double, N>;
  Eigen::Matrix<Jet, N, 1> seeded;
  for (int i = 0; i < N; ++i) seeded[i] = Jet(x[i], i);
  const auto value = f(seeded);
  constexpr int kRows = decltype(f(seeded))::RowsAtCompileTime;
  Eigen::Matrix<double, kRows, N> jacobian;
  for (int i = 0; i < kRows; ++i) jacobian.row(i) = value[i].v.transpose();
  return jacobian;
}

}  // namespace legible
