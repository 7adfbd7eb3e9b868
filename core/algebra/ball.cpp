#include "core/algebra/ball.h"

#include <cmath>
#include <limits>

namespace legible {
namespace {

// A magnitude has 30 bits and fits a double, unless its exponent does not.
double UpperDouble(const mag_struct* magnitude) {
  if (mag_is_zero(magnitude)) return 0;
  return std::nextafter(mag_get_d(magnitude), std::numeric_limits<double>::infinity());
}

void AddError(arb_ptr ball, double radius) {
  mag_t error;
  mag_init(error);
  mag_set_d(error, radius);
  arb_add_error_mag(ball, error);
  mag_clear(error);
}

using BoundOfArb = void (*)(arf_struct*, const arb_struct*, slong);

double Bound(const RealBall& ball, BoundOfArb bound_of, arf_rnd_t rounding) {
  arf_t bound;
  arf_init(bound);
  bound_of(bound, ball.get(), kBallPrecision_bits);
  const double rounded = arf_get_d(bound, rounding);
  arf_clear(bound);
  return rounded;
}

}  // namespace

RealBall::RealBall(double midpoint, double radius) : RealBall(midpoint) { AddError(value_, radius); }

RealBall Sqrt(const RealBall& x) {
  RealBall root;
  arb_sqrt(root.get(), x.get(), kBallPrecision_bits);
  return root;
}

RealBall Sin(const RealBall& x) {
  RealBall sine;
  arb_sin(sine.get(), x.get(), kBallPrecision_bits);
  return sine;
}

RealBall Cos(const RealBall& x) {
  RealBall cosine;
  arb_cos(cosine.get(), x.get(), kBallPrecision_bits);
  return cosine;
}

RealBall Hull(double a, double b) {
  RealBall hull;
  arb_union(hull.get(), RealBall(a).get(), RealBall(b).get(), kBallPrecision_bits);
  return hull;
}

bool Contains(const RealBall& ball, double number) {
  return arb_contains(ball.get(), RealBall(number).get()) != 0;
}

bool Overlaps(const RealBall& a, const RealBall& b) { return arb_overlaps(a.get(), b.get()) != 0; }

double MidpointOf(const RealBall& ball) { return arf_get_d(arb_midref(ball.get()), ARF_RND_NEAR); }

double RadiusOf(const RealBall& ball) { return LargestModulus(ball - RealBall(MidpointOf(ball))); }

double LargestModulus(const RealBall& ball) {
  mag_t modulus;
  mag_init(modulus);
  arb_get_mag(modulus, ball.get());
  const double bound = UpperDouble(modulus);
  mag_clear(modulus);
  return bound;
}

double LowerBound(const RealBall& ball) { return Bound(ball, arb_get_lbound_arf, ARF_RND_FLOOR); }

double UpperBound(const RealBall& ball) { return Bound(ball, arb_get_ubound_arf, ARF_RND_CEIL); }

ComplexBall::ComplexBall(const std::complex<double>& midpoint, double radius) : ComplexBall(midpoint) {
  AddError(acb_realref(value_), radius);
  AddError(acb_imagref(value_), radius);
}

bool Contains(const ComplexBall& ball, const std::complex<double>& number) {
  return acb_contains(ball.get(), ComplexBall(number).get()) != 0;
}

bool Overlaps(const ComplexBall& a, const ComplexBall& b) { return acb_overlaps(a.get(), b.get()) != 0; }

bool IsExactlyReal(const ComplexBall& ball) { return acb_is_real(ball.get()) != 0; }

std::complex<double> MidpointOf(const ComplexBall& ball) {
  return {arf_get_d(arb_midref(acb_realref(ball.get())), ARF_RND_NEAR),
          arf_get_d(arb_midref(acb_imagref(ball.get())), ARF_RND_NEAR)};
}

double LargestModulus(const ComplexBall& ball) {
  mag_t modulus;
  mag_init(modulus);
  acb_get_mag(modulus, ball.get());
  const double bound = UpperDouble(modulus);
  mag_clear(modulus);
  return bound;
}

}  // namespace legible
