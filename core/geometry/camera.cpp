#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace legible {
namespace {

// --- The radial factor N / D of a lens and its derivative by r2. -----------------------------------------

struct RadialFactor {
  double value;
  double slope;        // d value / d r2
  double denominator;  // D
};

RadialFactor RadialFactorAt(const Distortion& k, double r2) {
  const double numerator = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double denominator = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double value = numerator / denominator;
  const double d_numerator = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double d_denominator = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  return {value, (d_numerator - value * d_denominator) / denominator, denominator};
}

// d Distort / d point; symmetric, for the distortion is a gradient.
Eigen::Matrix2d PointJacobian(const Distortion& k, const RadialFactor& radial, const Eigen::Vector2d& x) {
  const double p1 = k[2], p2 = k[3];
  Eigen::Matrix2d tangential;
  tangential << 6 * p2 * x[0] + 2 * p1 * x[1], 2 * p1 * x[0] + 2 * p2 * x[1],  //
      2 * p1 * x[0] + 2 * p2 * x[1], 2 * p2 * x[0] + 6 * p1 * x[1];
  return radial.value * Eigen::Matrix2d::Identity() + 2 * radial.slope * x * x.transpose() + tangential;
}

// --- Where the lens model is one-to-one: polynomials in r, their sign by Bernstein coefficients. ---------

constexpr int kDegree = 13;
using Polynomial = std::array<double, kDegree + 1>;  // coefficients of 1, r, r^2, ...

// The distortion is the gradient of a function of the point, so it is one-to-one on a disk where its Jacobian
// is positive definite. Along the point x and across it, with c the cosine between x and (p2, p1), that is
//   f' + 6 c p r    2 s p r            f = r N / D the radial part, p = |(p1, p2)|, s^2 = 1 - c^2.
//   2 s p r         f / r + 2 c p r
// The determinant, a parabola in c, is least at c = -1 if f' + 3 f / r >= 16 p r, and positive there if also
// f' > 6 p r and f / r > 2 p r. All this follows from f' > 6.4 p r between the centre and r, since f / r is
// the mean of f' there. This is (f' - 6.4 p r) D^2 = (N + 2 r2 N') D - N (2 r2 D') - 6.4 p r D^2.
Polynomial SlopeNumerator(const Distortion& k) {
  const std::array<double, 4> n = {1, k[0], k[1], k[4]};
  const std::array<double, 4> d = {1, k[5], k[6], k[7]};
  const double tangential = 6.4 * std::hypot(k[2], k[3]);
  Polynomial slope = {};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      slope[2 * (i + j)] += (1 + 2 * i - 2 * j) * n[i] * d[j];
      slope[2 * (i + j) + 1] -= tangential * d[i] * d[j];
    }
  }
  return slope;
}

Polynomial Denominator(const Distortion& k) { return {1, 0, k[5], 0, k[6], 0, k[7]}; }

// Coefficients in the Bernstein basis of [0, upper]. The first and the last are the values at the two ends,
// and the polynomial lies between the smallest and the largest.
Polynomial BernsteinCoefficients(const Polynomial& polynomial, double upper) {
  Polynomial bernstein;
  bernstein.fill(polynomial[0]);
  double power = upper;
  for (int i = 1; i <= kDegree; ++i, power *= upper) {
    double weight = polynomial[i] * power;
    for (int j = kDegree; j >= i; --j) {  // weight = polynomial[i] upper^i C(j, i) / C(kDegree, i)
      bernstein[j] += weight;
      weight *= static_cast<double>(j - i) / j;
    }
  }
  return bernstein;
}

// Whether a polynomial given by its Bernstein coefficients is positive on its interval, by halving the
// interval (de Casteljau) where the coefficients' signs leave it open. A double zero is never decided: it
// ends as not positive.
bool IsPositive(const Polynomial& bernstein, int halvings_left = 50) {
  if (!(bernstein.front() > 0 && bernstein.back() > 0)) return false;
  if (std::ranges::all_of(bernstein, [](double b) { return b > 0; })) return true;
  if (halvings_left == 0) return false;
  Polynomial left = {}, right = bernstein;
  for (int i = 0; i <= kDegree; ++i) {
    left[i] = right[0];
    for (int j = 0; j < kDegree - i; ++j) right[j] = 0.5 * (right[j] + right[j + 1]);
  }
  return IsPositive(left, halvings_left - 1) && IsPositive(right, halvings_left - 1);
}

// Whether a polynomial is positive on [0, upper]. The sum of its negative terms settles most cases, and
// quickly.
bool IsPositiveUpTo(const Polynomial& polynomial, double upper) {
  double least = polynomial[0];
  double power = upper;
  for (int i = 1; i <= kDegree; ++i, power *= upper) least += std::min(polynomial[i] * power, 0.0);
  return least > 0 || IsPositive(BernsteinCoefficients(polynomial, upper));
}

// Whether the lens model is one-to-one on the disk of that radius about the image centre.
bool IsOneToOneWithin(const Distortion& k, double radius) {
  return IsPositiveUpTo(SlopeNumerator(k), radius) && IsPositiveUpTo(Denominator(k), radius);
}

