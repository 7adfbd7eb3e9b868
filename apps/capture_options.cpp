#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/capture_command.h"
#include "apps/option_checks.h"
#include "apps/option_values.h"

namespace legible {
namespace {

constexpr char kDescription[] = "Hold a calibration session with a rig: drive, wait, take image and readings";
constexpr char kFooter[] =
    R"(The robot is driven by what is on paper: --robot is its drawing, --camera a first guess of the camera and of
where it stands (camera_from_base). A simulated rig's truth may name both, as `drawing` in its section
`simulation`. They become the session's own robot.yaml and camera.yaml.

Without --poses each pose is proposed from what has been seen so far: the one in reach and in sight from which
the poses that the calibrated model will predict gain most. After each image a line says how many of the
twelve edges it showed, and what uncertainty of predicted poses a calibration would state by now. Such a
session needs about half the images that random poses need.

In each pose the robot comes to rest before the image is taken; the readings are those of the same moment. A
pose that cannot be reached, or shows nothing of use, is passed over, with its reason.

The session grows on the disk: killed at any moment it holds every image that was there, and --resume goes on
with it. Ctrl-C stops the robot and ends in order.

Exit codes:
  0  the session holds what was asked for: --count or --until is reached, or every pose of --poses is taken
  1  it ended before; says why; what has been taken stays
  2  bad usage or bad input; one line says what; nothing has moved, nothing is written

Examples:
  legible simulate --images 0 --out rig
  legible capture --rig sim:rig/truth.yaml --count 24 --out my-session
  legible capture --rig sim:rig/truth.yaml --until 5e-5 --out my-session --resume
  legible capture --rig sim:rig/truth.yaml --poses poses.csv --known radius_m=5e-5 --out my-session
  legible calibrate my-session)";

void AddRigOptions(CLI::App& command, CaptureSettings& settings) {
  command.add_option("--rig", settings.rig, "The robot: sim:TRUTH, a simulated one, TRUTH its\nmodel.yaml")
      ->required()
      ->type_name("sim:TRUTH");
  command
      .add_option("--robot", settings.robot, "Drawing of the robot; without it the one that the\nrig names")
      ->type_name("FILE");
  command
      .add_option("--camera", settings.camera,
                  "First guess of the camera, with camera_from_base;\nwithout it the one that the rig names")
      ->type_name("FILE");
  AddKnownOption(
      command, settings.known,
      "How well something is known beforehand (1 sigma), for\nsession.yaml; the noise of the readings "
      "by the rig's data\nsheet is known unless given. NAME=none: not at all.");
  AddText(
      command, "--speed-limit", "M/S",
      [&settings](const std::string& text) { settings.speed_limit_m_per_s = ParsePositive(text); },
      fmt::format("No joint goes faster, m/s; {:g} without it", settings.speed_limit_m_per_s));
}

void AddPoseOptions(CLI::App& command, CaptureSettings& settings) {
  CLI::Option* poses =
      command
          .add_option(
              "--poses", settings.poses,
              "poses.csv: the platform's poses in base, m and\nrotation vectors in rad; images have their "
              "names")
          ->type_name("FILE");
  command
      .add_option("--count", settings.count,
                  fmt::format("Images that the session shall have; {} without it", kUsualImages))
      ->check(WholeNumberFrom(1))
      ->type_name("N")
      ->excludes(poses);
  AddText(
      command, "--until", "SIGMA",
      [&settings](const std::string& text) { settings.until_m = ParsePositive(text); },
      "Ends when the position of a predicted pose is expected\nto be known to this sigma, m");
  command.add_option("--seed", settings.seed, "Of the poses among which proposals are chosen; 1\nwithout it")
      ->check(WholeNumberFrom(0))
      ->type_name("N");
}

void AddOutputOptions(CLI::App& command, CaptureSettings& settings) {
  command.add_option("--out", settings.out, "Folder of the session, a new one unless with --resume")
      ->required()
      ->check([](const std::string& text) { return text.empty() ? "name a folder" : std::string(); })
      ->type_name("SESSION");
  command.add_flag("--resume", settings.resumes, "Go on with the session there, if there is one");
  AddTableOrJson(
      command, settings.prints_json,
      "What goes to standard output: lines for people, or\nJSON with every image and what it was worth");
}

}  // namespace

const CLI::App* AddCaptureCommand(CLI::App& program, CaptureSettings& settings) {
  CLI::App* command = program.add_subcommand("capture", kDescription)->group("Commands");
  command->footer(kFooter);
  AddRigOptions(*command, settings);
  AddPoseOptions(*command, settings);
  AddOutputOptions(*command, settings);
  AddThreadsOption(*command, settings.threads);
  return command;
}

}  // namespace legible
