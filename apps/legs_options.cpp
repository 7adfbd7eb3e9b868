#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "apps/legs_command.h"
#include "apps/legs_map.h"
#include "apps/option_checks.h"
#include "apps/option_values.h"
#include "core/geometry/orientation.h"

namespace legible {
namespace {

constexpr int kMostLegs = 99;
constexpr double kMostNoise_deg = 20;  // what errors in first order mean nothing beyond
constexpr std::array<double, 2> kGains_per_s = {1e-3, 1e3};
constexpr char kDescription[] = "Say which legs to watch on a way, and what a servo may end in instead";
constexpr char kFooter[] =
    R"(A servo of leg directions controls a robot hidden in its law (Briot et al. 2016): that whose actuated joints are the
directions of the seen legs. It has assembly modes and singularities of its own. For every set of legs:

  hidden robot    its legs, and whether the directions of the set hold the platform at all; if not, whether the lines
                  themselves (their edges: direction and position) do
  other modes     every pose other than the goal at which all seen legs point as they do there; proved to be all
                  but where "or more" says that others are not excluded
  aspect          whether a singularity lies between start and goal, proved along the whole straight way, or along the
                  servo's own where the straight one passes a singularity
  largest error   of the platform at the goal and on the way, when each seen direction is off by up to --noise

Every set that a singularity does not keep from the goal is simulated: an aspect can hold several of its modes. Of those
that arrive, within the joint ranges and in sight all the way, that with the smallest error is the one to watch.

Of a robot with more than 8 legs, name the sets with --legs.

MODEL is a model.yaml, whose camera says which legs show, or a robot.yaml of any family.

Exit codes:
  0  some set of legs leads to the goal
  1  none does; says why
  2  bad usage or bad input, a pose that the robot cannot take; one line says what; nothing is written

Examples:
  legible legs datasets/robots/quattro.yaml --from "0 0 -0.75 0 0 0" --to "-0.2 0 -0.56 0 0 0"
  legible legs result/model.yaml --to "0.02 0.01 0.33 0 0 0.6" --noise 0.05
  legible legs datasets/robots/quattro.yaml --to "-0.2 0 -0.56 0 0 0" --legs 1,4 --legs 2,3 --format json
  legible legs result/model.yaml --to "0.02 0.01 0.33 0 0 0.6" --format html --out legs.html)";

void AddPose(CLI::App& command, const std::string& name, std::optional<Vector6d>& pose,
             const std::string& description) {
  AddText(
      command, name, "\"X Y Z RX RY RZ\"", [&pose](const std::string& text) { pose = ParsePose(text); },
      description);
}

double ParseNoise_rad(const std::string& text) {
  const double noise_deg = ParsePositive(text);
  if (noise_deg > kMostNoise_deg)
    throw std::invalid_argument(
        fmt::format("{} is more than {} degrees: errors are those of first order", text, kMostNoise_deg));
  return noise_deg * kDegree_rad;
}

double ParseGain_per_s(const std::string& text) {
  const double gain_per_s = ParsePositive(text);
  if (gain_per_s < kGains_per_s[0] || gain_per_s > kGains_per_s[1])
    throw std::invalid_argument(
        fmt::format("{} is not from {} to {} per second", text, kGains_per_s[0], kGains_per_s[1]));
  return gain_per_s;
}

// A set in any order is the same set, judged once.
void AddSet(std::vector<int> legs, std::vector<std::vector<int>>& sets) {
  std::sort(legs.begin(), legs.end());
  if (std::find(sets.begin(), sets.end(), legs) == sets.end()) sets.push_back(legs);
}

}  // namespace

const CLI::App* AddLegsCommand(CLI::App& program, LegsSettings& settings) {
  CLI::App* command = program.add_subcommand("legs", kDescription)->group("Commands");
  command->footer(kFooter);
  command->add_option("MODEL", settings.model, "The robot: a model.yaml or a robot.yaml")
      ->required()
      ->type_name("");
  AddPose(*command, "--from", settings.from,
          "Pose of the platform at the start, m and rad; the\nrobot's home without it");
  AddPose(*command, "--to", settings.to, "Pose at the goal; the robot's home without it");
  AddText(
      *command, "--legs", "N,N,...",
      [&settings](const std::string& text) { AddSet(ParseLegs(text, kMostLegs), settings.leg_sets); },
      "A set of legs to judge; may be repeated; every set\nwithout it")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->trigger_on_parse();
  AddText(
      *command, "--noise", "DEG",
      [&settings](const std::string& text) { settings.noise_rad = ParseNoise_rad(text); },
      fmt::format("By how much each seen direction may be off, degrees, up\nto {:g}; {:.3g} without it",
                  kMostNoise_deg, settings.noise_rad / kDegree_rad));
  AddText(
      *command, "--gain", "PER_S",
      [&settings](const std::string& text) { settings.gain_per_s = ParseGain_per_s(text); },
      fmt::format("Of the simulated servo, {:g} to {:g}; {:g} without it", kGains_per_s[0], kGains_per_s[1],
                  settings.gain_per_s));
  AddText(
      *command, "--map", "NAME=LOW:HIGH,NAME=LOW:HIGH",
      [&settings](const std::string& text) { settings.map = ParseMap(text); },
      "Singularities and largest errors over two coordinates\nof x y z rx ry rz (m, rad), the others as at "
      "the goal,\n"
      "of the sets of --legs or of the best six that lead to\nthe goal; only with --format json or html");
  AddFormat(
      *command, {"table", "json", "html"},  // in the order of the enum
      [&settings](size_t format) { settings.format = static_cast<LegsFormat>(format); },
      "A table to read, all numbers as JSON, or a page to look\nat");
  command->add_option("--out", settings.out, "File for it; standard output without it")
      ->check([](const std::string& text) { return text.empty() ? "name a file" : std::string(); })
      ->type_name("FILE");
  command->parse_complete_callback([&settings] {
    if (settings.map && settings.format == LegsFormat::kTable)
      throw CLI::ValidationError("--map", "is no table: give --format json or html");
  });
  return command;
}

}  // namespace legible
