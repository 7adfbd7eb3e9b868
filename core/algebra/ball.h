// Real and complex numbers that are known to lie within a radius of a midpoint. Every operation encloses the
// results of all numbers that its operands may be, rounding included: Arb's ball arithmetic (F. Johansson,
// Arb: efficient arbitrary-precision midpoint-radius interval arithmetic, IEEE Transactions on Computers 66,
// 2017). Midpoints have 128 bits, as many as Arb keeps without allocating memory: doubles and their products
// fit exactly, and residuals near multiple roots are still worth something.
#pragma once

#include <acb.h>
#include <arb.h>

#include <Eigen/Core>
#include <complex>

namespace legible {

inline constexpr int kBallPrecision_bits = 128;

class RealBall {
 public:
  RealBall() { arb_init(value_); }  // exactly 0
  // Exactly that number; implicit, for Eigen makes its zeros and ones of numbers.
  // NOLINTNEXTLINE(google-explicit-constructor)
  RealBall(double exact) : RealBall() { arb_set_d(value_, exact); }
  RealBall(double midpoint, double radius);
  RealBall(const RealBall& other) : RealBall() { arb_set(value_, other.value_); }
  RealBall(RealBall&& other) noexcept : RealBall() { arb_swap(value_, other.value_); }
  RealBall& operator=(const RealBall& other) {
    arb_set(value_, other.value_);
    return *this;
  }
  RealBall& operator=(RealBall&& other) noexcept {
    arb_swap(value_, other.value_);
    return *this;
  }
  ~RealBall() { arb_clear(value_); }

