#include "apps/legs_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/option_values.h"
#include "apps/text_table.h"
#include "apps/wording.h"
#include "core/geometry/orientation.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

std::string LegsOf(const ordered_json& set) {
  return fmt::format("{}", fmt::join(set.at("legs").get<std::vector<int>>(), ","));
}

std::string ChainsText(const ordered_json& document) {
  std::vector<TableRow> rows = {{"leg", "real", "hidden", ""}};
  for (const ordered_json& leg : document.at("legs"))
    rows.push_back({std::to_string(leg.at("leg").get<int>()), leg.at("chain"),
                    leg.at("hidden_chain").is_null() ? "none" : leg.at("hidden_chain").get<std::string>(),
                    leg.at("why_not_controllable").is_null()
                        ? ""
                        : "not controllable: " + leg.at("why_not_controllable").get<std::string>()});
  return "Legs, what is actuated after an underscore\n" + AlignedTable(rows);
}

// "3.73 mm, 2.76 deg"
std::string ErrorText(const ordered_json& error) {
  if (error.is_null()) return "-";
  return fmt::format("{:.3g} mm, {:.3g} deg", error.at("position_m").get<double>() * 1e3,
                     error.at("rotation_rad").get<double>() / kDegree_rad);
}

std::string ModeCountText(const ordered_json& modes) {
  if (modes.is_null()) return "-";
  const std::string status = modes.at("status");
  if (status == "infinite") return "infinitely many";
  if (status == "unreachable" || modes.at("modes").empty()) return "-";
  return fmt::format("{}{}", modes.at("modes").size() - 1, status == "complete" ? "" : " or more");
}

// Of all sets but the chosen one, of which a warning says it.
std::string OpenModesText(const ordered_json& document) {
  std::string text;
  for (const ordered_json& set : document.at("sets")) {
    const ordered_json& modes = set.at("assembly_modes");
    if (modes.is_null() || modes.at("status") != "incomplete" || set.at("legs") == document.at("choice"))
      continue;
    text += fmt::format("  {}: other modes may not be all: {}\n", LegsOf(set),
                        modes.at("why").get<std::string>());
  }
  return text;
}

std::string SetsText(const ordered_json& document) {
  std::vector<TableRow> rows = {
      {"legs", "verdict", "other modes", "largest error at goal", "on the way", "by edges"}};
  for (const ordered_json& set : document.at("sets"))
    rows.push_back({LegsOf(set), set.at("verdict"), ModeCountText(set.at("assembly_modes")),
                    ErrorText(set.at("largest_error_at_goal")), ErrorText(set.at("largest_error_on_path")),
                    set.at("by_lines").at("status")});
  std::string text = fmt::format("\nSets of legs, directions off by up to {:.3g} deg\n{}",
                                 document.at("noise_rad").get<double>() / kDegree_rad, AlignedTable(rows));
  for (const ordered_json& set : document.at("sets"))
    if (!set.at("why").get<std::string>().empty())
      text += fmt::format("  {}: {}\n", LegsOf(set), set.at("why").get<std::string>());
  return text + OpenModesText(document);
}

Rigid3 PoseOf(const ordered_json& pose) {
  const auto t = pose.at("translation_m").get<std::vector<double>>();
  const auto q = pose.at("rotation_xyzw").get<std::vector<double>>();
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), {t[0], t[1], t[2]}};
}

// What keeps the robot from a mode.
std::string HowFarOutText(const ordered_json& mode) {
  std::string text;
  if (!mode.at("has_own_working_modes").get<bool>()) text += ", past a stretched or folded leg";
  if (mode.at("within_joint_ranges") == false) text += ", beyond the reach of its joints";
  return text;
}

std::string ModesText(const ordered_json& document) {
  std::string text;
  for (const ordered_json& set : document.at("sets")) {
    if (set.at("assembly_modes").is_null()) continue;
    const ordered_json& modes = set.at("assembly_modes").at("modes");
    for (size_t i = 1; i < modes.size(); ++i)
      text += fmt::format("  {}: {}{}\n", LegsOf(set), PoseText(PoseOf(modes[i].at("base_from_platform"))),
                          HowFarOutText(modes[i]));
  }
  if (text.empty()) return "";
  return "\nWhere else the seen legs point as they do at the goal, as --to takes it (x y z rx ry rz, m and "
         "rad)\n" +
         text;
}

std::string PathText(const ordered_json& document) {
  const ordered_json& path = document.at("robot_path");
  if (path.at("verdict") == "free")
    return fmt::format("\nThe robot's own straight way is free of singularities: proved on {} pieces.\n",
                       path.at("pieces").get<int>());
  return fmt::format(
      "\nThe robot's own straight way is not proved free of singularities beyond {:.4g} of it: {}.\n",
      path.at("free_up_to").get<double>(), path.at("why").get<std::string>());
}

std::string RobotModesText(const ordered_json& document) {
  const ordered_json& own = document.at("robot_modes");
  if (own.is_null()) return "";
  const bool is_complete = own.at("status") == "complete";
  return fmt::format("All its joints read as at the goal at {} other poses{}.\n", own.at("modes").size() - 1,
                     is_complete ? "" : " or more: " + own.at("why").get<std::string>());
}

std::string ChoiceText(const ordered_json& document) {
  if (document.at("choice").is_null())
    return "\n" + Capitalised(document.at("why_no_choice").get<std::string>()) + ".\n";
  const ordered_json& best = document.at("sets").front();
  const ordered_json& simulation = best.at("simulation");
  return fmt::format(
      "\nWatch legs {}: simulated, the servo ends {:.2g} m and {:.2g} rad from the goal after {:.3g} s.\n",
      LegsOf(best), simulation.at("position_from_goal_m").get<double>(),
      simulation.at("rotation_from_goal_rad").get<double>(), simulation.at("time_s").get<double>());
}

}  // namespace

std::string LegsTable(const ordered_json& document) {
  return ChainsText(document) + SetsText(document) + ModesText(document) + PathText(document) +
         RobotModesText(document) + ChoiceText(document);
}

}  // namespace legible
