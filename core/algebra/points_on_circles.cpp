#include "core/algebra/points_on_circles.h"

#include <cmath>
#include <complex>
#include <random>
#include <utility>

#include "core/algebra/path_tracker.h"

namespace legible {
namespace {

using Complex = std::complex<double>;
using Point = PathTracker<7>::Point;  // (1, cos, sin, cos, sin, cos, sin), homogeneous

constexpr double kTolerance = 1e-4, kTightTolerance = 1e-6;
constexpr unsigned kSeed = 1;  // of the start

// Where the cosine and the sine of a point are among the unknowns after the 1.
std::array<Eigen::Index, 3> PlacesOf(size_t point) {
  const auto at = static_cast<Eigen::Index>(1 + 2 * (point % 3));
  return {0, at, at + 1};
}

// The three circles and the three conditions as symmetric matrices of (1, cos, sin, ...).
template <typename Scalar>
std::array<Eigen::Matrix<Scalar, 7, 7>, 6> QuadricsOf(
    const std::array<Eigen::Matrix<Scalar, 3, 3>, 3>& conditions) {
  std::array<Eigen::Matrix<Scalar, 7, 7>, 6> quadrics;
  for (size_t k = 0; k < 3; ++k) {
    const auto first = PlacesOf(k), second = PlacesOf(k + 1);
    Eigen::Matrix<Scalar, 7, 7>& circle = quadrics[k];
    circle.setZero();
    circle(0, 0) = Scalar(-1.0);
    circle(first[1], first[1]) = circle(first[2], first[2]) = Scalar(1.0);
    Eigen::Matrix<Scalar, 7, 7>& condition = quadrics[k + 3];
    condition.setZero();
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        const Scalar half =
            conditions[k](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * Scalar(0.5);
        condition(first[i], second[j]) += half;
        condition(second[j], first[i]) += half;
      }
  }
  return quadrics;
}

struct Start {
  HomogeneousQuadrics<7> quadrics;
  std::vector<Point> solutions;
};

// (cos, sin) with factor . (1, cos, sin) = 0.
std::array<Eigen::Vector2cd, 2> PointsOn(const Eigen::Vector3cd& factor) {
  const Complex square = factor[1] * factor[1] + factor[2] * factor[2];
  const Complex root = std::sqrt(square - factor[0] * factor[0]);
  const Eigen::Vector2cd middle = -factor[0] / square * factor.tail<2>();
  const Eigen::Vector2cd side = root / square * Eigen::Vector2cd(-factor[2], factor[1]);
  return {middle + side, middle - side};
}

// A root has one factor of each condition zero, and each point on one of them: either on the factors `first`,
// of the conditions that begin with the points, or on the others.
Start MakeStart() {
  std::mt19937_64 generator(kSeed);
  std::normal_distribution<double> normal;
  const auto random_factor = [&] {
    Eigen::Vector3cd factor;
    for (Complex& value : factor) {
      const double real = normal(generator);
      value = Complex(real, normal(generator));
    }
    return factor;
  };
  std::array<Eigen::Vector3cd, 3> first, second;
  std::array<Eigen::Matrix3cd, 3> conditions;
  for (size_t k = 0; k < 3; ++k) {
    first[k] = random_factor();
    second[(k + 1) % 3] = random_factor();
    conditions[k] = first[k] * second[(k + 1) % 3].transpose();
  }
  Start start{QuadricsOf<Complex>(conditions), {}};
  for (const auto& factors : {first, second})
    for (int choice = 0; choice < 8; ++choice) {
      Point point;
      point[0] = 1;
      for (size_t k = 0; k < 3; ++k)
        point.segment<2>(PlacesOf(k)[1]) = PointsOn(factors[k])[static_cast<size_t>(choice >> k & 1)];
      start.solutions.push_back(point);
    }
  return start;
}

HomogeneousQuadrics<7> MidpointsOf(const std::array<Eigen::Matrix<RealBall, 7, 7>, 6>& quadrics) {
  HomogeneousQuadrics<7> midpoints;
  for (size_t k = 0; k < quadrics.size(); ++k)
    midpoints[k] = quadrics[k].unaryExpr([](const RealBall& ball) { return MidpointOf(ball); });
  return midpoints;
}

// Each condition by its largest coefficient, which changes no root.
CircleConditions Scaled(CircleConditions conditions) {
  for (auto& condition : conditions) {
    double largest = 0;
    for (const RealBall& value : condition.reshaped())
      largest = std::max(largest, std::abs(MidpointOf(value)));
    if (largest > 0) condition /= RealBall(largest);
  }
  return conditions;
}

CertifiedRoots EndsOfPaths(const Start& start, const HomogeneousQuadrics<7>& end, const QuadricSystem& system,
                           double tolerance) {
  const PathTracker<7> tracker(start.quadrics, end);
  std::vector<Eigen::VectorXcd> approximations;
  for (const Point& solution : start.solutions) {
    const Point point = tracker.Track(solution, tolerance).point;
    approximations.emplace_back(point.tail<6>() / point[0]);
  }
  return CertifyRoots(system, approximations);
}

}  // namespace

PointsOnCirclesRoots AllRoots(const CircleConditions& conditions) {
  static const Start start = MakeStart();
  const auto quadrics = QuadricsOf<RealBall>(Scaled(conditions));
  std::vector<ComplexBallMatrix> matrices;
  matrices.reserve(quadrics.size());
  for (const auto& quadric : quadrics) matrices.emplace_back(quadric.cast<ComplexBall>());
  const QuadricSystem system(std::move(matrices));
  PointsOnCirclesRoots result;
  for (const double tolerance : {kTolerance, kTightTolerance}) {
    result.roots = EndsOfPaths(start, MidpointsOf(quadrics), system, tolerance).roots;
    result.is_complete = result.roots.size() == kPointsOnCirclesRootCount;
    if (result.is_complete) break;
  }
  result.missing = kPointsOnCirclesRootCount - static_cast<int>(result.roots.size());
  return result;
}

}  // namespace legible
