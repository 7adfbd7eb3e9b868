#include "core/algebra/root_certificate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace legible {
namespace {

constexpr int kMaxNewtonSteps = 10;
constexpr double kShortStep = 1e-6;  // relative to the numbers; before, steps may grow on the way to a root

// Newton steps more where the proof fails or leaves the root wide, with residuals in balls: near other roots
// those in doubles are too coarse.
constexpr int kMaxRefinements = 4;

// Of a root's distance from its midpoint, relative to the numbers: no refinement is worth its time.
constexpr double kKnownToRounding = 1e-13;

// More than all roundings of a sum or product of a few hundred positive doubles.
constexpr double kUpward = 1 + 1e-12, kDownward = 1 - 1e-12;

double MaxNorm(const Eigen::VectorXcd& z) { return z.cwiseAbs().maxCoeff(); }

// Until the steps, once short, no longer become shorter.
Eigen::VectorXcd Polished(const QuadricSystem& system, Eigen::VectorXcd z) {
  double last_step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const auto at = Evaluate(system, z);
    const Eigen::VectorXcd step = at.jacobian.partialPivLu().solve(at.values);
    const double length = MaxNorm(step);
    if (!std::isfinite(length) || (length >= last_step && length < kShortStep * (1 + MaxNorm(z)))) break;
    z -= step;
    last_step = length;
  }
  return z;
}

// What Krawczyk's test asks of T(z) = z - Y F(z), all in the largest modulus over the unknowns, Y about the
// inverse of the Jacobian J at the midpoint z0.
struct KrawczykTest {
  Eigen::VectorXcd correction;  // T(z0) - z0, about
  double step = 0;              // bounds |T(z0) - z0|
  double derivative = 0;        // bounds |T'(z0)| = |I - Y J|
  double derivative_slope = 0;  // bounds |T'(z) - T'(z0)| over |z - z0|
};

// Where the Jacobian is singular Y is not finite, and the modulus of what comes of it infinite: the test
// fails.
KrawczykTest TestAt(const QuadricSystem& system, const Eigen::VectorXcd& midpoint) {
  const auto at = Evaluate(system, ComplexBallVector(midpoint.cast<ComplexBall>()));
  const Eigen::Index n = system.size();
  const Eigen::MatrixXcd inverse = Evaluate(system, midpoint).jacobian.inverse();
  const ComplexBallMatrix preconditioner = inverse.cast<ComplexBall>();
  const ComplexBallVector step = preconditioner.lazyProduct(at.values);
  const ComplexBallMatrix product = preconditioner.lazyProduct(at.jacobian);
  KrawczykTest test{Eigen::VectorXcd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    double derivative = 0, slope = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      derivative += LargestModulus(i == j ? product(i, j) - ComplexBall(1) : product(i, j));
      slope += std::abs(inverse(i, j)) * system.second_derivative_bounds()[static_cast<size_t>(j)];
    }
    test.correction[i] = -MidpointOf(step[i]);
    test.step = std::max(test.step, LargestModulus(step[i]));
    test.derivative = std::max(test.derivative, derivative * kUpward);
    test.derivative_slope = std::max(test.derivative_slope, slope * kUpward);
  }
  return test;
}

// T maps the points within r of z0 among themselves where step + derivative r + slope r^2 / 2 <= r, and
// brings any two nearer to each other where derivative + slope r < 1: it then has exactly one fixed point
// there.
std::optional<CertifiedRoot> Certified(const Eigen::VectorXcd& midpoint, const KrawczykTest& test) {
  const auto reach = [&](double r) {
    return (test.step + test.derivative * r + 0.5 * test.derivative_slope * r * r) * kUpward;
  };
  const double contraction = (1 - test.derivative) * kDownward;
  const double unique_radius = contraction / test.derivative_slope * kDownward;
  // The largest that one may need; the smallest positive number where the midpoint is the root itself.
  const double first_radius =
      std::max(2 * test.step / contraction * kUpward, std::numeric_limits<double>::min());
  if (!(contraction > 0 && first_radius < unique_radius && reach(first_radius) <= first_radius)) return {};
  return CertifiedRoot{midpoint, reach(first_radius), unique_radius, false};
}

// Of a real system, conjugates of roots are roots: one whose conjugate lies where it is unique is its own.
// None where the root may be real or not.
std::optional<CertifiedRoot> KnownRealOrNot(CertifiedRoot root) {
  const double imaginary = root.midpoint.imag().cwiseAbs().maxCoeff();
  if (imaginary > root.radius) return root;
  if (!((2 * imaginary + root.radius) * kUpward < root.unique_radius)) return {};
  root.is_real = true;
  root.midpoint = root.midpoint.real().cast<std::complex<double>>().eval();
  root.unique_radius = (root.unique_radius - imaginary) * kDownward;
  return root;
}

enum class Relation { kOther, kSame, kUnknown };

Relation RelationOf(const CertifiedRoot& a, const CertifiedRoot& b) {
  const double distance = MaxNorm(a.midpoint - b.midpoint);
  if (distance * kDownward > (a.radius + b.radius) * kUpward) return Relation::kOther;
  if ((distance + a.radius) * kUpward < b.unique_radius) return Relation::kSame;
  if ((distance + b.radius) * kUpward < a.unique_radius) return Relation::kSame;
  return Relation::kUnknown;
}

Relation RelationOf(const CertifiedRoot& root, const std::vector<CertifiedRoot>& others) {
  for (const CertifiedRoot& other : others) {
    const Relation relation = RelationOf(root, other);
    if (relation != Relation::kOther) return relation;
  }
  return Relation::kOther;
}

}  // namespace

std::optional<CertifiedRoot> CertifyRoot(const QuadricSystem& system, const Eigen::VectorXcd& z) {
  Eigen::VectorXcd midpoint = Polished(system, z);
  std::optional<CertifiedRoot> root;
  for (int refinement = 0; refinement <= kMaxRefinements && midpoint.allFinite() && !root; ++refinement) {
    const KrawczykTest test = TestAt(system, midpoint);
    root = Certified(midpoint, test);
    midpoint += test.correction;
  }
  // A proof may hold far around a midpoint at which Newton's method stopped short; from there on it
  // converges.
  while (root && root->radius > kKnownToRounding * (1 + MaxNorm(midpoint))) {
    const KrawczykTest test = TestAt(system, midpoint);
    const std::optional<CertifiedRoot> nearer = Certified(midpoint, test);
    if (!nearer || nearer->radius > root->radius / 2) break;
    root = nearer;
    midpoint += test.correction;
  }
  return root && system.is_real() ? KnownRealOrNot(*root) : root;
}

CertifiedRoots CertifyRoots(const QuadricSystem& system,
                            const std::vector<Eigen::VectorXcd>& approximations) {
  CertifiedRoots result;
  for (const Eigen::VectorXcd& approximation : approximations) {
    const std::optional<CertifiedRoot> root = CertifyRoot(system, approximation);
    const Relation relation = root ? RelationOf(*root, result.roots) : Relation::kUnknown;
    if (relation == Relation::kOther) result.roots.push_back(*root);
    if (relation == Relation::kUnknown) ++result.uncertified;
  }
  return result;
}

}  // namespace legible
