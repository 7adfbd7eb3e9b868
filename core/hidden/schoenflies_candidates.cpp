#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/algebra/three_quadrics.h"
#include "core/hidden/affine_forms.h"
#include "core/hidden/mode_candidates.h"

namespace legible {
namespace {

constexpr double kLeastArm_m = 1e-9;
constexpr double kLeastSine = 1e-9;
constexpr int kUnknowns = 3;

using FormsOf3 = Eigen::Matrix<RealBall, 3, Eigen::Dynamic>;

// C of both legs as affine forms: a column for 1, then for each leg cos and sin on its circle, or the way
// along its line.
using JointForms = std::array<FormsOf3, 2>;

JointForms JointFormsOf(const std::vector<HeldJoint>& two) {
  Eigen::Index columns = 1;
  for (const HeldJoint& joint : two) columns += joint.space.is_circle ? 2 : 1;
  JointForms forms;
  Eigen::Index column = 1;
  for (size_t i = 0; i < 2; ++i) {
    const VertexSpace& space = two[i].space;
    forms[i] = FormsOf3::Zero(3, columns);
    forms[i].col(0) = space.point_m.cast<RealBall>();
    const RealBall scale(space.is_circle ? space.radius_m : 1);
    forms[i].col(column++) = scale * space.along.cast<RealBall>();
    if (space.is_circle) forms[i].col(column++) = scale * space.second_radius.cast<RealBall>();
  }
  return forms;
}

// C_1 - C_2 less what between them does not turn.
FormsOf3 Apart(const std::vector<HeldJoint>& two, const JointForms& c) {
  FormsOf3 apart = c[0] - c[1];
  for (Eigen::Index k = 0; k < 3; ++k)
    apart(k, 0) -= RealBall(two[0].carried_m[k]) - RealBall(two[1].carried_m[k]);
  apart(2, 0) -= RealBall(two[0].turned_m.z()) - RealBall(two[1].turned_m.z());
  return apart;
}

// By how much C_1 and C_2 are apart horizontally, squared.
RealBall Arm_m2(const std::vector<HeldJoint>& two) {
  RealBall arm_m2(0.0);
  for (Eigen::Index k = 0; k < 2; ++k) {
    const RealBall side = RealBall(two[0].turned_m[k]) - RealBall(two[1].turned_m[k]);
    arm_m2 += side * side;
  }
  return arm_m2;
}

// The height of C_1 over C_2 is given: one of the four unknowns by the other three. Each row of the result is
// one of (1, cos, sin, cos, sin) as a form of those three; nothing where no unknown has a part in the height.
std::optional<Eigen::Matrix<RealBall, 5, 4>> WithoutHeight(const FormsOf3& apart) {
  Eigen::Index eliminated = 1;
  for (Eigen::Index k = 2; k < 5; ++k)
    if (std::abs(MidpointOf(apart(2, k))) > std::abs(MidpointOf(apart(2, eliminated)))) eliminated = k;
  if (std::abs(MidpointOf(apart(2, eliminated))) < kLeastArm_m) return std::nullopt;
  Eigen::Matrix<RealBall, 5, 4> forms;
  forms.setZero();
  forms(0, 0) = RealBall(1.0);
  Eigen::Index kept = 1;
  for (Eigen::Index k = 1; k < 5; ++k)
    if (k != eliminated) forms(k, kept++) = RealBall(1.0);
  for (Eigen::Index k = 0; k < 5; ++k)
    if (k != eliminated) forms.row(eliminated) -= forms.row(k) * (apart(2, k) / apart(2, eliminated));
  return forms;
}

template <typename Row>
AffineForm FormOf(const Row& row) {
  return row.transpose();
}

QuadricSystem CirclesAtDistance(const std::vector<HeldJoint>& two, const FormsOf3& apart,
                                const Eigen::Matrix<RealBall, 5, 4>& forms) {
  const auto on_circle = [&](Eigen::Index k) {
    return SumOfSquares({FormOf(forms.row(k)), FormOf(forms.row(k + 1))}, RealBall(1.0));
  };
  const Eigen::Matrix<RealBall, 2, 4> horizontal = apart.topRows<2>() * forms;
  return QuadricSystem({on_circle(1), on_circle(3),
                        SumOfSquares({FormOf(horizontal.row(0)), FormOf(horizontal.row(1))}, Arm_m2(two))});
}

// The pose with the platform joints at these places.
Rigid3 PoseOf(const std::vector<HeldJoint>& two, const Eigen::Vector3d& c1_m, const Eigen::Vector3d& c2_m) {
  const Eigen::Vector3d wanted = c1_m - two[0].carried_m - c2_m + two[1].carried_m;
  const Eigen::Vector3d turned = two[0].turned_m - two[1].turned_m;
  const double angle_rad = std::atan2(wanted.y(), wanted.x()) - std::atan2(turned.y(), turned.x());
  const Eigen::Quaterniond rotation = RotationFromVector({0, 0, angle_rad});
  return {rotation, c1_m - two[0].carried_m - rotation * two[0].turned_m};
}

// Of the real ones among the roots; `values` has (1, cos, sin, ...) of both joints by (1, the system's
// unknowns).
ModeCandidates CandidatesOf(const std::vector<HeldJoint>& two, const JointForms& c,
                            const ThreeQuadricsRoots& roots, const Eigen::MatrixXd& values,
                            int most_possible) {
  const auto midpoint = [](const RealBall& x) { return MidpointOf(x); };
  const Eigen::Matrix3Xd first = c[0].unaryExpr(midpoint), second = c[1].unaryExpr(midpoint);
  ModeCandidates candidates;
  candidates.most_possible = most_possible;
  for (const CertifiedRoot& root : roots.roots) {
    if (!root.is_real) continue;
    const Eigen::VectorXd at = values * (Eigen::Vector4d() << 1, root.midpoint.real()).finished();
    candidates.poses.push_back(PoseOf(two, first * at, second * at));
  }
  const int missing = most_possible - static_cast<int>(roots.roots.size());
  candidates.is_complete = missing <= 0;
  if (missing > 0) candidates.why = WhyNotAllRoots(missing, most_possible);
  return candidates;
}

ModeCandidates OfCircles(const std::vector<HeldJoint>& two) {
  const Eigen::Vector3d first_normal = two[0].space.along.cross(two[0].space.second_radius);
  const Eigen::Vector3d second_normal = two[1].space.along.cross(two[1].space.second_radius);
  const bool are_parallel = first_normal.cross(second_normal).norm() < kLeastSine;
  // In parallel planes four of the eight are at infinity.
  const int most_possible = are_parallel ? kThreeQuadricsRootCount / 2 : kThreeQuadricsRootCount;
  const JointForms c = JointFormsOf(two);
  const FormsOf3 apart = Apart(two, c);
  const auto forms = WithoutHeight(apart);
  if (!forms) {
    ModeCandidates candidates;
    candidates.most_possible = most_possible;
    candidates.why = "both seen legs move horizontally alone";
    return candidates;
  }
  return CandidatesOf(two, c, AllRoots(CirclesAtDistance(two, apart, *forms)),
                      forms->unaryExpr([](const RealBall& x) { return MidpointOf(x); }), most_possible);
}

// The height is a plane in (way along the line, cos, sin): of the eight roots four are at infinity.
ModeCandidates OfLineAndCircle(const std::vector<HeldJoint>& two) {
  const JointForms c = JointFormsOf(two);
  const FormsOf3 apart = Apart(two, c);
  const int cosine = two[0].space.is_circle ? 0 : 1;
  const QuadricSystem system(
      {AsQuadric(FormOf(apart.row(2))),
       SumOfSquares({UnknownForm(kUnknowns, cosine), UnknownForm(kUnknowns, cosine + 1)}, RealBall(1.0)),
       SumOfSquares({FormOf(apart.row(0)), FormOf(apart.row(1))}, Arm_m2(two))});
  return CandidatesOf(two, c, AllRoots(system), Eigen::Matrix4d::Identity(), kThreeQuadricsRootCount / 2);
}

// Heights tell how far C_1 is along its rail by how far C_2 is along its own; the arm's length then is a
// quadratic equation. The rails are not parallel.
ModeCandidates OfLines(const std::vector<HeldJoint>& two) {
  ModeCandidates candidates;
  candidates.most_possible = 2;
  const Eigen::Vector3d a = two[0].space.along, b = two[1].space.along;
  Eigen::Vector3d apart = two[0].space.point_m - two[1].space.point_m - two[0].carried_m + two[1].carried_m;
  const Eigen::Vector3d turned = two[0].turned_m - two[1].turned_m;
  // (x, y) along the rails with a_z x - b_z y = height: from the nearest solution along (b_z, a_z).
  const Eigen::Vector2d heights(a.z(), -b.z());
  if (heights.norm() < kLeastSine) {
    candidates.is_infinite = true;
    candidates.why = "the lines along which the seen legs leave the platform free are both horizontal";
    return candidates;
  }
  const Eigen::Vector2d nearest = heights * ((turned.z() - apart.z()) / heights.squaredNorm());
  const Eigen::Vector2d free(b.z(), a.z());
  const Eigen::Vector2d start = (apart + nearest[0] * a - nearest[1] * b).head<2>();
  const Eigen::Vector2d rate = (free[0] * a - free[1] * b).head<2>();
  const double middle = -start.dot(rate) / rate.squaredNorm();
  const double arm_m2 = turned.head<2>().squaredNorm();
  const double half2 = (arm_m2 - (start + middle * rate).squaredNorm()) / rate.squaredNorm();
  candidates.is_complete = std::abs(half2) * rate.squaredNorm() > kLeastHalf2 * arm_m2;
  if (!candidates.is_complete) candidates.why = kRootsCoincide;
  if (!(half2 >= 0)) return candidates;
  for (const double step : {std::sqrt(half2), -std::sqrt(half2)}) {
    const Eigen::Vector2d along = nearest + (middle + step) * free;
    candidates.poses.push_back(
        PoseOf(two, two[0].space.point_m + along[0] * a, two[1].space.point_m + along[1] * b));
  }
  return candidates;
}

}  // namespace

ModeCandidates SchoenfliesCandidates(const std::vector<HeldJoint>& two, const Rigid3& /*home*/) {
  if ((two[0].turned_m - two[1].turned_m).head<2>().norm() < kLeastArm_m) {
    ModeCandidates candidates;
    candidates.is_infinite = true;
    candidates.why = "the seen legs hold the same half of the platform: its rotation is not seen";
    return candidates;
  }
  if (two[0].space.is_circle != two[1].space.is_circle) return OfLineAndCircle(two);
  return two[0].space.is_circle ? OfCircles(two) : OfLines(two);
}

}  // namespace legible