  RealBall& operator+=(const RealBall& other) {
    arb_add(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  RealBall& operator-=(const RealBall& other) {
    arb_sub(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  RealBall& operator*=(const RealBall& other) {
    arb_mul(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  // Not a number where the divisor may be 0.
  RealBall& operator/=(const RealBall& other) {
    arb_div(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  RealBall operator-() const {
    RealBall negative;
    arb_neg(negative.value_, value_);
    return negative;
  }

  arb_ptr get() { return value_; }
  arb_srcptr get() const { return value_; }

 private:
  arb_t value_;
};

inline RealBall operator+(RealBall a, const RealBall& b) { return a += b; }
inline RealBall operator-(RealBall a, const RealBall& b) { return a -= b; }
inline RealBall operator*(RealBall a, const RealBall& b) { return a *= b; }
inline RealBall operator/(RealBall a, const RealBall& b) { return a /= b; }
// Certainly equal: both the same number, with radius 0. Eigen's products ask for it.
inline bool operator==(const RealBall& a, const RealBall& b) { return arb_eq(a.get(), b.get()) != 0; }

// Certainly greater: every number of the one than every number of the other.
inline bool operator>(const RealBall& a, const RealBall& b) { return arb_gt(a.get(), b.get()) != 0; }

RealBall Sqrt(const RealBall& x);                            // not a number where x may be negative
inline RealBall sqrt(const RealBall& x) { return Sqrt(x); }  // for templates of doubles and balls
RealBall Sin(const RealBall& x);
RealBall Cos(const RealBall& x);
inline RealBall sin(const RealBall& x) { return Sin(x); }
inline RealBall cos(const RealBall& x) { return Cos(x); }

// Every number from one to the other.
RealBall Hull(double a, double b);

// Whether the ball contains a number; whether two balls have a number in common. What is not a number
// contains and overlaps everything.
bool Contains(const RealBall& ball, double number);
bool Overlaps(const RealBall& a, const RealBall& b);

double MidpointOf(const RealBall& ball);  // to the nearest double
// At least the distance of every number in the ball from MidpointOf(ball).
double RadiusOf(const RealBall& ball);
double LargestModulus(const RealBall& ball);  // no number in the ball has a larger one; infinite of NaN
// No number in the ball is less than the one, or more than the other; NaN if the ball is not a number.
double LowerBound(const RealBall& ball);
double UpperBound(const RealBall& ball);

// A rectangle in the complex plane: real and imaginary part are balls.
class ComplexBall {
 public:
  ComplexBall() { acb_init(value_); }
  // Exactly that number, or every real number in the ball.
  // NOLINTBEGIN(google-explicit-constructor)
  ComplexBall(double exact) : ComplexBall() { acb_set_d(value_, exact); }
  ComplexBall(const std::complex<double>& exact) : ComplexBall() {
    acb_set_d_d(value_, exact.real(), exact.imag());
  }
  ComplexBall(const RealBall& real) : ComplexBall() { acb_set_arb(value_, real.get()); }
  // NOLINTEND(google-explicit-constructor)
  // Every complex number within the radius of the midpoint, and the corners about them.
  ComplexBall(const std::complex<double>& midpoint, double radius);
  ComplexBall(const ComplexBall& other) : ComplexBall() { acb_set(value_, other.value_); }
  ComplexBall(ComplexBall&& other) noexcept : ComplexBall() { acb_swap(value_, other.value_); }
  ComplexBall& operator=(const ComplexBall& other) {
    acb_set(value_, other.value_);
    return *this;
  }
  ComplexBall& operator=(ComplexBall&& other) noexcept {
    acb_swap(value_, other.value_);
    return *this;
  }
  ~ComplexBall() { acb_clear(value_); }

  ComplexBall& operator+=(const ComplexBall& other) {
    acb_add(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  ComplexBall& operator-=(const ComplexBall& other) {
    acb_sub(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  ComplexBall& operator*=(const ComplexBall& other) {
    acb_mul(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  ComplexBall& operator/=(const ComplexBall& other) {
    acb_div(value_, value_, other.value_, kBallPrecision_bits);
    return *this;
  }
  ComplexBall operator-() const {
    ComplexBall negative;
    acb_neg(negative.value_, value_);
    return negative;
  }

  acb_ptr get() { return value_; }
  acb_srcptr get() const { return value_; }

 private:
  acb_t value_;
};

inline ComplexBall operator+(ComplexBall a, const ComplexBall& b) { return a += b; }
inline ComplexBall operator-(ComplexBall a, const ComplexBall& b) { return a -= b; }
inline ComplexBall operator*(ComplexBall a, const ComplexBall& b) { return a *= b; }
inline ComplexBall operator/(ComplexBall a, const ComplexBall& b) { return a /= b; }
inline bool operator==(const ComplexBall& a, const ComplexBall& b) { return acb_eq(a.get(), b.get()) != 0; }

bool Contains(const ComplexBall& ball, const std::complex<double>& number);
bool Overlaps(const ComplexBall& a, const ComplexBall& b);
bool IsExactlyReal(const ComplexBall& ball);  // its imaginary part is 0 with radius 0
std::complex<double> MidpointOf(const ComplexBall& ball);
double LargestModulus(const ComplexBall& ball);  // no number in the ball has a larger one

}  // namespace legible

namespace Eigen {

template <>
struct NumTraits<legible::RealBall> : NumTraits<double> {
  using Real = legible::RealBall;
  using NonInteger = legible::RealBall;
  using Nested = legible::RealBall;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 20, MulCost = 20 };
};

// To Eigen a scalar without a conjugate: adjoint() is transpose(), and dot() is bilinear.
template <>
struct NumTraits<legible::ComplexBall> : NumTraits<double> {
  using Real = legible::ComplexBall;
  using NonInteger = legible::ComplexBall;
  using Nested = legible::ComplexBall;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 4, AddCost = 40, MulCost = 80 };
};

}  // namespace Eigen

namespace legible {

using RealBallVector = Eigen::Matrix<RealBall, Eigen::Dynamic, 1>;
using RealBallMatrix = Eigen::Matrix<RealBall, Eigen::Dynamic, Eigen::Dynamic>;
using ComplexBallVector = Eigen::Matrix<ComplexBall, Eigen::Dynamic, 1>;
using ComplexBallMatrix = Eigen::Matrix<ComplexBall, Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace legible
