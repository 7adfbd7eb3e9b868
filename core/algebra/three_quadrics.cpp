#include "core/algebra/three_quadrics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <stdexcept>

namespace legible {
namespace {

using Complex = std::complex<double>;

constexpr int kDegree = kThreeQuadricsRootCount;

// Coefficients by rising powers of x, as many as no polynomial here exceeds.
using Polynomial = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, kDegree + 1, 1>;
// A polynomial in x times y, one times z, one times 1.
using LinearForm = std::array<Polynomial, 3>;

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product = Polynomial::Zero(a.size() + b.size() - 1);
  for (Eigen::Index i = 0; i < a.size(); ++i) product.segment(i, b.size()) += a[i] * b;
  return product;
}

Polynomial Sum(const Polynomial& a, const Polynomial& b, double sign) {
  Polynomial sum = Polynomial::Zero(std::max(a.size(), b.size()));
  sum.head(a.size()) = a;
  sum.head(b.size()) += sign * b;
  return sum;
}
Polynomial operator+(const Polynomial& a, const Polynomial& b) { return Sum(a, b, 1); }
Polynomial operator-(const Polynomial& a, const Polynomial& b) { return Sum(a, b, -1); }

Complex ValueAt(const Polynomial& polynomial, Complex x) {
  Complex value = 0;
  for (Eigen::Index i = polynomial.size(); i-- > 0;) value = value * x + polynomial[i];
  return value;
}

// The three quadrics solved for y^2, yz and z^2.
using SolvedQuadrics = std::array<LinearForm, 3>;

// Of matrices of (1, x, y, z); none where they cannot be solved.
std::optional<SolvedQuadrics> SolvedForProducts(const std::array<Eigen::Matrix4cd, 3>& quadrics) {
  Eigen::Matrix3cd products;               // of y^2, yz, z^2; a row a quadric
  Eigen::Matrix<Complex, 3, 7> remainder;  // of y, xy; z, xz; 1, x, x^2
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix4cd& q = quadrics[static_cast<size_t>(k)];
    products.row(k) << q(2, 2), 2.0 * q(2, 3), q(3, 3);
    remainder.row(k) << 2.0 * q(0, 2), 2.0 * q(1, 2), 2.0 * q(0, 3), 2.0 * q(1, 3), q(0, 0), 2.0 * q(0, 1),
        q(1, 1);
  }
  const Eigen::FullPivLU<Eigen::Matrix3cd> lu(products);
  if (lu.rcond() < 1e-10) return {};
  const Eigen::Matrix<Complex, 3, 7> solved = -lu.solve(remainder);
  SolvedQuadrics forms;
  for (int k = 0; k < 3; ++k) {
    const auto row = solved.row(k).transpose();
    forms[static_cast<size_t>(k)] = {row.segment<2>(0), row.segment<2>(2), row.segment<3>(4)};
  }
  return forms;
}

// a y^2 + b yz + c z^2 + rest, with what the quadrics say of the products.
LinearForm Reduced(const SolvedQuadrics& solved, const Polynomial& a, const Polynomial& b,
                   const Polynomial& c, const LinearForm& rest) {
  LinearForm form;
  for (size_t i = 0; i < 3; ++i) form[i] = a * solved[0][i] + b * solved[1][i] + c * solved[2][i] + rest[i];
  return form;
}

// What follows from y(yz) = z(y^2), y(z^2) = z(yz) and (yz)^2 = y^2 z^2; each vanishes at a root.
std::array<LinearForm, 3> Consequences(const SolvedQuadrics& solved) {
  const auto& [p1, q1, r1] = solved[0];  // y^2 = p1 y + q1 z + r1
  const auto& [p2, q2, r2] = solved[1];  // yz
  const auto& [p3, q3, r3] = solved[2];  // z^2
  const Polynomial zero = Polynomial::Zero(1);
  return {Reduced(solved, p2, q2 - p1, zero - q1, {r2, zero - r1, zero}),
          Reduced(solved, p3, q3 - p2, zero - q2, {r3, zero - r2, zero}),
          Reduced(solved, p2 * p2 - p1 * p3, p2 * q2 + p2 * q2 - p1 * q3 - q1 * p3, q2 * q2 - q1 * q3,
                  {p2 * r2 + p2 * r2 - p1 * r3 - r1 * p3, q2 * r2 + q2 * r2 - q1 * r3 - r1 * q3,
                   r2 * r2 - r1 * r3})};
}

