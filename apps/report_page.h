// The calibration report: one HTML page that needs nothing beside it, neither files nor a network.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace legible {

// The page report.html with `data` embedded as JSON. Its members, all optional:
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
// joint; residuals are positive outward. What is null or not finite is shown as a dash. Bytes that are not
// UTF-8 are replaced by U+FFFD.
std::string RenderReportPage(const nlohmann::json& data);

}  // namespace legible
