// Maps of `legible legs` over a slice of the workspace.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/legs_settings.h"
#include "apps/progress.h"
#include "core/hidden/map_slice.h"

namespace legible {

// Texts of --map taken apart: two coordinates, each with a range that is not empty. Throws
// std::invalid_argument with a message for the user.
CoordinateRanges ParseMap(const std::string& text);

// The slice through the goal that the user asked for. Without ranges the first two coordinates that the
// platform clearly moves along there, wherever the robot reaches from the goal within the slice; nothing of
// a platform with one freedom. Throws InputError where the platform cannot move along both coordinates.
std::optional<PoseSlice> SliceOf(const LegsSettings& settings, const ParallelRobot& robot,
                                 const Rigid3& goal);

SliceMap MapLegSets(const LegsSettings& settings, const ParallelRobot& robot, const PoseSlice& slice,
                    const std::vector<std::vector<int>>& leg_sets, ProgressLine& progress);

}  // namespace legible
