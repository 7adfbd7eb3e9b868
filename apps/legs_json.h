// The judgement of `legible legs` as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/legs_run.h"

namespace legible {

// {robot, platform, from, to, noise_rad, legs [{leg, chain, hidden_chain, why_not_controllable}], robot_path,
//  robot_modes (of a hexapod, by its joints), sets [{legs, verdict, why, controllability, by_lines, path,
//  assembly_modes, largest_error_at_goal, largest_error_on_path, simulation}], choice (the first set's legs,
//  or null), why_no_choice, maps, warnings}.
// Legs count from 1, poses are base_from_platform, units SI.
nlohmann::ordered_json LegsJson(const LegsRun& run);

}  // namespace legible
