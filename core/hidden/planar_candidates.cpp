#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/algebra/polynomial.h"
#include "core/algebra/root_certificate.h"
#include "core/hidden/affine_forms.h"
#include "core/hidden/mode_candidates.h"

namespace legible {
namespace {

using Complex = std::complex<double>;
using Complex2 = Eigen::Matrix<Complex, 2, 1>;

constexpr int kUnknowns = 4;  // x, y, cos phi, sin phi
constexpr int kSamples = 16;  // more than twice the degree in e = exp(i phi), which is 8 at most
constexpr int kHighestPower = 4;

// Coefficients (of e^-4 … e^4) below this part of the largest are rounding.
constexpr double kLeastCoefficient = 1e-11;

// The platform's joint turned by phi, from e = exp(i phi), complex where e is not on the unit circle.
Complex2 Turned(const HeldJoint& joint, const Complex& e) {
  const Complex c = (e + 1.0 / e) / 2.0, s = (e - 1.0 / e) / Complex(0, 2);
  const double x = joint.turned_m.x(), y = joint.turned_m.y();
  return {c * x - s * y, s * x + c * y};
}

Eigen::Vector2d NormalOf(const VertexSpace& line) { return {-line.along.y(), line.along.x()}; }

// Where p has to be for a phi by two equations, linear in it, of the three. From the origin at which the
// first joint's circle has its centre: k_i = m_i - R b_i, less k_0.
struct LinearPart {
  Eigen::Matrix<Complex, 2, 2> matrix;
  Complex2 right;
};

// Circles first. Two circles' difference: 2 (k_j - k_0) p = |k_j - k_0|^2 + r_0^2 - r_j^2; a line: n p = n
// k_j.
LinearPart LinearPartAt(const std::vector<HeldJoint>& three, const Complex& e) {
  const auto k = [&](size_t i) -> Complex2 {
    return three[i].space.point_m.head<2>().cast<Complex>() - Turned(three[i], e);
  };
  LinearPart part;
  for (size_t i = 1; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i - 1);
    const Complex2 apart = k(i) - k(0);
    if (three[i].space.is_circle) {
      const double radii_m2 = three[0].space.radius_m * three[0].space.radius_m -
                              three[i].space.radius_m * three[i].space.radius_m;
      part.matrix.row(row) = 2.0 * apart.transpose();
      part.right[row] = apart.cwiseProduct(apart).sum() + radii_m2;
    } else {
      const Complex2 n = NormalOf(three[i].space).cast<Complex>();
      part.matrix.row(row) = n.transpose();
      part.right[row] = n.cwiseProduct(apart).sum();
    }
  }
  return part;
}

// Zero where p, solved from the linear part, meets the first joint's space too; without division.
Complex Resultant(const std::vector<HeldJoint>& three, const Complex& e) {
  const LinearPart part = LinearPartAt(three, e);
  const Complex determinant = part.matrix.determinant();
  Eigen::Matrix<Complex, 2, 2> adjugate;
  adjugate << part.matrix(1, 1), -part.matrix(0, 1), -part.matrix(1, 0), part.matrix(0, 0);
  const Complex2 scaled = adjugate * part.right;
  const VertexSpace& first = three[0].space;
  if (!first.is_circle) return scaled.cwiseProduct(NormalOf(first).cast<Complex>()).sum();
  return scaled.cwiseProduct(scaled).sum() - determinant * determinant * first.radius_m * first.radius_m;
}

// Coefficients of e^-4 … e^4 by the discrete Fourier transform, those at both ends that are rounding left
// out.
Eigen::VectorXcd ResultantCoefficients(const std::vector<HeldJoint>& three) {
  std::array<Complex, kSamples> samples;
  for (int n = 0; n < kSamples; ++n)
    samples[static_cast<size_t>(n)] = Resultant(three, std::polar(1.0, 2 * std::numbers::pi * n / kSamples));
  Eigen::VectorXcd coefficients = Eigen::VectorXcd::Zero(2 * kHighestPower + 1);
  for (int power = -kHighestPower; power <= kHighestPower; ++power)
    for (int n = 0; n < kSamples; ++n)
      coefficients[power + kHighestPower] +=
          samples[static_cast<size_t>(n)] *
          std::polar(1.0 / kSamples, -2 * std::numbers::pi * n * power / kSamples);
  const double least = kLeastCoefficient * coefficients.cwiseAbs().maxCoeff();
  Eigen::Index first = 0, last = coefficients.size() - 1;
  while (first < last && std::abs(coefficients[first]) <= least) ++first;
  while (last > first && std::abs(coefficients[last]) <= least) --last;
  return coefficients.segment(first, last - first + 1);
}

// C as forms of (1, x, y, cos, sin), less the space's point.
std::vector<AffineForm> FromPoint(const HeldJoint& joint) {
  const double bx = joint.turned_m.x(), by = joint.turned_m.y();
  AffineForm x = UnknownForm(kUnknowns, 0), y = UnknownForm(kUnknowns, 1);
  x[0] -= RealBall(joint.space.point_m.x());
  y[0] -= RealBall(joint.space.point_m.y());
  x[3] = RealBall(bx);
  x[4] = RealBall(-by);
  y[3] = RealBall(by);
  y[4] = RealBall(bx);
  return {x, y};
}

ComplexBallMatrix OnSpace(const HeldJoint& joint) {
  const std::vector<AffineForm> c = FromPoint(joint);
  const VertexSpace& space = joint.space;
  if (space.is_circle) return SumOfSquares(c, RealBall(space.radius_m) * RealBall(space.radius_m));
  return AsQuadric(c[1] * RealBall(space.along.x()) - c[0] * RealBall(space.along.y()));
}

QuadricSystem SystemOf(const std::vector<HeldJoint>& three) {
  return QuadricSystem({SumOfSquares({UnknownForm(kUnknowns, 2), UnknownForm(kUnknowns, 3)}, RealBall(1.0)),
                        OnSpace(three[0]), OnSpace(three[1]), OnSpace(three[2])});
}

Eigen::VectorXcd UnknownsAt(const std::vector<HeldJoint>& three, const Complex& e) {
  const LinearPart part = LinearPartAt(three, e);
  const Complex2 k0 = three[0].space.point_m.head<2>().cast<Complex>() - Turned(three[0], e);
  const Complex2 p = k0 + part.matrix.fullPivLu().solve(part.right);
  return (Eigen::VectorXcd(kUnknowns) << p[0], p[1], (e + 1.0 / e) / 2.0, (e - 1.0 / e) / Complex(0, 2))
      .finished();
}

// A circle meets the sextic coupler curve of two circles in six points besides the circular ones, a line the
// sextic in six, a circle the ellipse of two lines in four, a line it in two.
int MostPossible(const std::vector<HeldJoint>& three) {
  const auto circles =
      std::count_if(three.begin(), three.end(), [](const auto& j) { return j.space.is_circle; });
  return std::array{2, 4, 6, 6}[static_cast<size_t>(circles)];
}

}  // namespace

