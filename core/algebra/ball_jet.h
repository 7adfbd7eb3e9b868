// Numbers along a piece of a curve: enclosures of a function's values on the piece and of its derivatives by
// the curve's parameter there, carried on together by the rules of differentiation.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "core/algebra/ball.h"

namespace legible {

class RealBallJet {
 public:
  RealBallJet() = default;  // exactly 0 everywhere
  // Exactly that number everywhere; implicit, for Eigen makes its zeros and ones of numbers.
  // NOLINTNEXTLINE(google-explicit-constructor)
  RealBallJet(double constant) : value_(constant) {}
  RealBallJet(RealBall value, RealBall rate) : value_(std::move(value)), rate_(std::move(rate)) {}

  const RealBall& value() const { return value_; }
  const RealBall& rate() const { return rate_; }

  RealBallJet& operator+=(const RealBallJet& other) {
    value_ += other.value_;
    rate_ += other.rate_;
    return *this;
  }
  RealBallJet& operator-=(const RealBallJet& other) {
    value_ -= other.value_;
    rate_ -= other.rate_;
    return *this;
  }
  RealBallJet& operator*=(const RealBallJet& other) {
    rate_ = rate_ * other.value_ + value_ * other.rate_;
    value_ *= other.value_;
    return *this;
  }
  // Not numbers where the divisor may be 0.
  RealBallJet& operator/=(const RealBallJet& other) {
    value_ /= other.value_;
    rate_ = (rate_ - value_ * other.rate_) / other.value_;
    return *this;
  }
  RealBallJet operator-() const { return {-value_, -rate_}; }

 private:
  RealBall value_, rate_;
};

inline RealBallJet operator+(RealBallJet a, const RealBallJet& b) { return a += b; }
inline RealBallJet operator-(RealBallJet a, const RealBallJet& b) { return a -= b; }
inline RealBallJet operator*(RealBallJet a, const RealBallJet& b) { return a *= b; }
inline RealBallJet operator/(RealBallJet a, const RealBallJet& b) { return a /= b; }
// Certainly equal everywhere, as Eigen's products ask; certainly greater everywhere.
inline bool operator==(const RealBallJet& a, const RealBallJet& b) {
  return a.value() == b.value() && a.rate() == b.rate();
}
inline bool operator>(const RealBallJet& a, const RealBallJet& b) { return a.value() > b.value(); }

inline RealBallJet sqrt(const RealBallJet& x) {
  const RealBall root = Sqrt(x.value());
  return {root, x.rate() / (root + root)};
}
inline RealBallJet sin(const RealBallJet& x) { return {Sin(x.value()), Cos(x.value()) * x.rate()}; }
inline RealBallJet cos(const RealBallJet& x) { return {Cos(x.value()), -Sin(x.value()) * x.rate()}; }

}  // namespace legible

namespace Eigen {

template <>
struct NumTraits<legible::RealBallJet> : NumTraits<double> {
  using Real = legible::RealBallJet;
  using NonInteger = legible::RealBallJet;
  using Nested = legible::RealBallJet;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 4, AddCost = 40, MulCost = 60 };
};

}  // namespace Eigen
