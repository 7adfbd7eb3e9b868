#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/option_checks.h"
#include "apps/option_values.h"
#include "apps/simulate_command.h"

namespace legible {
namespace {

constexpr char kDescription[] = "Write a session with its truth, or a simulated rig to play with";
constexpr char kFooter[] =
    R"(TRUTH.yaml is a simulated rig: a model.yaml, its section `simulation` says what else there is to it. Without
one a truth is drawn at random about a drawing: that of --robot, or of a hexapod of the size of a desk.

Written to the folder of --out, all together at the end:
  truth.yaml    the rig, for `--rig sim:DIR/truth.yaml` of the other commands
  robot.yaml, camera.yaml
                what the laboratory has on paper of it
and, unless --images is 0, a session in random poses:
  session.yaml, joints.csv, images/
                as `legible calibrate DIR` takes it
  truth.json    the truth with the pose of each image, to compare results with; no command reads it

Exit codes:
  0  written
  2  bad usage or bad input; one line says what; nothing is written

Examples:
  legible simulate --out my-simulation && legible calibrate my-simulation
  legible simulate --images 0 --seed 7 --out rig && legible capture --rig sim:rig/truth.yaml --out my-session
  legible simulate --robot robot.yaml --geometry-error 0.001 --width 640 --height 480 --out small)";

using Options = std::vector<CLI::Option*>;

void AddErrorOptions(CLI::App& command, SimulateSettings& settings, Options& drawn) {
  const auto add = [&](const std::string& name, const std::string& unit, double& value,
                       const std::string& description) {
    drawn.push_back(AddText(
        command, name, unit,
        [&value](const std::string& text) {
          value = ParseNumber(text);
          if (value < 0) throw std::invalid_argument(text + " is less than 0");
        },
        fmt::format("{}; {:g} without it", description, value)));
  };
  add("--geometry-error", "M", settings.geometry_error_m,
      "How far each coordinate of each joint may be off\nthe drawing");
  add("--offset-error", "M", settings.offset_error_m, "The same of each joint offset");
  add("--radius-error", "M", settings.radius_error_m, "The same of each radius");
  add("--camera-error", "PX", settings.camera_error_px, "By how much fx, fy, cx and cy are guessed wrongly");
  add("--camera-position-error", "M", settings.camera_position_error_m,
      "The same of each coordinate of its place");
  add("--camera-rotation-error", "RAD", settings.camera_rotation_error_rad,
      "The same of its rotation vector");
  add("--reading-noise", "M", settings.reading_noise_m, "Noise of a joint reading, 1 sigma");
}

void AddDrawingOptions(CLI::App& command, SimulateSettings& settings, Options& drawn) {
  drawn.push_back(command.add_option("--robot", settings.robot, "Drawing about which a truth is drawn")
                      ->type_name("FILE"));
  CLI::Option* camera =
      command
          .add_option("--camera", settings.camera,
                      "The true camera and, with camera_from_base, its\nplace; without it one of "
                      "1280 x 960 px before the\nrobot")
          ->type_name("FILE");
  drawn.push_back(camera);
  const auto add = [&](const std::string& name, std::optional<int>& pixels, const std::string& description) {
    drawn.push_back(command.add_option(name, pixels, description)
                        ->check(CLI::Range(64, 16384).description(""))
                        ->type_name("PX")
                        ->excludes(camera));
  };
  add("--width", settings.width_px, "Of the images, with the same field of view");
  add("--height", settings.height_px, "Three quarters of the width without it");
}

}  // namespace

const CLI::App* AddSimulateCommand(CLI::App& program, SimulateSettings& settings) {
  CLI::App* command = program.add_subcommand("simulate", kDescription)->group("Commands");
  command->footer(kFooter);
  CLI::Option* truth = command->add_option("TRUTH", settings.truth, "A simulated rig")->type_name("");
  command->add_option("--out", settings.out, "Folder for the results")
      ->required()
      ->check([](const std::string& text) { return text.empty() ? "name a folder" : std::string(); })
      ->type_name("DIR");
  command->add_option("--images", settings.images, "How many; 0: the rig only")
      ->check(WholeNumberFrom(0))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "Of everything that is random; 1 without it")
      ->check(WholeNumberFrom(0))
      ->type_name("N");
  AddKnownOption(
      *command, settings.known,
      "How well something is known beforehand (1 sigma), for\nsession.yaml, beside the noise of the "
      "readings and the\nradii. NAME=none: not at all.");
  Options drawn;
  AddDrawingOptions(*command, settings, drawn);
  AddErrorOptions(*command, settings, drawn);
  for (CLI::Option* option : drawn) option->excludes(truth);
  return command;
}

}  // namespace legible