// The largest value in [0, upper] for which a predicate holds that holds up to some value and not beyond.
template <typename Predicate>
double LargestWhere(const Predicate& holds, double upper) {
  if (holds(upper)) return upper;
  double inside = 0;
  for (double outside = upper;;) {
    const double middle = std::midpoint(inside, outside);
    if (!(inside < middle && middle < outside)) return inside;
    (holds(middle) ? inside : outside) = middle;
  }
}

// --- The inverse of Distort. -----------------------------------------------------------------------------

struct Trial {
  Eigen::Vector2d x;
  Eigen::Vector2d residual;  // what Distort(x) lacks
  double error;              // |residual|
};

Trial TrialAt(const Distortion& k, const Eigen::Vector2d& distorted, const Eigen::Vector2d& x) {
  const Eigen::Vector2d residual = distorted - Distort<double>(k, x);
  return {x, residual, residual.norm()};
}

// The better point to which a Newton step leads, halved where the whole one leads to a worse one.
Trial NewtonStep(const Distortion& k, const Eigen::Vector2d& distorted, const Trial& from) {
  const Eigen::Matrix2d jacobian = PointJacobian(k, RadialFactorAt(k, from.x.squaredNorm()), from.x);
  Eigen::Vector2d step = jacobian.inverse() * from.residual;
  for (int halvings = 0; halvings < 20; ++halvings, step *= 0.5) {
    Trial next = TrialAt(k, distorted, from.x + step);
    if (next.error < from.error) return next;
  }
  return from;
}

// Newton from `start` until the error is rounding; nothing where it does not get there or ends beyond the
// disk in which the answer is the only one.
std::optional<Eigen::Vector2d> UndistortFrom(const Distortion& k, const Eigen::Vector2d& distorted,
                                             const Eigen::Vector2d& start) {
  constexpr int kMaxSteps = 50;  // some five do, but near the fold each only halves the error at first
  const double scale = 1 + distorted.norm();
  Trial best = TrialAt(k, distorted, start);
  for (int i = 0; i < kMaxSteps && best.error > 1e-15 * scale; ++i) {
    const Trial next = NewtonStep(k, distorted, best);
    if (!(next.error < best.error)) break;
    best = next;
  }
  if (best.error <= 1e-12 * scale && IsOneToOneWithin(k, best.x.norm())) return best.x;
  return std::nullopt;
}

// Where the radial part alone puts the undistorted point, by bisection.
Eigen::Vector2d UndistortRadially(const Distortion& k, const Eigen::Vector2d& distorted) {
  const double target = distorted.norm();
  const auto is_within = [&](double r) {
    const double reached = r * RadialFactorAt(k, r * r).value;
    return 0 <= reached && reached <= target;  // at a pole rounding can turn the sign
  };
  return distorted * (LargestWhere(is_within, MonotonicRadius(k)) / target);
}

}  // namespace

DistortedPoint DistortWithJacobians(const Distortion& k, const Eigen::Vector2d& undistorted) {
  const Eigen::Vector2d& x = undistorted;
  const double r2 = x.squaredNorm();
  const RadialFactor radial = RadialFactorAt(k, r2);
  const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
  const Eigen::Matrix<double, 2, 3> by_numerator = x * powers.transpose() / radial.denominator;

  DistortedPoint result;
  result.point = Distort<double>(k, x);
  result.d_point_d_undistorted = PointJacobian(k, radial, x);
  result.d_point_d_coefficients.col(0) = by_numerator.col(0);
  result.d_point_d_coefficients.col(1) = by_numerator.col(1);
  result.d_point_d_coefficients.col(2) << 2 * x[0] * x[1], r2 + 2 * x[1] * x[1];
  result.d_point_d_coefficients.col(3) << r2 + 2 * x[0] * x[0], 2 * x[0] * x[1];
  result.d_point_d_coefficients.col(4) = by_numerator.col(2);
  result.d_point_d_coefficients.rightCols<3>() = -radial.value * by_numerator;
  return result;
}

std::optional<Eigen::Vector2d> Undistort(const Distortion& k, const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  const std::optional<Eigen::Vector2d> undistorted = UndistortFrom(k, distorted, distorted);
  return undistorted ? undistorted : UndistortFrom(k, distorted, UndistortRadially(k, distorted));
}

Eigen::Vector2d Project(const Camera& camera, const Eigen::Vector3d& x_in_camera) {
  if (!(x_in_camera.z() > 0)) throw std::invalid_argument("Project: the point is not in front of the camera");
  return ProjectNormalised(camera, x_in_camera.hnormalized());
}

Eigen::Vector2d ProjectNormalised(const Camera& camera, const Eigen::Vector2d& x) {
  const Eigen::Vector2d distorted = Distort<double>(camera.distortion, x);
  return {camera.fx_px * distorted[0] + camera.cx_px, camera.fy_px * distorted[1] + camera.cy_px};
}

std::optional<Eigen::Vector2d> Unproject(const Camera& camera, const Eigen::Vector2d& pixel) {
  return Undistort(camera.distortion,
                   {(pixel[0] - camera.cx_px) / camera.fx_px, (pixel[1] - camera.cy_px) / camera.fy_px});
}

double MonotonicRadius(const Distortion& k) {
  constexpr double kLargestRadius = 10;
  return LargestWhere([&](double r) { return IsOneToOneWithin(k, r); }, kLargestRadius);
}

}  // namespace legible
