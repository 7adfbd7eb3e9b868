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

constexpr double kLargestRadius = 10;

// --- The radial factor of a lens and its derivative by r2. -----------------------------------------------

struct RadialFactor {
  double value;
  double slope;  // d value / d r2
};

// N / D of the pinhole family.
struct RationalFactor : RadialFactor {
  double denominator;
};

RationalFactor RationalFactorAt(const Distortion& k, double r2) {
  const double numerator = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double denominator = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double value = numerator / denominator;
  const double d_numerator = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double d_denominator = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  return {{value, (d_numerator - value * d_denominator) / denominator}, denominator};
}

// d (arctan(r) / r) / d r2.
double ArctanRatioSlope(double r2, double ratio) {
  constexpr double kSeriesUpTo = 1.0 / 16;
  if (r2 > kSeriesUpTo) return (1 / (1 + r2) - ratio) / (2 * r2);
  double sum = 0;
  for (int n = 13; n >= 1; --n) sum = (n % 2 == 0 ? 1.0 : -1.0) * n / (2 * n + 1) + r2 * sum;
  return sum;
}

// theta_d / r of the fisheye.
struct FisheyeFactor : RadialFactor {
  double ratio;   // theta / r
  double theta2;  // theta^2
};

FisheyeFactor FisheyeFactorAt(const Distortion& k, double r2) {
  const double ratio = ArctanRatio(r2), ratio_slope = ArctanRatioSlope(r2, ratio);
  const double theta2 = r2 * ratio * ratio;
  const double theta2_slope = ratio * (ratio + 2 * r2 * ratio_slope);
  const double gain = 1 + theta2 * (k[0] + theta2 * (k[1] + theta2 * (k[2] + theta2 * k[3])));
  const double d_gain = k[0] + theta2 * (2 * k[1] + theta2 * (3 * k[2] + theta2 * 4 * k[3]));
  return {{ratio * gain, ratio_slope * gain + ratio * d_gain * theta2_slope}, ratio, theta2};
}

RadialFactor RadialFactorAt(LensModel lens, const Distortion& k, double r2) {
  if (lens == LensModel::kFisheye) return FisheyeFactorAt(k, r2);
  return RationalFactorAt(k, r2);
}

// d Distort / d point of a lens without tangential terms.
Eigen::Matrix2d RadialJacobian(const RadialFactor& radial, const Eigen::Vector2d& x) {
  return radial.value * Eigen::Matrix2d::Identity() + 2 * radial.slope * x * x.transpose();
}

// d Distort / d point of the pinhole family; symmetric, for the distortion is a gradient.
Eigen::Matrix2d RationalJacobian(const Distortion& k, const RadialFactor& radial, const Eigen::Vector2d& x) {
  const double p1 = k[2], p2 = k[3];
  Eigen::Matrix2d tangential;
  tangential << 6 * p2 * x[0] + 2 * p1 * x[1], 2 * p1 * x[0] + 2 * p2 * x[1],  //
      2 * p1 * x[0] + 2 * p2 * x[1], 2 * p2 * x[0] + 6 * p1 * x[1];
  return RadialJacobian(radial, x) + tangential;
}

Eigen::Matrix2d PointJacobian(LensModel lens, const Distortion& k, const Eigen::Vector2d& x) {
  const double r2 = x.squaredNorm();
  if (lens == LensModel::kFisheye) return RadialJacobian(FisheyeFactorAt(k, r2), x);
  return RationalJacobian(k, RationalFactorAt(k, r2), x);
}

// --- Where the lens model is one-to-one: polynomials in r or theta, their sign by Bernstein coefficients.
// ---------

constexpr int kDegree = 13;
using Polynomial = std::array<double, kDegree + 1>;  // coefficients of 1, r, r^2, ...

// The distortion of the pinhole family is the gradient of a function of the point, so it is one-to-one on a
// disk where its Jacobian is positive definite. Along the point x and across it, with c the cosine between x
// and (p2, p1), that is
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

