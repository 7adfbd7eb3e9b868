// Follows the solutions of homogeneous quadrics while their coefficients change.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>

namespace legible {

// N - 1 homogeneous quadrics v^T Q_k v = 0 in N unknowns, Q_k symmetric: in general they have points in
// common in projective space, of which v stands for one as every multiple of it does.
template <int N>
using HomogeneousQuadrics = std::array<Eigen::Matrix<std::complex<double>, N, N>, N - 1>;

template <int N>
struct PathEnd {
  Eigen::Matrix<std::complex<double>, N, 1> point;  // of length 1
  double s = 0;                                     // 1 where the path was followed to its end
};

// The straight line of systems (1 - s) start + s end, s from 0 to 1. Where the start is general and complex,
// no two paths meet and none turns back before s = 1, and every isolated solution at the end is where a path
// leads (A. Sommese and C. Wampler, The numerical solution of systems of polynomials, 2005, chapters 2 and
// 7). Runge-Kutta's fourth order predicts, Newton's method corrects; both take the point's present direction
// as the patch of projective space that they work in. In doubles, proving nothing.
template <int N>
class PathTracker {
 public:
  using Point = Eigen::Matrix<std::complex<double>, N, 1>;

  PathTracker(const HomogeneousQuadrics<N>& start, const HomogeneousQuadrics<N>& end);

  // From a solution of the start. The step is such that no prediction is off by more than the tolerance; the
  // smaller that is, the less does the tracker stray onto a neighbouring path.
  PathEnd<N> Track(const Point& solution_of_start, double tolerance) const;

 private:
  // The quadrics one below the other.
  using Stacked = Eigen::Matrix<std::complex<double>, N*(N - 1), N>;
  using Square = Eigen::Matrix<std::complex<double>, N, N>;

  struct Linearisation {
    Square jacobian;                                         // the last row is the patch
    Eigen::Matrix<std::complex<double>, N, 1> values, by_s;  // the last is 0
  };

  Linearisation At(const Point& v, double s, const Point& patch) const;
  Point Tangent(const Point& v, double s, const Point& patch) const;  // dv / ds
  Point Predicted(const Point& v, double s, double step) const;
  // Newton's method at a fixed s, within the patch; false where it does not converge.
  bool Correct(Point& v, double s, const Point& patch) const;

  Stacked start_, change_;  // end - start
};

extern template class PathTracker<4>;  // three quadrics in space
extern template class PathTracker<7>;  // three points on circles
extern template class PathTracker<8>;  // rigid motions in Study coordinates

}  // namespace legible
