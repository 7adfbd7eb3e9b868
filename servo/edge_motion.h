// Whether two images show the same, or a motion.
#pragma once

#include "core/vision/seen_edges.h"

namespace legible {

// The same edges, to the last bit.
bool SameEdges(const SeenEdges& a, const SeenEdges& b);

// With noise that shows no image comes twice. (An image-free simulation without noise states very little.)
bool HasNoise(const SeenEdges& seen);

// Whether the edges have moved by more than the noise of both images can do, and by more than a reading's
// step: by their normalised squares, two an edge, of which noise leaves a mean of 1.
bool HaveMoved(const SeenEdges& before, const SeenEdges& now);

}  // namespace legible
