#include "tests/core/algebra/exact_real_roots.h"

#include <flint/fmpq_mat.h>
#include <flint/fmpq_poly.h>
#include <flint/fmpz_mat.h>
#include <flint/fmpz_poly.h>

#include <algorithm>
#include <array>

namespace legible {
namespace {

using Exponents = std::array<int, 3>;

constexpr int kRootCount = 8;

std::vector<Exponents> MonomialsUpTo(int degree) {
  std::vector<Exponents> monomials;
  for (int x = 0; x <= degree; ++x)
    for (int y = 0; x + y <= degree; ++y)
      for (int z = 0; x + y + z <= degree; ++z) monomials.push_back({x, y, z});
  return monomials;
}

Exponents Product(const Exponents& a, const Exponents& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

const std::vector<Exponents>& Columns() {
  static const std::vector<Exponents> columns = MonomialsUpTo(4);
  return columns;
}

slong ColumnOf(const Exponents& monomial) {
  return std::find(Columns().begin(), Columns().end(), monomial) - Columns().begin();
}

// A row for each product of a quadric with a monomial up to degree 2.
void SetMacaulay(fmpz_mat_t rows, const std::vector<Eigen::MatrixXd>& quadrics) {
  constexpr std::array<Exponents, 4> kUnknowns = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  slong row = 0;
  for (const Eigen::MatrixXd& quadric : quadrics)
    for (const Exponents& monomial : MonomialsUpTo(2)) {
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j) {
          fmpz* entry =
              fmpz_mat_entry(rows, row, ColumnOf(Product(monomial, Product(kUnknowns[i], kUnknowns[j]))));
          fmpz_add_si(entry, entry, static_cast<slong>(quadric(static_cast<int>(i), static_cast<int>(j))));
        }
      ++row;
    }
}

// The rows of the null space that belong to the monomials of the quotient's basis times `factor`.
void SetBasisRows(fmpq_mat_t rows, const fmpz_mat_t null_space, const Exponents& factor) {
  slong row = 0;
  for (int x = 0; x <= 1; ++x)
    for (int y = 0; y <= 1; ++y)
      for (int z = 0; z <= 1; ++z) {
        const slong from = ColumnOf(Product({x, y, z}, factor));
        for (slong j = 0; j < kRootCount; ++j)
          fmpq_set_fmpz(fmpq_mat_entry(rows, row, j), fmpz_mat_entry(null_space, from, j));
        ++row;
      }
}

std::optional<int> RealRootCountOf(const fmpq_mat_t multiplication) {
  fmpq_poly_t characteristic;
  fmpq_poly_init(characteristic);
  fmpq_mat_charpoly(characteristic, multiplication);
  fmpz_poly_t polynomial;
  fmpz_poly_init(polynomial);
  fmpq_poly_get_numerator(polynomial, characteristic);
  std::optional<int> count;
  if (fmpz_poly_is_squarefree(polynomial) != 0)
    count = static_cast<int>(fmpz_poly_num_real_roots(polynomial));
  fmpz_poly_clear(polynomial);
  fmpq_poly_clear(characteristic);
  return count;
}

std::optional<int> RealRootCountFrom(const fmpz_mat_t null_space) {
  fmpq_mat_t basis, shifted;
  fmpq_mat_init(basis, kRootCount, kRootCount);
  fmpq_mat_init(shifted, kRootCount, kRootCount);
  SetBasisRows(basis, null_space, {0, 0, 0});
  SetBasisRows(shifted, null_space, {1, 0, 0});
  std::optional<int> count;
  if (fmpq_mat_inv(basis, basis) != 0) {
    fmpq_mat_mul(shifted, shifted, basis);
    count = RealRootCountOf(shifted);
  }
  fmpq_mat_clear(shifted);
  fmpq_mat_clear(basis);
  return count;
}

}  // namespace

std::optional<int> ExactRealRootCount(const std::vector<Eigen::MatrixXd>& quadrics) {
  const slong columns = static_cast<slong>(Columns().size());
  fmpz_mat_t macaulay, null_space;
  fmpz_mat_init(macaulay, 30, columns);
  fmpz_mat_init(null_space, columns, columns);
  SetMacaulay(macaulay, quadrics);
  std::optional<int> count;
  if (fmpz_mat_nullspace(null_space, macaulay) == kRootCount) count = RealRootCountFrom(null_space);
  fmpz_mat_clear(null_space);
  fmpz_mat_clear(macaulay);
  return count;
}

}  // namespace legible