Polynomial Determinant(const std::array<LinearForm, 3>& rows) {
  const auto minor = [&](size_t i, size_t j) { return rows[1][i] * rows[2][j] - rows[1][j] * rows[2][i]; };
  return rows[0][0] * minor(1, 2) - rows[0][1] * minor(0, 2) + rows[0][2] * minor(0, 1);
}

// The eigenvalues of its companion matrix.
Eigen::VectorXcd RootsOf(const Polynomial& polynomial) {
  Eigen::Matrix<Complex, kDegree, kDegree> companion;
  companion.setZero();
  companion.diagonal(-1).setOnes();
  companion.col(kDegree - 1) = -polynomial.head(kDegree) / polynomial[kDegree];
  return companion.eigenvalues();
}

// The vector across the two of the matrix' rows that are least parallel.
Eigen::Vector3cd NullVector(const Eigen::Matrix3cd& matrix) {
  Eigen::Vector3cd longest = Eigen::Vector3cd::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3cd a = matrix.row(i).transpose(), b = matrix.row((i + 1) % 3).transpose();
    const Eigen::Vector3cd across(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                  a[0] * b[1] - a[1] * b[0]);
    if (across.norm() > longest.norm()) longest = across;
  }
  return longest;
}

// Homogeneous (1, x, y, z) of the common points of quadrics in general position.
std::vector<Eigen::Vector4cd> CommonPoints(const std::array<Eigen::Matrix4cd, 3>& quadrics) {
  const std::optional<SolvedQuadrics> solved = SolvedForProducts(quadrics);
  if (!solved) return {};
  const std::array<LinearForm, 3> consequences = Consequences(*solved);
  std::vector<Eigen::Vector4cd> points;
  for (const Complex x : RootsOf(Determinant(consequences))) {
    Eigen::Matrix3cd matrix;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        matrix(i, j) = ValueAt(consequences[static_cast<size_t>(i)][static_cast<size_t>(j)], x);
    const Eigen::Vector3cd yz1 = NullVector(matrix);
    points.emplace_back(yz1[2], x * yz1[2], yz1[0], yz1[1]);
  }
  return points;
}

// Turns of space, infinity included, that no system of practice knows of: they leave no two roots with the
// same x and none at infinity. Two, for one may happen not to.
std::array<Eigen::Matrix4d, 2> Turns() {
  std::array<Eigen::Matrix4d, 2> turns;
  for (size_t i = 0; i < turns.size(); ++i) {
    const double seed = 1 + static_cast<double>(i);
    Eigen::Matrix4d matrix;
    for (int j = 0; j < 16; ++j) matrix(j) = std::sin(seed + 1.7 * j * j);
    turns[i] = matrix.householderQr().householderQ();
  }
  return turns;
}

std::array<Eigen::Matrix4cd, 3> Turned(const QuadricSystem& system, const Eigen::Matrix4d& turn) {
  std::array<Eigen::Matrix4cd, 3> quadrics;
  for (size_t k = 0; k < 3; ++k) {
    quadrics[k] = turn.transpose() * system.midpoints()[k] * turn;
    quadrics[k] /= quadrics[k].cwiseAbs().maxCoeff();
  }
  return quadrics;
}

}  // namespace

ThreeQuadricsRoots AllRoots(const QuadricSystem& system) {
  if (system.size() != 3) throw std::invalid_argument("AllRoots needs three quadrics in three unknowns");
  static const std::array<Eigen::Matrix4d, 2> turns = Turns();
  std::vector<Eigen::VectorXcd> approximations;
  ThreeQuadricsRoots result;
  for (const Eigen::Matrix4d& turn : turns) {
    for (const Eigen::Vector4cd& point : CommonPoints(Turned(system, turn))) {
      const Eigen::Vector4cd w = turn * point;
      approximations.emplace_back(w.tail<3>() / w[0]);
    }
    result.roots = CertifyRoots(system, approximations).roots;
    result.is_complete = result.roots.size() == kThreeQuadricsRootCount;
    if (result.is_complete) break;
  }
  result.missing = kThreeQuadricsRootCount - static_cast<int>(result.roots.size());
  return result;
}

}  // namespace legible
