// Where the paths to the assembly modes of every Gough-Stewart robot start.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/algebra/path_tracker.h"

namespace legible {

// Six general complex conditions on a rigid motion (MotionCondition) and Study's quadric, with the 40 motions
// that satisfy them: as many as six general ones have (Ronga and Vust 1995).
struct AssemblyModeStart {
  HomogeneousQuadrics<8> quadrics;
  std::vector<PathTracker<8>::Point> solutions;  // of length 1
};

// Found by monodromy: from one solution, around loops of systems (Duff et al., Solving polynomial systems via
// homotopy continuation and monodromy, IMA Journal of Numerical Analysis 39, 2019). The conditions are drawn
// from the seed. Throws std::runtime_error should the loops not lead to all 40.
AssemblyModeStart MakeAssemblyModeStart(uint64_t seed);

}  // namespace legible
