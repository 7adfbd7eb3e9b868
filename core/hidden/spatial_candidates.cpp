#include <Eigen/Geometry>
#include <array>

#include "core/algebra/three_quadrics.h"
#include "core/hidden/affine_forms.h"
#include "core/hidden/mode_candidates.h"

namespace legible {
namespace {

// Of the platform's size; below it three joints are on one line.
constexpr double kLeastTriangle = 1e-5;

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

bool AreOnOneLine(const std::vector<HeldJoint>& three) {
  const Eigen::Vector3d a = three[1].turned_m - three[0].turned_m, b = three[2].turned_m - three[0].turned_m;
  return a.cross(b).norm() < kLeastTriangle * (a.squaredNorm() + b.squaredNorm());
}

Rigid3 PoseOf(const std::vector<HeldJoint>& three, const Eigen::Vector3d& along_m) {
  std::vector<Eigen::Vector3d> in_platform, in_base;
  for (size_t i = 0; i < 3; ++i) {
    in_platform.push_back(three[i].turned_m);
    in_base.emplace_back(three[i].space.point_m +
                         along_m[static_cast<Eigen::Index>(i)] * three[i].space.along);
  }
  return FitRigid(in_platform, in_base);
}

}  // namespace

ModeCandidates SpatialCandidates(const std::vector<HeldJoint>& three, const Rigid3& /*home*/) {
  ModeCandidates candidates;
  candidates.most_possible = kThreeQuadricsRootCount;
  if (AreOnOneLine(three)) {
    candidates.is_infinite = true;
    candidates.why =
        "the platform joints of the seen legs lie on one line: the platform turns about it freely";
    return candidates;
  }
  std::array<std::array<AffineForm, 3>, 3> c;
  for (size_t i = 0; i < 3; ++i) c[i] = OnLine(three[i].space, static_cast<int>(i));
  const ThreeQuadricsRoots roots = AllRoots(QuadricSystem({DistanceQuadric(three[0], three[1], c[0], c[1]),
                                                           DistanceQuadric(three[1], three[2], c[1], c[2]),
                                                           DistanceQuadric(three[2], three[0], c[2], c[0])}));
  for (const CertifiedRoot& root : roots.roots)
    if (root.is_real) candidates.poses.push_back(PoseOf(three, root.midpoint.real()));
  candidates.is_complete = roots.is_complete;
  if (!roots.is_complete)
    candidates.why = std::to_string(roots.missing) + " of the 8 roots are multiple or at infinity";
  return candidates;
}

}  // namespace legible
