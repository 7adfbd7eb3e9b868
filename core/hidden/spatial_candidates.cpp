#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/algebra/points_on_circles.h"
#include "core/algebra/three_quadrics.h"
#include "core/hidden/affine_forms.h"
#include "core/hidden/mode_candidates.h"

namespace legible {
namespace {

// Twice a triangle's area, of two sides' squares: three joints are on one line, but for rounding, and so
// nearly that rounding turns the platform by more than candidates may be off.
constexpr double kOnOneLine = 1e-12;
constexpr double kNearlyOnOneLine = 1e-5;

// C on its line by how far along it is, which is the unknown of that index.
std::array<AffineForm, 3> OnLine(const VertexSpace& space, int unknown) {
  std::array<AffineForm, 3> forms;
  for (Eigen::Index k = 0; k < 3; ++k) {
    AffineForm form = ConstantForm(3, space.point_m[k]);
    form[unknown + 1] = RealBall(space.along[k]);
    forms[static_cast<size_t>(k)] = form;
  }
  return forms;
}

// |C_i - C_j|^2 = |B_i - B_j|^2, Briot et al. (2016), section 4.2.1: the spatial Cardanic motion.
ComplexBallMatrix DistanceQuadric(const HeldJoint& first, const HeldJoint& second,
                                  const std::array<AffineForm, 3>& c_first,
                                  const std::array<AffineForm, 3>& c_second) {
  std::vector<AffineForm> difference;
  RealBall distance_m2(0.0);
  for (size_t k = 0; k < 3; ++k) {
    difference.emplace_back(c_first[k] - c_second[k]);
    const auto at = static_cast<Eigen::Index>(k);
    const RealBall side = RealBall(first.turned_m[at]) - RealBall(second.turned_m[at]);
    distance_m2 += side * side;
  }
  return SumOfSquares(difference, distance_m2);
}

// The radius, in balls of unit vectors, within which doubles have some that are unit and across each other
// exactly.
constexpr double kUnitVectorRounding = 1e-15;

// (C_i - C_j)^2 = (B_i - B_j)^2 for C = point + r (cos a + sin b), a and b unit and across each other:
// bilinear in (1, cos, sin) of the one and of the other.
Eigen::Matrix<RealBall, 3, 3> DistanceOnCircles(const HeldJoint& first, const HeldJoint& second) {
  using Vector = Eigen::Matrix<RealBall, 3, 1>;
  const auto radii = [](const VertexSpace& circle) {
    const auto ball = [&](double x) { return RealBall(x, kUnitVectorRounding) * RealBall(circle.radius_m); };
    return std::array<Vector, 2>{circle.along.unaryExpr(ball), circle.second_radius.unaryExpr(ball)};
  };
  const auto first_radii = radii(first.space), second_radii = radii(second.space);
  const RealBall two(2.0), r1(first.space.radius_m), r2(second.space.radius_m);
  const Vector apart = first.space.point_m.cast<RealBall>() - second.space.point_m.cast<RealBall>();
  const Vector side = first.turned_m.cast<RealBall>() - second.turned_m.cast<RealBall>();
  Eigen::Matrix<RealBall, 3, 3> condition;
  condition(0, 0) = apart.dot(apart) + r1 * r1 + r2 * r2 - side.dot(side);
  for (size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Eigen::Index>(i + 1);
    condition(row, 0) = two * apart.dot(first_radii[i]);
    condition(0, row) = -(two * apart.dot(second_radii[i]));
    for (size_t j = 0; j < 2; ++j)
      condition(row, static_cast<Eigen::Index>(j + 1)) = -(two * first_radii[i].dot(second_radii[j]));
  }
  return condition;
}

// Whether the joints' triangle is that flat.
bool AreOnOneLine(const std::vector<HeldJoint>& three, double flatness) {
  const Eigen::Vector3d a = three[1].turned_m - three[0].turned_m, b = three[2].turned_m - three[0].turned_m;
  return a.cross(b).norm() < flatness * (a.squaredNorm() + b.squaredNorm());
}

using Joints = std::array<Eigen::Vector3d, 3>;

// The pose that takes the platform joints there.
Rigid3 PoseOf(const std::vector<HeldJoint>& three, const Joints& in_base_m) {
  std::vector<Eigen::Vector3d> in_platform_m;
  in_platform_m.reserve(three.size());
  for (const HeldJoint& joint : three) in_platform_m.push_back(joint.turned_m);
  return FitRigid(in_platform_m, {in_base_m.begin(), in_base_m.end()});
}

Joints OnLines(const std::vector<HeldJoint>& three, const Eigen::VectorXd& along_m) {
  Joints joints;
  for (size_t i = 0; i < 3; ++i)
    joints[i] = three[i].space.point_m + along_m[static_cast<Eigen::Index>(i)] * three[i].space.along;
  return joints;
}

Joints OnCircles(const std::vector<HeldJoint>& three, const Eigen::VectorXd& cos_sin) {
  Joints joints;
  for (size_t i = 0; i < 3; ++i) {
    const VertexSpace& circle = three[i].space;
    const auto at = static_cast<Eigen::Index>(2 * i);
    joints[i] = circle.point_m +
                circle.radius_m * (cos_sin[at] * circle.along + cos_sin[at + 1] * circle.second_radius);
  }
  return joints;
}

// Of the real ones among `most` roots, by where they put the joints.
template <typename Roots, typename F>
ModeCandidates CandidatesOf(const std::vector<HeldJoint>& three, const Roots& roots, int most,
                            const F& joints_of) {
  ModeCandidates candidates;
  candidates.most_possible = most;
  for (const CertifiedRoot& root : roots.roots)
    if (root.is_real) candidates.poses.push_back(PoseOf(three, joints_of(three, root.midpoint.real())));
  candidates.is_complete = roots.is_complete;
  if (!roots.is_complete) candidates.why = WhyNotAllRoots(roots.missing, most);
  return candidates;
}

// Of joints that are not on one line.
ModeCandidates OfTriangle(const std::vector<HeldJoint>& three) {
  if (three[0].space.is_circle)
    return CandidatesOf(
        three,
        AllRoots({DistanceOnCircles(three[0], three[1]), DistanceOnCircles(three[1], three[2]),
                  DistanceOnCircles(three[2], three[0])}),
        kPointsOnCirclesRootCount, OnCircles);
  std::array<std::array<AffineForm, 3>, 3> c;
  for (size_t i = 0; i < 3; ++i) c[i] = OnLine(three[i].space, static_cast<int>(i));
  return CandidatesOf(three,
                      AllRoots(QuadricSystem({DistanceQuadric(three[0], three[1], c[0], c[1]),
                                              DistanceQuadric(three[1], three[2], c[1], c[2]),
                                              DistanceQuadric(three[2], three[0], c[2], c[0])})),
                      kThreeQuadricsRootCount, OnLines);
}

}  // namespace

ModeCandidates SpatialCandidates(const std::vector<HeldJoint>& three, const Rigid3& /*home*/) {
  ModeCandidates candidates;
  if (AreOnOneLine(three, kOnOneLine)) {
    candidates.is_infinite = true;
    candidates.why =
        "the platform joints of the seen legs lie on one line: the platform turns about it freely";
    return candidates;
  }
  candidates = OfTriangle(three);
  if (AreOnOneLine(three, kNearlyOnOneLine)) {
    candidates.is_complete = false;
    candidates.why = "the platform joints of the seen legs lie nearly on one line";
  }
  return candidates;
}

}  // namespace legible
