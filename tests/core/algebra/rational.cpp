#include "tests/core/algebra/rational.h"

#include <flint/fmpq_poly.h>
#include <flint/fmpz_poly.h>

#include <cmath>
#include <stdexcept>

namespace legible {
namespace {

class Polynomial {
 public:
  Polynomial() { fmpq_poly_init(value_); }
  explicit Polynomial(const RationalPolynomial& coefficients) : Polynomial() {
    for (size_t i = 0; i < coefficients.size(); ++i)
      fmpq_poly_set_coeff_fmpq(value_, static_cast<slong>(i), coefficients[i].get());
  }
  Polynomial(const Polynomial&) = delete;
  Polynomial& operator=(const Polynomial&) = delete;
  ~Polynomial() { fmpq_poly_clear(value_); }

  RationalPolynomial Coefficients() const {
    RationalPolynomial coefficients(static_cast<size_t>(fmpq_poly_length(value_)));
    for (size_t i = 0; i < coefficients.size(); ++i)
      fmpq_poly_get_coeff_fmpq(coefficients[i].get(), value_, static_cast<slong>(i));
    return coefficients;
  }
  fmpq_poly_struct* get() { return value_; }

 private:
  fmpq_poly_t value_;
};

}  // namespace

Rational::Rational(double exact) : Rational() {
  int exponent = 0;
  const double mantissa = std::frexp(exact, &exponent);
  fmpz_set_d(fmpq_numref(value_), std::ldexp(mantissa, 53));
  exponent -= 53;
  if (exponent > 0)
    fmpq_mul_2exp(value_, value_, static_cast<flint_bitcnt_t>(exponent));
  else
    fmpq_div_2exp(value_, value_, static_cast<flint_bitcnt_t>(-exponent));
}

Rational Resultant(const RationalPolynomial& a, const RationalPolynomial& b) {
  if (a.back().IsZero() || b.back().IsZero()) throw std::logic_error("a polynomial's degree has dropped");
  Rational resultant;
  fmpq_poly_resultant(resultant.get(), Polynomial(a).get(), Polynomial(b).get());
  return resultant;
}

// Newton's divided differences.
RationalPolynomial Interpolated(const std::function<Rational(const Rational&)>& function, int degree) {
  const auto count = static_cast<size_t>(degree) + 1;
  RationalPolynomial nodes, differences;
  for (int i = 0; i <= degree; ++i) {
    nodes.emplace_back(i - degree / 2);
    differences.push_back(function(nodes.back()));
  }
  for (size_t order = 1; order < count; ++order)
    for (size_t i = count - 1; i >= order; --i)
      differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - order]);
  RationalPolynomial polynomial(count);
  for (size_t k = count; k-- > 0;) {  // polynomial * (x - node) + difference
    for (size_t i = count - 1; i > 0; --i) polynomial[i] = polynomial[i - 1] - nodes[k] * polynomial[i];
    polynomial[0] = differences[k] - nodes[k] * polynomial[0];
  }
  return polynomial;
}

RationalPolynomial WithoutCircularPoints(const RationalPolynomial& polynomial) {
  Polynomial divisor(RationalPolynomial{1, 0, 1}), dividend(polynomial), quotient, remainder;
  while (fmpq_poly_length(dividend.get()) > 2) {
    fmpq_poly_divrem(quotient.get(), remainder.get(), dividend.get(), divisor.get());
    if (fmpq_poly_is_zero(remainder.get()) == 0) break;
    fmpq_poly_swap(dividend.get(), quotient.get());
  }
  return dividend.Coefficients();
}

std::optional<RealRoots> RealRootsOf(const RationalPolynomial& polynomial) {
  fmpz_poly_t whole;
  fmpz_poly_init(whole);
  fmpq_poly_get_numerator(whole, Polynomial(polynomial).get());
  std::optional<RealRoots> roots;
  if (fmpz_poly_is_squarefree(whole) != 0)
    roots = RealRoots{static_cast<int>(fmpz_poly_num_real_roots(whole)),
                      static_cast<int>(fmpz_poly_degree(whole))};
  fmpz_poly_clear(whole);
  return roots;
}

}  // namespace legible
