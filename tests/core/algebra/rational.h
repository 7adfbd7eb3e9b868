// Rational numbers without rounding, and polynomials of them: FLINT's, for counts that nothing can be said
// against.
#pragma once

#include <flint/fmpq.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace legible {

class Rational {
 public:
  Rational() { fmpq_init(value_); }
  // Exactly that number, which every double is; implicit, for Eigen makes its zeros and ones of numbers.
  // NOLINTBEGIN(google-explicit-constructor)
  Rational(double exact);
  Rational(int whole) : Rational() { fmpq_set_si(value_, whole, 1); }
  // NOLINTEND(google-explicit-constructor)
  Rational(const Rational& other) : Rational() { fmpq_set(value_, other.value_); }
  Rational(Rational&& other) noexcept : Rational() { fmpq_swap(value_, other.value_); }
  Rational& operator=(const Rational& other) {
    fmpq_set(value_, other.value_);
    return *this;
  }
  Rational& operator=(Rational&& other) noexcept {
    fmpq_swap(value_, other.value_);
    return *this;
  }
  ~Rational() { fmpq_clear(value_); }

  Rational& operator+=(const Rational& other) {
    fmpq_add(value_, value_, other.value_);
    return *this;
  }
  Rational& operator-=(const Rational& other) {
    fmpq_sub(value_, value_, other.value_);
    return *this;
  }
  Rational& operator*=(const Rational& other) {
    fmpq_mul(value_, value_, other.value_);
    return *this;
  }
  Rational& operator/=(const Rational& other) {
    fmpq_div(value_, value_, other.value_);
    return *this;
  }
  Rational operator-() const {
    Rational negative;
    fmpq_neg(negative.value_, value_);
    return negative;
  }
  bool IsZero() const { return fmpq_is_zero(value_) != 0; }

  const fmpq* get() const { return value_; }
  fmpq* get() { return value_; }

 private:
  fmpq_t value_;
};

inline Rational operator+(Rational a, const Rational& b) { return a += b; }
inline Rational operator-(Rational a, const Rational& b) { return a -= b; }
inline Rational operator*(Rational a, const Rational& b) { return a *= b; }
inline Rational operator/(Rational a, const Rational& b) { return a /= b; }
inline bool operator==(const Rational& a, const Rational& b) { return fmpq_equal(a.get(), b.get()) != 0; }

// coefficients[0] + coefficients[1] x + ….
using RationalPolynomial = std::vector<Rational>;

// The resultant of two polynomials whose last coefficients are not 0; throws std::logic_error where one is.
Rational Resultant(const RationalPolynomial& a, const RationalPolynomial& b);

// The polynomial of at most that degree that a polynomial function is, from its values at whole numbers.
RationalPolynomial Interpolated(const std::function<Rational(const Rational&)>& function, int degree);

// Divided by 1 + x^2 as often as that leaves no remainder.
RationalPolynomial WithoutCircularPoints(const RationalPolynomial& polynomial);

struct RealRoots {
  int count = 0;   // distinct ones
  int degree = 0;  // of the polynomial
};
// By Sturm's theorem; nothing where roots are multiple.
std::optional<RealRoots> RealRootsOf(const RationalPolynomial& polynomial);

}  // namespace legible

namespace Eigen {

template <>
struct NumTraits<legible::Rational> : GenericNumTraits<legible::Rational> {
  using Real = legible::Rational;
  using NonInteger = legible::Rational;
  using Nested = legible::Rational;
  using Literal = legible::Rational;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 10,
    AddCost = 100,
    MulCost = 100
  };
};

}  // namespace Eigen
