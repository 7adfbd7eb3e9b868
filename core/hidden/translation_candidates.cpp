#include <Eigen/Geometry>
#include <cmath>

#include "core/hidden/mode_candidates.h"

namespace legible {
namespace {

constexpr double kLeastSine = 1e-9;

// Where the platform's origin can be: the joint's space moved by what lies between.
VertexSpace OfOrigin(const HeldJoint& joint, const Rigid3& home) {
  VertexSpace space = joint.space;
  space.point_m -= home.rotation * joint.turned_m + joint.carried_m;
  return space;
}

Eigen::Vector3d Normal(const VertexSpace& circle) { return circle.along.cross(circle.second_radius); }

ModeCandidates AtPoint(const Eigen::Vector3d& point_m, const Rigid3& home) {
  ModeCandidates candidates;
  candidates.most_possible = 2;
  candidates.is_complete = true;
  candidates.poses.push_back({home.rotation, point_m});
  return candidates;
}

ModeCandidates Infinite(const char* why) {
  ModeCandidates candidates;
  candidates.most_possible = 2;
  candidates.is_infinite = true;
  candidates.why = why;
  return candidates;
}

// Points of a line, in the circle's plane, that are on the circle.
ModeCandidates OnCircle(const VertexSpace& circle, const Eigen::Vector3d& point_m,
                        const Eigen::Vector3d& along, const Rigid3& home) {
  const Eigen::Vector3d nearest = point_m + along * along.dot(circle.point_m - point_m);
  const double radius_m2 = circle.radius_m * circle.radius_m;
  const double half_m2 = radius_m2 - (nearest - circle.point_m).squaredNorm();
  ModeCandidates candidates;
  candidates.most_possible = 2;
  candidates.is_complete = std::abs(half_m2) > kLeastHalf2 * radius_m2;
  if (!candidates.is_complete) candidates.why = kRootsCoincide;
  if (!(half_m2 >= 0)) return candidates;
  for (const double half_m : {std::sqrt(half_m2), -std::sqrt(half_m2)})
    candidates.poses.push_back({home.rotation, nearest + half_m * along});
  return candidates;
}

// That are not parallel.
ModeCandidates TwoLines(const VertexSpace& a, const VertexSpace& b, const Rigid3& home) {
  const Eigen::Vector3d across = a.along.cross(b.along);
  const double along_m = (b.point_m - a.point_m).cross(b.along).dot(across) / across.squaredNorm();
  return AtPoint(a.point_m + along_m * a.along, home);
}

// Of circles in one plane the line through both common points; else the line common to both planes.
ModeCandidates TwoCircles(const VertexSpace& a, const VertexSpace& b, const Rigid3& home) {
  const Eigen::Vector3d na = Normal(a), nb = Normal(b), across = na.cross(nb);
  const Eigen::Vector3d apart = b.point_m - a.point_m;
  if (across.norm() >= kLeastSine) {
    const Eigen::Vector3d along = across.normalized();
    const Eigen::Vector3d in_a = na.cross(along);
    const Eigen::Vector3d point_m = a.point_m + in_a * (nb.dot(apart) / nb.dot(in_a));
    return OnCircle(a, point_m, along, home);
  }
  if (apart.norm() < kLeastSine * a.radius_m)
    return Infinite("the circles along which the seen legs leave the platform free are the same");
  const Eigen::Vector3d towards = apart.normalized();
  const double to_chord_m =
      (apart.squaredNorm() + a.radius_m * a.radius_m - b.radius_m * b.radius_m) / (2 * apart.norm());
  return OnCircle(a, a.point_m + to_chord_m * towards, na.cross(towards), home);
}

ModeCandidates CircleAndLine(const VertexSpace& circle, const VertexSpace& line, const Rigid3& home) {
  const Eigen::Vector3d normal = Normal(circle);
  const double sine = normal.dot(line.along);
  if (std::abs(sine) < kLeastSine) return OnCircle(circle, line.point_m, line.along, home);
  const double along_m = normal.dot(circle.point_m - line.point_m) / sine;
  return AtPoint(line.point_m + along_m * line.along, home);
}

}  // namespace

ModeCandidates TranslationCandidates(const std::vector<HeldJoint>& two, const Rigid3& home) {
  const VertexSpace a = OfOrigin(two[0], home), b = OfOrigin(two[1], home);
  if (a.is_circle && b.is_circle) return TwoCircles(a, b, home);
  if (a.is_circle) return CircleAndLine(a, b, home);
  if (b.is_circle) return CircleAndLine(b, a, home);
  return TwoLines(a, b, home);
}

ModeCandidates PlanarPointCandidates(const std::vector<HeldJoint>& two, const Rigid3& home) {
  return TranslationCandidates(two, home);
}

}  // namespace legible
