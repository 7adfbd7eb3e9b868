// ViSP's moving edges as both comparisons use them. For ViSP's own sources: C++17.
#pragma once

#include <visp3/me/vpMe.h>

namespace legible {

// The settings of ViSP's own line tutorial, with the search range of the profile fit.
inline vpMe MovingEdges() {
  vpMe me;
  me.setMaskSize(5);
  me.setMaskNumber(180);
  me.setRange(8);
  me.setThreshold(5000);
  me.setMu1(0.5);
  me.setMu2(0.5);
  me.setSampleStep(4);
  return me;
}

}  // namespace legible
