#include "tests/core/hidden/exact_pose_count.h"

#include <Eigen/Geometry>
#include <array>
#include <stdexcept>

#include "core/robots/leg_state.h"

namespace legible {
namespace {

using Vector2q = Eigen::Matrix<Rational, 2, 1>;
using Vector3q = Eigen::Matrix<Rational, 3, 1>;
using Row4q = std::array<Rational, 4>;

// Where a platform joint can be: point + s first, or point + cos first + sin second.
struct ExactLeg {
  bool is_on_circle = false;
  Vector3q point, first, second;
  Rational radius;
  Vector3q turned, carried;  // the platform joint in platform, and the rest of it in base
};

ExactLeg ExactLegOf(const RobotLeg& leg, const Rigid3& pose) {
  const Vector3q direction = StateOf(leg, pose).value().direction.cast<Rational>();
  const Vector3q axis = leg.first_axis.cast<Rational>(), zero = leg.zero_direction.cast<Rational>();
  const Carrier carrier = SeenSegmentOf(leg.chain).carrier;
  ExactLeg exact;
  exact.turned = leg.platform_joint_m.cast<Rational>();
  exact.carried = leg.carried_offset_m.cast<Rational>();
  exact.is_on_circle = carrier == Carrier::kCircle;
  exact.point = leg.base_joint_m.cast<Rational>();
  if (carrier != Carrier::kFixed) exact.point += Rational(leg.rod_m) * direction;
  exact.first = carrier == Carrier::kLine ? axis : direction;
  if (!exact.is_on_circle) return exact;
  exact.radius = leg.arm_m;
  exact.first = exact.radius * zero;
  exact.second = exact.radius * axis.cross(zero);
  return exact;
}

// C(t) on a circle, t the tangent of half the angle.
Vector3q OnCircle(const ExactLeg& leg, const Rational& t) {
  const Rational scale = Rational(1) + t * t;
  const Rational cosine = (Rational(1) - t * t) / scale, sine = Rational(2) * t / scale;
  return leg.point + cosine * leg.first + sine * leg.second;
}

Rational Power(const Rational& x, int exponent) {
  Rational power(1);
  for (int i = 0; i < exponent; ++i) power *= x;
  return power;
}

Rational Determinant(const std::array<Row4q, 3>& rows, const std::array<size_t, 3>& columns) {
  const auto at = [&](size_t i, size_t j) -> const Rational& { return rows[i][columns[j]]; };
  return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
         at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
         at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
}

// |p - k|^2 = r^2 or n (p - k) = 0 as linear in (|p|^2, x, y, 1).
Row4q PlanarRow(const ExactLeg& leg, const Vector2q& k) {
  if (leg.is_on_circle)
    return {1, Rational(-2) * k[0], Rational(-2) * k[1], k.dot(k) - leg.radius * leg.radius};
  const Vector2q n(-leg.first[1], leg.first[0]);
  return {0, n[0], n[1], -n.dot(k)};
}

Vector2q TurnedInPlane(const ExactLeg& leg, const Rational& t) {
  const Rational scale = Rational(1) + t * t;
  const Rational c = (Rational(1) - t * t) / scale, s = Rational(2) * t / scale;
  return {c * leg.turned[0] - s * leg.turned[1], s * leg.turned[0] + c * leg.turned[1]};
}

// Three rows leave one (|p|^2, x, y, 1), whose first has to be what it is called. Of three lines the rows
// without the first column have to be dependent.
RationalPolynomial PlanarPolynomial(const std::vector<ExactLeg>& legs) {
  const bool are_lines = !legs[0].is_on_circle && !legs[1].is_on_circle && !legs[2].is_on_circle;
  const int degree = are_lines ? 1 : 5;
  const auto value = [&](const Rational& t) {
    std::array<Row4q, 3> rows;
    for (size_t i = 0; i < 3; ++i)
      rows[i] = PlanarRow(legs[i], (legs[i].point - legs[i].carried).head<2>() - TurnedInPlane(legs[i], t));
    const Rational v0 = Determinant(rows, {1, 2, 3}), v1 = Determinant(rows, {0, 2, 3}),
                   v2 = Determinant(rows, {0, 1, 3}), v3 = Determinant(rows, {0, 1, 2});
    // The null vector is (v0, -v1, v2, -v3).
    const Rational condition = are_lines ? v0 : v0 * v3 + v1 * v1 + v2 * v2;
    return condition * Power(Rational(1) + t * t, degree);
  };
  return WithoutCircularPoints(Interpolated(value, 2 * degree));
}

// In y at a given x.
RationalPolynomial PointOnSpace(const ExactLeg& leg, const Vector2q& k, const Rational& x) {
  const Row4q row = PlanarRow(leg, k);
  RationalPolynomial polynomial = {row[0] * x * x + row[1] * x + row[3], row[2]};
  if (leg.is_on_circle) polynomial.push_back(row[0]);
  return polynomial;
}

RationalPolynomial PlanarPointPolynomial(const std::vector<ExactLeg>& legs, const Rigid3& home) {
  const Eigen::Matrix<Rational, 3, 3> rotation = home.rotation.toRotationMatrix().cast<Rational>();
  const auto value = [&](const Rational& x) {
    std::array<RationalPolynomial, 2> in_y;
    for (size_t i = 0; i < 2; ++i) {
      const Vector3q k = legs[i].point - legs[i].carried - rotation * legs[i].turned;
      in_y[i] = PointOnSpace(legs[i], k.head<2>(), x);
    }
    return Resultant(in_y[0], in_y[1]);
  };
  return Interpolated(value, 4);
}

// |a + s d|^2 - distance^2 in s.
RationalPolynomial AtDistance(const Eigen::Matrix<Rational, Eigen::Dynamic, 1>& a,
                              const Eigen::Matrix<Rational, Eigen::Dynamic, 1>& d,
                              const Rational& distance2) {
  return {a.dot(a) - distance2, Rational(2) * a.dot(d), d.dot(d)};
}

Rational SquaredDistance(const ExactLeg& a, const ExactLeg& b) {
  return (a.turned - b.turned).dot(a.turned - b.turned);
}

// Given how far C_1 is along its line, those of C_2 and C_3 solve a quadratic equation each, and both one
// more.
RationalPolynomial SpatialPolynomial(const std::vector<ExactLeg>& legs) {
  const auto value = [&](const Rational& s1) {
    const Vector3q c1 = legs[0].point + s1 * legs[0].first;
    const auto from_first = [&](size_t i) {
      return AtDistance(legs[i].point - c1, legs[i].first, SquaredDistance(legs[0], legs[i]));
    };
    const auto of_second = [&](const Rational& s2) {
      const Vector3q c2 = legs[1].point + s2 * legs[1].first;
      return Resultant(from_first(2),
                       AtDistance(legs[2].point - c2, legs[2].first, SquaredDistance(legs[1], legs[2])));
    };
    return Resultant(from_first(1), Interpolated(of_second, 4));
  };
  return Interpolated(value, 8);
}

// |C_b - C_a|^2 less its value times 1 + t_b^2, in t_b, C_a given: both circles have their radius exactly.
RationalPolynomial CirclesAtDistance(const ExactLeg& a, const Rational& t_a, const ExactLeg& b) {
  const Vector3q side = OnCircle(a, t_a) - a.point, apart = b.point - a.point, from = apart - side;
  const Rational constant = apart.dot(apart) - Rational(2) * apart.dot(side) + a.radius * a.radius +
                            b.radius * b.radius - SquaredDistance(a, b);
  const Rational cosine = Rational(2) * from.dot(b.first), sine = Rational(2) * from.dot(b.second);
  return {constant + cosine, Rational(2) * sine, constant - cosine};
}

// As on lines, by tangents of half the angles.
RationalPolynomial SpatialCirclePolynomial(const std::vector<ExactLeg>& legs) {
  const auto value = [&](const Rational& t1) {
    const auto of_second = [&](const Rational& t2) {
      return Resultant(CirclesAtDistance(legs[0], t1, legs[2]), CirclesAtDistance(legs[1], t2, legs[2])) *
             Power(Rational(1) + t2 * t2, 2);
    };
    return Resultant(CirclesAtDistance(legs[0], t1, legs[1]), Interpolated(of_second, 4)) *
           Power(Rational(1) + t1 * t1, 8);
  };
  return Interpolated(value, 16);
}

// What C_2 - C_1 has to be less what does not turn: C_1 at its place, C_2 yet to go from its point.
Vector3q FromSecondPoint(const std::vector<ExactLeg>& legs, const Vector3q& c1) {
  Vector3q d = c1 - legs[0].carried - legs[1].point + legs[1].carried;
  d[2] -= legs[0].turned[2] - legs[1].turned[2];
  return d;
}

Rational HorizontalDistance2(const std::vector<ExactLeg>& legs) {
  const Vector2q d = (legs[0].turned - legs[1].turned).head<2>();
  return d.dot(d);
}

// With t of C_2 on its circle: at the height d_z, and horizontally at the distance from d.
Rational SchoenfliesCircleCondition(const std::vector<ExactLeg>& legs, const Vector3q& c1) {
  const Vector3q& a = legs[1].first;
  const Vector3q& b = legs[1].second;
  const Vector3q d = FromSecondPoint(legs, c1);
  const RationalPolynomial height = {d[2] - a[2], Rational(-2) * b[2], d[2] + a[2]};
  const std::array<Vector2q, 3> v = {(d - a).head<2>(), Rational(-2) * b.head<2>(), (d + a).head<2>()};
  RationalPolynomial distance(5);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) distance[i + j] += v[i].dot(v[j]);
  const Rational arm2 = HorizontalDistance2(legs);
  distance[0] -= arm2;
  distance[2] -= Rational(2) * arm2;
  distance[4] -= arm2;
  return Resultant(height, distance);
}

RationalPolynomial SchoenfliesCirclePolynomial(const std::vector<ExactLeg>& legs) {
  const auto value = [&](const Rational& t1) {
    return SchoenfliesCircleCondition(legs, OnCircle(legs[0], t1)) * Power(Rational(1) + t1 * t1, 8);
  };
  return WithoutCircularPoints(Interpolated(value, 16));
}

RationalPolynomial SchoenfliesMixedPolynomial(const std::vector<ExactLeg>& legs) {
  const std::vector<ExactLeg> line_first =
      legs[0].is_on_circle ? std::vector<ExactLeg>{legs[1], legs[0]} : legs;
  const auto value = [&](const Rational& s1) {
    return SchoenfliesCircleCondition(line_first, line_first[0].point + s1 * line_first[0].first);
  };
  return Interpolated(value, 8);
}

RationalPolynomial SchoenfliesLinePolynomial(const std::vector<ExactLeg>& legs) {
  const Vector3q& a = legs[1].first;
  const auto value = [&](const Rational& s1) {
    const Vector3q d = FromSecondPoint(legs, legs[0].point + s1 * legs[0].first);
    const Vector2q d_in_plane = d.head<2>(), a_in_plane = -a.head<2>();
    return Resultant({d[2], -a[2]}, AtDistance(d_in_plane, a_in_plane, HorizontalDistance2(legs)));
  };
  return Interpolated(value, 2);
}

RationalPolynomial PolynomialOf(const ParallelRobot& robot, const std::vector<ExactLeg>& legs) {
  switch (robot.motion) {
    case PlatformMotion::kPlanarPoint:
      return PlanarPointPolynomial(legs, robot.home);
    case PlatformMotion::kPlanar:
      return PlanarPolynomial(legs);
    case PlatformMotion::kSchoenflies:
      if (legs[0].is_on_circle != legs[1].is_on_circle) return SchoenfliesMixedPolynomial(legs);
      return legs[0].is_on_circle ? SchoenfliesCirclePolynomial(legs) : SchoenfliesLinePolynomial(legs);
    case PlatformMotion::kSpatial:
      return legs[0].is_on_circle ? SpatialCirclePolynomial(legs) : SpatialPolynomial(legs);
    case PlatformMotion::kTranslation:
      break;
  }
  throw std::logic_error("two directions over-determine a translation");
}

}  // namespace

std::optional<RealRoots> ExactPoseCount(const ParallelRobot& robot, const std::vector<int>& legs,
                                        const Rigid3& pose) {
  std::vector<ExactLeg> exact;
  exact.reserve(legs.size());
  for (const int leg : legs) exact.push_back(ExactLegOf(robot.legs[static_cast<size_t>(leg)], pose));
  return RealRootsOf(PolynomialOf(robot, exact));
}

}  // namespace legible
