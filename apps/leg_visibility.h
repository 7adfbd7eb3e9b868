// Whether a camera sees the legs at a pose.
#pragma once

#include <functional>

#include "core/geometry/camera.h"
#include "core/robots/parallel_robot.h"

namespace legible {

// Of a leg (from 0) at base_from_platform: some of its seen segment lies within the image, apart from what
// may stand before it.
std::function<bool(int leg, const Rigid3& base_from_platform)> VisibilityOfLegs(
    const ParallelRobot& robot, const Camera& camera, const Rigid3& camera_from_base);

}  // namespace legible
