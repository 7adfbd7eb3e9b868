#include "core/hidden/path_enclosure.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace legible {
namespace {

// By which a box is larger than a Newton step from its middle at first, and from one trial to the next.
constexpr double kInflation = 1.5;
constexpr int kMostTrials = 4;
// Least half width of a box, m: rounding of the doubles in its middle.
constexpr double kLeastRadius_m = 1e-13;
// How far the ends may be off what RPS legs allow.
constexpr double kAtEnd_m = 1e-8;

// More than all roundings of a sum or product of a few doubles.
constexpr double kUpward = 1 + 1e-12;
// |A| of the rates' equation, at most.
constexpr double kLargestOff = 0.9;

// c is within `radius` of the centre, the ball's every number.
bool IsInside(const RealBallVector& c, const Eigen::VectorXd& centre, const Eigen::VectorXd& radius) {
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const RealBall off = c[i] - RealBall(centre[i]);
    if (!(LowerBound(off) > -radius[i] && UpperBound(off) < radius[i])) return false;
  }
  return true;
}

// For every s in the ball exactly one root lies within `radius` of `centre`, and in `roots`.
struct RootBox {
  Eigen::VectorXd centre, radius;
  RealBallVector roots;
};

RealBallVector BallsAbout(const Eigen::VectorXd& centre, const Eigen::VectorXd& radius) {
  RealBallVector balls(centre.size());
  for (Eigen::Index i = 0; i < centre.size(); ++i) balls[i] = RealBall(centre[i], radius[i]);
  return balls;
}

// Krawczyk's test: with X the box, m its centre, and Y about the inverse of dd/dc there,
//   m - Y d(m) + (I - Y dd/dc(X)) (X - m)
// lies in X's interior.
std::optional<RootBox> ProvedRoot(const StraightPath& path, const RealBall& s, const Eigen::VectorXd& guess) {
  const double middle = MidpointOf(s);
  const auto centre = path.CorrectionAt(middle, guess);
  if (!centre || centre->size() == 0) return centre ? std::optional(RootBox{*centre, {}, {}}) : std::nullopt;
  const Eigen::Index n = centre->size();
  const auto at_middle = path.PoseAt<double>(middle, *centre);
  const Eigen::MatrixXd inverse =
      path.DistancesByCorrection<double>(*centre, path.SidewaysLines(at_middle)).inverse();
  if (!inverse.allFinite()) return std::nullopt;
  const RealBallMatrix y = inverse.cast<RealBall>();
  const RealBallVector step = y * path.Distances_m(path.PoseAt<RealBall>(s, centre->cast<RealBall>()));
  Eigen::VectorXd radius(n);
  for (Eigen::Index i = 0; i < n; ++i)
    radius[i] = kLeastRadius_m + kInflation * std::max(-LowerBound(step[i]), UpperBound(step[i]));
  for (int trial = 0; trial < kMostTrials; ++trial, radius *= kInflation) {
    const RealBallVector box = BallsAbout(*centre, radius);
    const auto lines = path.SidewaysLines(path.PoseAt<RealBall>(s, box));
    const RealBallMatrix off =
        RealBallMatrix::Identity(n, n) - y * path.DistancesByCorrection<RealBall>(box, lines);
    const RealBallVector roots =
        centre->cast<RealBall>() - step + off * BallsAbout(Eigen::VectorXd::Zero(n), radius);
    if (IsInside(roots, *centre, radius)) return RootBox{*centre, radius, roots};
  }
  return std::nullopt;
}

Eigen::VectorXd MiddleOf(const RealBallVector& balls) {
  return balls.unaryExpr([](const RealBall& x) { return MidpointOf(x); });
}

// The largest of each ball.
Eigen::MatrixXd Moduli(const RealBallMatrix& balls) {
  return balls.unaryExpr([](const RealBall& x) { return LargestModulus(x); });
}

StraightPath::Vector<RealBallJet> JetsOf(const RealBallVector& values, const RealBallVector& rates) {
  StraightPath::Vector<RealBallJet> jets(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) jets[i] = {values[i], rates[i]};
  return jets;
}

// c' on a piece, of G c' = -dd/ds with G = dd/dc: with A = I - Y G, Y about the inverse of G's middle,
//   c' = -Y dd/ds + A c'        |c'| <= |Y dd/ds| / (1 - |A|), row sum norms.
// Nothing where |A| may be 1.
std::optional<RealBallVector> CorrectionRates(const StraightPath& path, const RealBall& s,
                                              const RealBallVector& c) {
  const Eigen::Index n = c.size();
  if (n == 0) return RealBallVector(0);
  const auto of_s = path.Distances_m(path.PoseAt<RealBallJet>({s, 1.0}, JetsOf(c, RealBallVector::Zero(n))));
  const RealBallVector by_s = of_s.unaryExpr([](const RealBallJet& jet) { return jet.rate(); });
  const RealBallMatrix by_c =
      path.DistancesByCorrection<RealBall>(c, path.SidewaysLines(path.PoseAt<RealBall>(s, c)));
  const Eigen::MatrixXd inverse =
      Eigen::MatrixXd(by_c.unaryExpr([](const RealBall& x) { return MidpointOf(x); })).inverse();
  if (!inverse.allFinite()) return std::nullopt;
  const RealBallMatrix y = inverse.cast<RealBall>();
  const Eigen::MatrixXd off = Moduli(RealBallMatrix::Identity(n, n) - y * by_c);
  const RealBallVector first = -(y * by_s);
  const Eigen::VectorXd row_sums = kUpward * off.rowwise().sum();
  if (!(row_sums.maxCoeff() < kLargestOff)) return std::nullopt;
  const double largest = kUpward * Moduli(first).maxCoeff() / (1 - row_sums.maxCoeff());
  return RealBallVector(first + BallsAbout(Eigen::VectorXd::Zero(n), kUpward * largest * row_sums));
}

}  // namespace

bool IsAtEnd(const RealBallVector& correction) {
  const Eigen::Index n = correction.size();
  return IsInside(correction, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, kAtEnd_m));
}

std::optional<RealBallVector> CorrectionAtEnd(const StraightPath& path, double s) {
  const auto end = ProvedRoot(path, RealBall(s), Eigen::VectorXd::Zero(path.corrections()));
  if (!end || !IsAtEnd(end->roots)) return std::nullopt;
  return end->roots;
}

std::optional<PathPiece> EnclosePiece(const StraightPath& path, double begin,
                                      const RealBallVector& begin_correction, double end) {
  const RealBall s = Hull(begin, end);
  const double middle = MidpointOf(s);
  const auto whole = ProvedRoot(path, s, MiddleOf(begin_correction));
  if (!whole || !IsInside(begin_correction, whole->centre, whole->radius)) return std::nullopt;
  const auto root_at = [&](double at) -> std::optional<RealBallVector> {
    const auto root = ProvedRoot(path, RealBall(at), whole->centre);
    if (!root || !IsInside(root->roots, whole->centre, whole->radius)) return std::nullopt;
    return root->roots;
  };
  const auto at_middle = root_at(middle), at_end = root_at(end);
  const auto rates = CorrectionRates(path, s, whole->roots);
  if (!at_middle || !at_end || !rates) return std::nullopt;
  return PathPiece{path.PoseAt<RealBallJet>({s, 1.0}, JetsOf(whole->roots, *rates)),
                   path.PoseAt<RealBall>(middle, *at_middle), RadiusOf(s), *at_end};
}

}  // namespace legible
