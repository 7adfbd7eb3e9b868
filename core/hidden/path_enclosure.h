// Enclosures of a straight path's poses over pieces of it, the corrections that RPS legs demand included:
// that these exist and are one continuous curve is proved by Krawczyk's test in balls.
#pragma once

#include <optional>

#include "core/algebra/ball.h"
#include "core/algebra/ball_jet.h"
#include "core/robots/straight_path.h"

namespace legible {

using PoseBalls = leg_geometry::PlatformPose<RealBall>;
using PoseJets = leg_geometry::PlatformPose<RealBallJet>;

struct PathPiece {
  PoseJets pose;                  // all of its poses, and their rates by s
  PoseBalls middle_pose;          // at the middle of s
  double half_length = 0;         // of s, from there to either end at most
  RealBallVector end_correction;  // c at its end
};

// The correction c at an end of the path, s = 0 or 1, a root next to zero; nothing where that is not proved.
std::optional<RealBallVector> CorrectionAtEnd(const StraightPath& path, double s);

// Whether a correction is that at an end.
bool IsAtEnd(const RealBallVector& correction);

// The piece from s = begin, where the path's correction is known, to end: on all of it c is proved to be the
// one root in a box that holds the given one. Nothing where the proof fails.
std::optional<PathPiece> EnclosePiece(const StraightPath& path, double begin,
                                      const RealBallVector& begin_correction, double end);

}  // namespace legible
