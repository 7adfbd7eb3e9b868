// The work of `legible legs`, from files to judgement.
#pragma once

#include <optional>
#include <vector>

#include "apps/legs_settings.h"
#include "apps/progress.h"
#include "core/hidden/hidden_leg.h"
#include "core/hidden/map_slice.h"
#include "core/robots/gough_stewart_assembly_modes.h"
#include "servo/leg_selection.h"

namespace legible {

struct LegsRun {
  LegsSettings settings;
  ParallelRobot robot;
  Rigid3 from, to;
  LegSelection selection;
  // Of each judged set, whether its lines (edges) hold the platform at the goal.
  std::vector<Controllability> by_lines;
  // With the joint readings of the goal; only of Gough-Stewart robots.
  std::optional<GoughStewartAssemblyModes> robot_modes;
  std::optional<SliceMap> map;  // where one was asked for
};

// Throws InputError.
LegsRun JudgeLegs(const LegsSettings& settings, ProgressLine& progress);

}  // namespace legible