// d theta_d / d theta of the fisheye, by theta. As theta_d / theta is its mean, the lens is one-to-one where
// it is positive.
Polynomial AngularSlope(const Distortion& k) {
  return {1, 0, 3 * k[0], 0, 5 * k[1], 0, 7 * k[2], 0, 9 * k[3]};
}

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
bool IsOneToOneWithin(LensModel lens, const Distortion& k, double radius) {
  if (lens == LensModel::kFisheye) return IsPositiveUpTo(AngularSlope(k), std::atan(radius));
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

Trial TrialAt(LensModel lens, const Distortion& k, const Eigen::Vector2d& distorted,
              const Eigen::Vector2d& x) {
  const Eigen::Vector2d residual = distorted - Distort<double>(lens, k, x);
  return {x, residual, residual.norm()};
}

// The better point to which a Newton step leads, halved where the whole one leads to a worse one.
Trial NewtonStep(LensModel lens, const Distortion& k, const Eigen::Vector2d& distorted, const Trial& from) {
  Eigen::Vector2d step = PointJacobian(lens, k, from.x).inverse() * from.residual;
  for (int halvings = 0; halvings < 20; ++halvings, step *= 0.5) {
    Trial next = TrialAt(lens, k, distorted, from.x + step);
    if (next.error < from.error) return next;
  }
  return from;
}

// Newton from `start` until the error is rounding; nothing where it does not get there or ends beyond the
// disk in which the answer is the only one.
std::optional<Eigen::Vector2d> UndistortFrom(LensModel lens, const Distortion& k,
                                             const Eigen::Vector2d& distorted, const Eigen::Vector2d& start) {
  constexpr int kMaxSteps = 50;  // some five do, but near the fold each only halves the error at first
  const double scale = 1 + distorted.norm();
  Trial best = TrialAt(lens, k, distorted, start);
  for (int i = 0; i < kMaxSteps && best.error > 1e-15 * scale; ++i) {
    const Trial next = NewtonStep(lens, k, distorted, best);
    if (!(next.error < best.error)) break;
    best = next;
  }
  if (best.error <= 1e-12 * scale && IsOneToOneWithin(lens, k, best.x.norm())) return best.x;
  return std::nullopt;
}

// Where the radial part alone puts the undistorted point, by bisection.
Eigen::Vector2d UndistortRadially(LensModel lens, const Distortion& k, const Eigen::Vector2d& distorted) {
  const double target = distorted.norm();
  const auto is_within = [&](double r) {
    const double reached = r * RadialFactorAt(lens, k, r * r).value;
    return 0 <= reached && reached <= target;  // at a pole rounding can turn the sign
  };
  return distorted * (LargestWhere(is_within, MonotonicRadius(lens, k)) / target);
}

DistortedPoint RationalWithJacobians(const Distortion& k, const Eigen::Vector2d& x) {
  const double r2 = x.squaredNorm();
  const RationalFactor radial = RationalFactorAt(k, r2);
  const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
  const Eigen::Matrix<double, 2, 3> by_numerator = x * powers.transpose() / radial.denominator;

  DistortedPoint result;
  result.point = Distort<double>(LensModel::kRational, k, x);
  result.d_point_d_undistorted = RationalJacobian(k, radial, x);
  result.d_point_d_coefficients.col(0) = by_numerator.col(0);
  result.d_point_d_coefficients.col(1) = by_numerator.col(1);
  result.d_point_d_coefficients.col(2) << 2 * x[0] * x[1], r2 + 2 * x[1] * x[1];
  result.d_point_d_coefficients.col(3) << r2 + 2 * x[0] * x[0], 2 * x[0] * x[1];
  result.d_point_d_coefficients.col(4) = by_numerator.col(2);
  result.d_point_d_coefficients.rightCols<3>() = -radial.value * by_numerator;
  return result;
}

DistortedPoint FisheyeWithJacobians(const Distortion& k, const Eigen::Vector2d& x) {
  const FisheyeFactor radial = FisheyeFactorAt(k, x.squaredNorm());
  DistortedPoint result;
  result.point = Distort<double>(LensModel::kFisheye, k, x);
  result.d_point_d_undistorted = RadialJacobian(radial, x);
  result.d_point_d_coefficients.setZero();
  double power = radial.ratio;
  for (int i = 0; i < static_cast<int>(LensModel::kFisheye); ++i) {
    power *= radial.theta2;
    result.d_point_d_coefficients.col(i) = power * x;
  }
  return result;
}

}  // namespace

DistortedPoint DistortWithJacobians(LensModel lens, const Distortion& k, const Eigen::Vector2d& undistorted) {
  return lens == LensModel::kFisheye ? FisheyeWithJacobians(k, undistorted)
                                     : RationalWithJacobians(k, undistorted);
}

std::optional<Eigen::Vector2d> Undistort(LensModel lens, const Distortion& k,
                                         const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  const auto undistorted = UndistortFrom(lens, k, distorted, UndistortIdeally(lens, distorted));
  return undistorted ? undistorted : UndistortFrom(lens, k, distorted, UndistortRadially(lens, k, distorted));
}

Eigen::Vector2d UndistortIdeally(LensModel lens, const Eigen::Vector2d& distorted) {
  const double theta = distorted.norm();
  if (lens != LensModel::kFisheye || theta == 0) return distorted;
  const double radius = theta < std::atan(kLargestRadius) ? std::tan(theta) : kLargestRadius;
  return distorted * (radius / theta);
}

Eigen::Vector2d Project(const Camera& camera, const Eigen::Vector3d& x_in_camera) {
  if (!(x_in_camera.z() > 0)) throw std::invalid_argument("Project: the point is not in front of the camera");
  return ProjectNormalised(camera, x_in_camera.hnormalized());
}

Eigen::Vector2d ProjectNormalised(const Camera& camera, const Eigen::Vector2d& x) {
  const Eigen::Vector2d distorted = Distort<double>(camera.lens, camera.distortion, x);
  return {camera.fx_px * distorted[0] + camera.cx_px, camera.fy_px * distorted[1] + camera.cy_px};
}

std::optional<Eigen::Vector2d> Unproject(const Camera& camera, const Eigen::Vector2d& pixel) {
  return Undistort(camera.lens, camera.distortion,
                   {(pixel[0] - camera.cx_px) / camera.fx_px, (pixel[1] - camera.cy_px) / camera.fy_px});
}

double MonotonicRadius(LensModel lens, const Distortion& k) {
  return LargestWhere([&](double r) { return IsOneToOneWithin(lens, k, r); }, kLargestRadius);
}

}  // namespace legible
