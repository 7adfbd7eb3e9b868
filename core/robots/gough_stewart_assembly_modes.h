// All poses that a Gough-Stewart robot can take with the same joint readings.
#pragma once

#include <vector>

#include "core/robots/gough_stewart.h"

namespace legible {

inline constexpr int kGoughStewartRootCount = 40;  // complex, of a general robot (Ronga and Vust 1995)

struct AssemblyModeStart;

struct GoughStewartAssemblyMode {
  Rigid3 base_from_platform;
  double largest_length_error_m = 0;  // of a leg, by InverseKinematics
};

struct GoughStewartAssemblyModes {
  std::vector<GoughStewartAssemblyMode> modes;  // each proved to exist, and to differ from the others
  // Whether 40 complex roots were certified, so that there is no mode but these. Robots of special geometry
  // have multiple roots, or roots at infinity, and are not complete by this count.
  bool is_complete = false;
  int certified = 0;    // complex roots, the real ones included
  int at_infinity = 0;  // paths on which the platform left for infinity, as far as doubles tell
  int uncertified = 0;  // the others: multiple roots, roots too close to tell, paths that failed
};

// All real solutions of the forward kinematics for the joint readings (m): 40 paths of a projective homotopy
// in Study coordinates, whose ends are certified one by one; docs/hidden-robots-formulation.md derives it.
// Throws std::invalid_argument for lengths or joints that are not finite. The first call takes longer: it
// prepares the paths' starts.
GoughStewartAssemblyModes AllAssemblyModes(const GoughStewart& robot, const Vector6d& joint_readings_m);

// The same by paths that start elsewhere (core/robots/assembly_mode_start.h).
GoughStewartAssemblyModes AllAssemblyModes(const GoughStewart& robot, const Vector6d& joint_readings_m,
                                           const AssemblyModeStart& start);

}  // namespace legible
