// The poses at which platform joints lie on their vertex spaces, for each motion of a platform. What
// assembly_modes.cpp puts together.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/hidden/vertex_space.h"
#include "core/robots/parallel_robot.h"

namespace legible {

// A platform joint and where it can be: C(pose) = p + R turned + carried on the space.
struct HeldJoint {
  Eigen::Vector3d turned_m;   // in platform
  Eigen::Vector3d carried_m;  // in base
  VertexSpace space;
};

struct ModeCandidates {
  std::vector<Rigid3> poses;  // base_from_platform
  bool is_complete = false;   // proved that there are no others
  bool is_infinite = false;   // the joints leave the platform free
  int most_possible = 0;
  std::string why;  // not complete, or infinite
};

// Of two solutions of a quadratic equation, the square of half of what is between them, relative: below it
// rounding does not tell whether there are two or none.
inline constexpr double kLeastHalf2 = 1e-12;
inline constexpr const char* kRootsCoincide = "two poses coincide, or nearly so";

// Of equations that have so many roots, where `missing` of them are not certified.
inline std::string WhyNotAllRoots(int missing, int most_possible) {
  return std::to_string(missing) + " of the " + std::to_string(most_possible) +
         " roots are multiple or at infinity";
}

// Two joints, x and y: intersections of circles and lines in the plane of `home`.
ModeCandidates PlanarPointCandidates(const std::vector<HeldJoint>& two, const Rigid3& home);

// Three joints, x, y and rotation about z: the coupler curve's intersections, at most 6, 6, 4 or 2 with no,
// one, two or three lines.
ModeCandidates PlanarCandidates(const std::vector<HeldJoint>& three, const Rigid3& home);

// Two joints, x, y and z: two circles or lines in space.
ModeCandidates TranslationCandidates(const std::vector<HeldJoint>& two, const Rigid3& home);

// Two joints, x, y, z and rotation about z: a Bohemian dome and a circle, at most 8; a line and a circle, at
// most 4; two lines, at most 2.
ModeCandidates SchoenfliesCandidates(const std::vector<HeldJoint>& two, const Rigid3& home);

// Three joints, all six: on lines at most 8, on circles at most 16. All three of one kind.
ModeCandidates SpatialCandidates(const std::vector<HeldJoint>& three, const Rigid3& home);

}  // namespace legible
