#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/calibrate_command.h"
#include "apps/option_checks.h"

namespace legible {
namespace {

constexpr char kDescription[] =
    "Calibrate a hexapod and its camera from images of the legs and joint readings";
constexpr char kFooter[] = R"(A session is a folder with
  session.yaml   names the other files, and says how well what is known beforehand
  robot.yaml     the drawing: base and platform joints, radii, joint offsets and ranges
  camera.yaml    a first guess of the camera (ROS camera_info; fx to some 5 %), and where it stands
                 (camera_from_base, by tape measure), unless tags on the base say that
  joints.csv     image,q1_m,...,q6_m: the joint readings of each image
  images/        some forty images in clearly different poses, the camera not moved in between
  tags.yaml      optional: AprilTags on the base or the platform; they check the result, and with --tags
                 take part in it

Written to the folder of --out, all together at the end:
  model.yaml         the calibrated robot and camera with their covariance, for the other commands
  calibration.json   the same for other programs: values, sigmas, residuals, what is not determined
  report.html        the same to look at, with found and predicted edges over each image

Exit codes:
  0  a model was found
  1  no model: the data leave something open or the estimate did not converge; says why, and writes
     calibration.json and report.html with what is known
  2  bad usage or bad input; one line says where and what to do; nothing is written

Examples:
  legible calibrate datasets/hexapod
  legible calibrate my-session --out result --known radius_m=2e-5 --hold principal-point
  legible calibrate my-session --with-board board-images --board board.yaml
  legible calibrate my-session --format json | jq .held_out.rms_px)";

void AddOutputOptions(CLI::App& command, CalibrateSettings& settings) {
  command.add_option("--out", settings.out, "Folder for the results")
      ->check([](const std::string& text) { return text.empty() ? "name a folder" : std::string(); })
      ->type_name("DIR")
      ->default_str(settings.out.string());
  AddTableOrJson(command, settings.prints_json,
                 "What goes to standard output: a table for\npeople, or the text of calibration.json");
  command.add_flag_callback(
      "--no-pictures", [&settings] { settings.embeds_pictures = false; },
      "Leave the images out of report.html");
}

void AddModelOptions(CLI::App& command, CalibrateSettings& settings) {
  command
      .add_option_function<std::string>(
          "--lens",
          [&settings](const std::string& name) {
            DemandOneOf("--lens", name, LensNames());
            settings.lens = LensFromName(name);
          },
          "Lens model to estimate, with 0, 5, 8 or 4 coefficients;\nwithout it that of camera.yaml")
      ->type_name(fmt::format("{}", fmt::join(LensNames(), "|")));
  command
      .add_option_function<std::vector<std::string>>(
          "--hold",
          [&settings](const std::vector<std::string>& names) {
            for (const std::string& name : names) DemandOneOf("--hold", name, HoldNames());
            settings.hold = names;
          },
          fmt::format("Keep as the session's files have it; comma\nseparated or repeated. Names:\n{}",
                      fmt::join(HoldNames(), "\n")))
      ->type_name("NAME")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void AddKnowledgeOptions(CLI::App& command, CalibrateSettings& settings) {
  AddKnownOption(command, settings.known,
                 "How well something is known beforehand (1 sigma),\nover what session.yaml says; "
                 "NAME=none: not at all.");
  command
      .add_option("--tags", settings.tags,
                  "Tag groups of tags.yaml whose corners count as\nobservations, or all; without it they "
                  "only place\nthe camera at first and check the result. Comma\nseparated or repeated")
      ->type_name("GROUP")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_flag_callback(
      "--no-readings", [&settings] { settings.use_readings = false; },
      "Leave the joint readings out of the estimate (they\nstill say where to look for the legs). Where "
      "nothing\nknown, held or shown by --tags then sets a scale,\nas with --free-legs");
  command.add_flag("--free-legs", settings.free_legs,
                   "Edges only: no readings, no rigid platform (each\nleg's direction is free in each "
                   "image), and nothing\nknown beforehand but by --known and --tags");
}

void AddBoardOptions(CLI::App& command, CalibrateSettings& settings) {
  CLI::Option* images =
      command
          .add_option(
              "--with-board", settings.board_images,
              "Images of a calibration board by the same camera, or\nfolders of them, solved together "
              "with the legs; what\ncamera.yaml says of how well it is known is left out")
          ->type_name("IMAGES");
  command.add_option("--board", settings.board, "The board that they show; see legible intrinsics")
      ->type_name("BOARD.yaml")
      ->needs(images);
  images->needs("--board");
  for (CLI::Option* option : AddBoardFitOptions(command, settings.board_fit)) option->needs(images);
}

void AddWorkOptions(CLI::App& command, CalibrateSettings& settings) {
  command
      .add_option("--folds", settings.folds,
                  "Images are held out in so many turns to check\nthe model; 0: not at all")
      ->check([](const std::string& text) {
        return IsWholeNumber(text) && std::stoi(text) != 1 ? std::string()
                                                           : "give 0, or a whole number from 2";
      })
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option(
          "--seed", settings.seed,
          "Draw at random, from this seed, which images are\nheld out together; without it nothing is random")
      ->check(WholeNumberFrom(0))
      ->type_name("N");
  AddThreadsOption(command, settings.threads);
}

}  // namespace

const CLI::App* AddCalibrateCommand(CLI::App& program, CalibrateSettings& settings) {
  CLI::App* command = program.add_subcommand("calibrate", kDescription)->group("Commands");
  command->footer(kFooter);
  command->add_option("SESSION", settings.session, "Folder of the session")->required()->type_name("");
  AddOutputOptions(*command, settings);
  AddModelOptions(*command, settings);
  AddKnowledgeOptions(*command, settings);
  AddBoardOptions(*command, settings);
  AddWorkOptions(*command, settings);
  return command;
}

}  // namespace legible
