// Whether a robot, real or hidden, is free of singularities along a whole path: proved by balls that enclose
// everything between the path's points, not by samples.
#pragma once

#include <string>
#include <vector>

#include "core/hidden/singularity_conditions.h"
#include "core/robots/parallel_robot.h"

namespace legible {

enum class PathVerdict {
  kFree,        // proved: no singularity on the path, so that its ends are in one aspect
  kSingular,    // proved: a signed condition changes its sign, no path joins the ends within an aspect
  kOutOfReach,  // proved: a leg does not reach some pose of the path
  kUndecided,   // neither, down to the smallest piece: the path passes a singularity or very near to one
};
const char* ToString(PathVerdict verdict);

struct PathCertificate {
  PathVerdict verdict = PathVerdict::kUndecided;
  int pieces = 0;   // the path was cut into, to prove it
  double at = 0;    // part of the path, 0 to 1, up to which it is proved free
  Rigid3 pose;      // there
  std::string why;  // in words, where not free
};

// The straight path: the platform's origin on a line, its rotation about one axis, both at constant speed. Of
// `legs` (from 0) Type 1 and Type 2 singularities are excluded; of the real robot, whose legs have to be
// those whose first joint or length is actuated, all legs count. A piece is proved where with Y the
// pseudo-inverse of the held matrix M at its middle |I - Y M| < 1 for every M on the piece, so that M has
// full rank on all of it.
PathCertificate CertifyStraightPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                                    const Rigid3& from, const Rigid3& to);

// The same through all poses, straight from each to the next; `at` counts each part alike.
PathCertificate CertifyPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                            const std::vector<Rigid3>& poses);

}  // namespace legible
