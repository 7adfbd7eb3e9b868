#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <thread>

#include "apps/accuracy_command.h"
#include "apps/option_checks.h"
#include "apps/option_values.h"

namespace legible {
namespace {

constexpr char kDescription[] =
    "Say how far off a robot can be: maximal errors, indices, where errors come from";
constexpr char kFooter[] =
    R"(Everything that goes in is in metres, radians and pixels. MODEL is the model.yaml of `legible calibrate`, or a
robot.yaml: then nothing is known of how well the geometry is known, unless --geometry-error says it.

For each pose: the largest errors that joint errors within their bounds can add up to (Merlet 2006), along each
axis of the base and in any direction; the polyhedron of all such errors; where they come from (joints, geometry,
vision), as bounds and as 95 % values; every index in use, and whether it orders the poses as their errors do.
Without a pose it is the robot's home.

Exit codes:
  0  some pose has errors
  1  none has: all are singular; says so, and writes what it knows
  2  bad usage or bad input, no pose that the robot can reach; one line says what; nothing is written

Examples:
  legible accuracy datasets/merlet-gough/robot.yaml --poses datasets/merlet-gough/poses.csv
  legible accuracy result/model.yaml --pose "0 0 0.35 0 0 0.1" --joint-error 2e-5 --edge-noise 0.1
  legible accuracy result/model.yaml --session my-session --format csv --out errors.csv
  legible accuracy result/model.yaml --box reachable,rz=-0.1:0.1 --samples 1000000
  legible accuracy result/model.yaml --format html --out accuracy.html)";

void AddPoseOptions(CLI::App& command, AccuracySettings& settings) {
  AddText(
      command, "--pose", "\"X Y Z RX RY RZ\"",
      [&settings](const std::string& text) { settings.poses.push_back(ParsePose(text)); },
      "A pose of the platform in base, m and rad;\nmay be repeated")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->trigger_on_parse();
  command
      .add_option("--poses", settings.poses_file,
                  "Poses from a file: columns x,y,z,rx,ry,rz and, if\nwished, name")
      ->type_name("FILE.csv");
  command
      .add_option(
          "--session", settings.session,
          "The poses of a session's images, from their joint\nreadings by forward kinematics of MODEL")
      ->type_name("DIR");
  AddText(
      command, "--euler", "NAME",
      [&settings](const std::string& name) {
        const auto convention = OrientationConvention::FromName(name);
        if (!convention || convention->IsRotationVector())
          throw std::invalid_argument("\"" + name + "\" is no order of axes: give ZYX, XYZ, ZXZ, xyz, ...");
        settings.orientation = *convention;
      },
      "RX RY RZ are Euler angles: about axes that turn\nwith the platform in capitals (ZYX: yaw, "
      "pitch,\nroll), about "
      "axes of the base in small letters;\nwithout it a rotation vector");
}

void AddErrorOptions(CLI::App& command, AccuracySettings& settings) {
  AddText(
      command, "--joint-error", "M[,M...]",
      [&settings](const std::string& text) { settings.joint_error_m = ParseJointErrors(text); },
      "Largest error of a joint reading, m: one for all, or\none for each leg; 1e-4 without it");
  AddText(
      command, "--geometry-error", "M",
      [&settings](const std::string& text) { settings.geometry_error_m = ParseLengthError(text); },
      "Largest error of each coordinate of each joint and of\neach offset, m; without it the covariance of "
      "MODEL");
  AddText(
      command, "--edge-noise", "PX",
      [&settings](const std::string& text) { settings.edge_noise_px = ParsePositive(text); },
      "Errors of vision too: 1 sigma of where an edge is seen\nat each of its ends, px; MODEL must have a "
      "camera");
  AddText(
      command, "--legs", "N,N,...",
      [&settings, is_first = true](const std::string& text) mutable {
        if (is_first) settings.leg_sets.clear();
        is_first = false;
        settings.leg_sets.push_back(ParseLegs(text));
      },
      "Legs whose edges are seen, counted from 1; repeat it\nto compare sets; all without it")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->trigger_on_parse()
      ->needs("--edge-noise");
  AddText(
      command, "--characteristic-length", "M",
      [&settings](const std::string& text) { settings.characteristic_length_m = ParsePositive(text); },
      "Length for normalised condition numbers, m; without it\nthe natural length, which minimises each");
}

void AddWorkspaceOptions(CLI::App& command, AccuracySettings& settings) {
  AddText(
      command, "--box", "NAME=LOW:HIGH,...",
      [&settings](const std::string& text) { settings.box = ParseBox(text); },
      "Statistics over a workspace: ranges of x y z rx ry rz\n(m, rad; uniform in these coordinates). What "
      "is not "
      "named\nstays as in the first pose; \"reachable\": x y z wherever\nthe joint ranges allow");
  command
      .add_flag("--within-joint-ranges", settings.within_joint_ranges,
                "Of the box only poses that the joint ranges allow\n(\"reachable\" implies it)")
      ->needs("--box");
  AddText(
      command, "--sampling", "sobol|monte-carlo|grid|gauss",
      [&settings](const std::string& name) {
        for (const auto rule :
             {SamplingRule::kSobol, SamplingRule::kMonteCarlo, SamplingRule::kGrid, SamplingRule::kGauss})
          if (name == ToString(rule)) {
            settings.sampling.rule = rule;
            return;
          }
        throw std::invalid_argument("\"" + name + "\" is none of sobol, monte-carlo, grid, gauss");
      },
      "How the box is sampled; sobol without it");
  command.add_option("--samples", settings.sampling.samples, "How many poses of the box in all, at least")
      ->check(WholeNumberFrom(kReplicates))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", settings.sampling.seed, "Of what is drawn at random")
      ->check(WholeNumberFrom(0))
      ->type_name("N")
      ->capture_default_str();
  AddThreadsOption(command, settings.threads);
}

void AddUnit(CLI::App& command, const std::string& name, const std::vector<OutputUnit>& units,
             std::optional<std::string>& unit, const std::string& description) {
  std::vector<std::string> names(units.size());
  std::transform(units.begin(), units.end(), names.begin(), [](const OutputUnit& one) { return one.name; });
  command
      .add_option_function<std::string>(
          name,
          [name, names, &unit](const std::string& text) {
            DemandOneOf(name, text, names);
            unit = text;
          },
          description)
      ->type_name(fmt::format("{}", fmt::join(names, "|")));
}

void AddOutputOptions(CLI::App& command, AccuracySettings& settings) {
  AddUnit(command, "--length-unit", LengthUnits(), settings.length_unit,
          "Unit of lengths in the output; without it mm in tables\nand pages, m for programs");
  AddUnit(command, "--angle-unit", AngleUnits(), settings.angle_unit,
          "Unit of errors of rotation in the output (indices are\nalways per radian); without it deg in "
          "tables and\n"
          "pages, rad for programs");
  AddFormat(
      command, {"table", "json", "csv", "html"},  // in the order of the enum
      [&settings](size_t format) { settings.format = static_cast<AccuracyFormat>(format); },
      "A table for people, one JSON document, a row a pose\nfor spreadsheets, or a page to look at");
  command.add_option("--out", settings.out, "File for the result instead of standard output")
      ->check([](const std::string& text) { return text.empty() ? "name a file" : std::string(); })
      ->type_name("FILE");
}

}  // namespace

const CLI::App* AddAccuracyCommand(CLI::App& program, AccuracySettings& settings) {
  CLI::App* command = program.add_subcommand("accuracy", kDescription)->group("Commands");
  command->footer(kFooter);
  command->add_option("MODEL", settings.model, "model.yaml or robot.yaml")->required()->type_name("");
  AddPoseOptions(*command, settings);
  AddErrorOptions(*command, settings);
  AddWorkspaceOptions(*command, settings);
  AddOutputOptions(*command, settings);
  return command;
}

}  // namespace legible
