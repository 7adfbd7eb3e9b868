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
  kUndecided,   // none of these, in as many trials and down to as small pieces as are made: the path passes a
                // singularity or very near to one, or is not known to be one that RPS legs allow
};
const char* ToString(PathVerdict verdict);

struct PathCertificate {
  PathVerdict verdict = PathVerdict::kUndecided;
  int pieces = 0;   // the path was cut into, to prove it
  double at = 0;    // part of the path, 0 to 1, up to which it is proved free
  Rigid3 pose;      // there
  std::string why;  // in words, where not free
};

// The straight path, brought back to what RPS legs allow (core/robots/straight_path.h), of which start and
// goal have to be poses, to 1e-8 m. Of `legs` (from 0) Type 1 and Type 2 singularities are excluded; of the
// real robot, whichever joints are actuated, all legs count. Of RPS legs, all of the robot, what their R
// forbid counts with what is held. A piece is proved where M, which is what is held by the platform's twist,
// has full rank on all of it: |I - Y M V| < 1 for every such M, with Y M V about I at its middle.
PathCertificate CertifyStraightPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                                    const Rigid3& from, const Rigid3& to);

// The same through all poses, straight from each to the next; `at` counts each part alike. Of RPS legs each
// part begins and ends within 1e-8 m of its poses, where its correction is proved to be: that the end of one
// and the start of the next, both so near to a pose, are joined without a singularity is not proved.
PathCertificate CertifyPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                            const std::vector<Rigid3>& poses);

}  // namespace legible
