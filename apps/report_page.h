// The reports: each one HTML page that needs nothing beside it, neither files nor a network. What is null or
// not finite in their data is shown as a dash; bytes that are not UTF-8 are replaced by U+FFFD.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

// The calibration report (report.html) with `data` embedded as JSON. Its members, all optional:
//   title, program_version, session    texts
//   calibration                        what calibration.json holds
//   nominal                            {camera, legs}: where the calibration started
//   images                             [{name, width, height, picture (a data: address), rms_px,
//   held_out_rms_px,
//                                        left_out (why), edges: [{leg, edge, left_out, rms_px, shift_px,
//                                        blur_px, samples: [[x, y, residual_px, weight, place]], predicted:
//                                        [[x, y]]}]}]
//   correlations                       {names, matrix}
//   weak, priors, checks, options      [{description, relative_sigma}], [{name, value, sigma, found,
//   pull_sigma}],
//                                      [{name, text, rms_px, mm}], {name: value}
// Units as in all files; legs and edges count from 1; a place is 0 at the base joint, 1 at the platform
// joint; residuals are positive outward.
std::string RenderCalibrationPage(const nlohmann::json& data);

// The accuracy report with `data` embedded as JSON; a part without data is left out. Its members, all
// optional:
//   title, program_version, model   texts
//   document   what `legible accuracy --format json` prints; its `units` say the units of all its numbers
//   robot      {legs: [{base_joint_m, platform_joint_m, radius_m}]}, joints in base and in platform
//   poses_si   [{rotation_xyzw, translation_m}]: base_from_platform of each of document.poses
//   maps       {x, y: {label, unit, values}, fixed (text), quantities: [{key, label, unit, values}],
//              states}: errors over a slice of the workspace. values[j][i] and states[j][i] belong to
//              x.values[i] and y.values[j], which are equally spaced; a state is 0 (fine), 1 (outside the
//              joint ranges) or 2 (singular, or near it)
//   scatter    {over (text), names, indices, errors: [{key, label, unit, values}]}: indices against errors,
//              one value for each of names; the errors' keys are "position" and "rotation"
// The picture of the robot takes errors as displacements of the platform in the axes of base.
std::string RenderAccuracyPage(const nlohmann::json& data);

// The servo report with `data` embedded as JSON; a part without data is left out. SI units; legs and edges
// count from 1. Its members, all optional:
//   title, program_version, model, rig, log   texts
//   document   what `legible servo --format json` prints; its `unit` (px, rad or m) is that of its errors
//   settings   {name: what it was}, in words, units with them
//   robot      {legs: [{base_joint_m, platform_joint_m, radius_m, joint_range_m: [least, largest]}],
//              speed_limit_m_per_s}
//   goal       {base_from_platform: {rotation_xyzw, translation_m}, joint_readings_m: [6]}, as far as known
//   cycles     one entry a cycle in each of: time_s (from the start of the run, growing); error, tolerance
//              (in document.unit), edge_error_px, direction_error_rad; gain_per_s, conditioning,
//              smallest_singular_value, robot_conditioning; speed_factor, singularity_factor (1: not slowed);
//              edges (how many were seen); look_s, law_s; limits (clauses joined by "; ", "": none);
//              joint_speeds_m_per_s, joint_readings_m, direction_errors_rad ([6] each); edge_errors_px
//              ([12]: leg 1 edge 1, leg 1 edge 2, ...; null: not seen); poses (base_from_platform by the
//              readings), true_poses (missing where the rig does not know)
//   pictures   [{label, time_s, width_px, height_px, image (a data: address), current, desired:
//              [{leg, edge, points: [[x, y]]}]}]
// The page draws the deviation of the path from the straight line from the first pose to the goal, or, where
// the goal's pose is not known, to the last pose.
std::string RenderServoPage(const nlohmann::json& data);

// The report of `legible intrinsics` with `data` embedded as JSON; a part without data is left out. SI units
// and px; pixel (0, 0) is the centre of the top-left pixel. Grids are cells of equal size over the image, row
// by row; null where the lens model does not reach. Its members, all optional:
//   title, program_version, board   texts; board describes it
//   intrinsics   what intrinsics.json holds: status, message, warnings, camera {width_px, height_px, lens,
//              fx, fy, cx, cy, distortion, sigma}, rms_px, noise_px, neighbour_noise_px, views_used,
//              views_left_out [{name, why}], corners_used, corners_left_out, corners_weighed_down,
//              board_warp_m [x, y], uncertainty [{distance_m (null: infinitely far), rms_px, worst_px}],
//              cross_validation {why_not, difference_rms_px, expected_rms_px, ratio, ratio_limit, misfit,
//              sigma_factor, sentence}, coverage {share, largest_tilt_rad, sentence}, next_view {sentence,
//              centre_px, tilt_rad, tilt_direction_rad, distance_m, now_px, then_px}, time_s (a number, or
//              {stage: s, ..., total}), iterations, options, content_hash
//   views      [{name (each its own), width, height, picture (a data: address), left_out (why), rms_px,
//              tilt_rad, tilt_direction_rad (0: the board's right side is farther away; clockwise in the
//              image), distance_m, corners, left_out_corners, unused}]:
//              corners [[x, y, residual_x, residual_y, weight]]: residual: predicted less observed; weight 0:
//              an outlier; nulls: took no part
//              left_out_corners [{x, y, what, why}]: what has a place in the image and never came to the
//              estimate; none of these is among corners
//              unused [texts]: what was left out and has no place in the image
//   maps       {columns, rows, maps: [{distance_m (null: infinitely far), sigma_px}]}
//   halves     {columns, rows, distance_m, difference_px [[dx, dy]], expected_px: the rms length that noise
//              would give it; without, cross_validation.expected_rms_px everywhere}
//   coverage   {columns, rows, corners [counts]}
//   next_view  {outline_px [[x, y]]}: the proposed board in the image, a closed polygon
//   correlations   {names, matrix}; a name: camera.fx_px, ..., camera.k1, ..., board_warp_m.x, board_warp_m.y
//   options    {name: value}
std::string RenderIntrinsicsPage(const nlohmann::json& data);

// The page of `legible legs` with `data` embedded as JSON; a part without data is left out. SI units, points
// in base; legs count from 1. Its members, all optional:
//   title, program_version, model   texts
//   document   what `legible legs --format json` prints
//   robot      {legs: [{base_joint_m, radius_m}]}
//   places     {from, to: a place of each leg; modes: of each of document.sets null or, of each of its
//   assembly
//              modes, the goal first, a place of each leg}. A place: {start_m, platform_joint_m}, the start
//              of the seen segment, null where the leg does not reach the pose, and the platform's joint. In
//              a mode the legs of the set bend so that they point as at the goal, others as at home.
//   simulations   of each of document.sets null or {time_s, position_from_goal_m, rotation_from_goal_rad,
//              errors_rad: [one list a leg of the set]}: samples of the simulated servo
std::string RenderLegsPage(const nlohmann::json& data);

}  // namespace legible
