// What a cycle of the servo begins with.
#pragma once

#include "core/rig/rig.h"
#include "core/vision/seen_edges.h"

namespace legible {

struct CycleInput {
  double time_s = 0;  // of the rig's clock
  StampedReadings readings;
  SeenEdges seen;
};

}  // namespace legible