ModeCandidates PlanarCandidates(const std::vector<HeldJoint>& three, const Rigid3& home) {
  std::vector<HeldJoint> held = three;
  for (HeldJoint& joint : held) {
    joint.space.point_m -= joint.carried_m;
    joint.carried_m.setZero();
  }
  std::stable_partition(held.begin(), held.end(),
                        [](const HeldJoint& joint) { return joint.space.is_circle; });
  ModeCandidates candidates;
  candidates.most_possible = MostPossible(held);
  std::vector<Eigen::VectorXcd> approximations;
  for (const Complex& e : RootsOf(ResultantCoefficients(held))) approximations.push_back(UnknownsAt(held, e));
  const CertifiedRoots roots = CertifyRoots(SystemOf(held), approximations);
  for (const CertifiedRoot& root : roots.roots)
    if (root.is_real)
      candidates.poses.push_back(
          {RotationFromVector({0, 0, std::atan2(root.midpoint[3].real(), root.midpoint[2].real())}),
           {root.midpoint[0].real(), root.midpoint[1].real(), home.translation.z()}});
  const int missing = candidates.most_possible - static_cast<int>(roots.roots.size());
  candidates.is_complete = missing == 0;
  if (missing > 0) candidates.why = WhyNotAllRoots(missing, candidates.most_possible);
  return candidates;
}

}  // namespace legible
