// Runs as the figures of Andreff, Dallej and Martinet 2007 draw them.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/testing/delta_lab.h"

namespace legible {

// Figure 5: the platform's origin (mm) and where the middles of its rear and front pairs of joints are, in
// the symmetry plane: x away from the camera's side and z up, both in base.
nlohmann::json SideView(const LabServo& servo, const LabRun& run);

// Figures 6 to 8: the components of u x u* of each leg in camera (mrad), the offsets of each edge at both
// ends of its stretch at the goal (px, outward), and the rms of both, by time.
nlohmann::json ErrorCurves(const LabServo& servo, const LabRun& run);

}  // namespace legible
