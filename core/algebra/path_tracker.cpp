#include "core/algebra/path_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace legible {
namespace {

constexpr int kMaxNewtonSteps = 4;
constexpr double kNewtonTolerance = 1e-8;  // of points of length 1; the error left is about its square
constexpr double kFirstStep = 0.02, kLargestStep = 0.2;

// A step this short means a singular point. One at the end is approached as the square root of what is left,
// or a higher one: there is nothing to be gained from coming nearer.
constexpr double kShortestStep = 1e-8;

}  // namespace

template <int N>
PathTracker<N>::PathTracker(const HomogeneousQuadrics<N>& start, const HomogeneousQuadrics<N>& end) {
  for (int k = 0; k < N - 1; ++k) {
    const auto quadric = static_cast<size_t>(k);
    start_.template middleRows<N>(N * k) = start[quadric];
    change_.template middleRows<N>(N * k) = end[quadric] - start[quadric];
  }
}

template <int N>
typename PathTracker<N>::Linearisation PathTracker<N>::At(const Point& v, double s,
                                                          const Point& patch) const {
  using PerQuadric = Eigen::Matrix<std::complex<double>, N, N - 1>;  // Q_k v in column k
  const Eigen::Matrix<std::complex<double>, N*(N - 1), 1> of_start = start_ * v, of_change = change_ * v;
  const Eigen::Map<const PerQuadric> start(of_start.data()), change(of_change.data());
  const PerQuadric product = start + s * change;
  Linearisation at;
  at.jacobian.template topRows<N - 1>() = 2 * product.transpose();
  at.jacobian.row(N - 1) = patch.adjoint();
  at.values << product.transpose() * v, 0;
  at.by_s << change.transpose() * v, 0;
  return at;
}

template <int N>
typename PathTracker<N>::Point PathTracker<N>::Tangent(const Point& v, double s, const Point& patch) const {
  const Linearisation at = At(v, s, patch);
  return at.jacobian.partialPivLu().solve(-at.by_s);
}

template <int N>
typename PathTracker<N>::Point PathTracker<N>::Predicted(const Point& v, double s, double step) const {
  const Point k1 = Tangent(v, s, v);
  const Point k2 = Tangent(v + 0.5 * step * k1, s + 0.5 * step, v);
  const Point k3 = Tangent(v + 0.5 * step * k2, s + 0.5 * step, v);
  const Point k4 = Tangent(v + step * k3, s + step, v);
  return v + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

template <int N>
bool PathTracker<N>::Correct(Point& v, double s, const Point& patch) const {
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const Linearisation at = At(v, s, patch);
    const Point correction = at.jacobian.partialPivLu().solve(at.values);
    v -= correction;
    if (correction.norm() <= kNewtonTolerance * v.norm()) return true;
  }
  return false;
}

template <int N>
PathEnd<N> PathTracker<N>::Track(const Point& solution_of_start, double tolerance) const {
  PathEnd<N> now{solution_of_start.normalized(), 0};
  double step = kFirstStep;
  while (now.s < 1) {
    const double next_s = std::min(1.0, now.s + step);
    const Point predicted = Predicted(now.point, now.s, next_s - now.s);
    Point corrected = predicted;
    const bool converged = Correct(corrected, next_s, now.point);
    const double error = (corrected - predicted).norm() / corrected.norm();
    if (converged && error <= tolerance) {
      now = {corrected.normalized(), next_s};
    } else if (step <= kShortestStep) {
      break;
    }
    // The error of a step is of its fifth power.
    const double factor = converged ? 0.8 * std::pow(tolerance / error, 0.2) : 0.25;
    step = std::min(kLargestStep, step * std::clamp(factor, 0.2, 3.0));
  }
  return now;
}

template class PathTracker<4>;
template class PathTracker<7>;
template class PathTracker<8>;

}  // namespace legible
