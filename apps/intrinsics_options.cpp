#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "apps/calibrate_settings.h"
#include "apps/intrinsics_command.h"
#include "apps/option_checks.h"
#include "apps/option_values.h"

namespace legible {
namespace {

constexpr char kDescription[] = "Calibrate a camera by images of a board of AprilTags or a chessboard";
constexpr char kFooter[] = R"(BOARD.yaml describes the board: Kalibr's target.yaml as it is, or one of
  board: tags         family: tag36h11, columns: 6, rows: 6, tag_size_m: 0.03, spacing_m: 0.009
  board: tags         family: tag36h11, tags: [{id: 0, corners_m: [[x, y] x 4]}, ...]
  board: chessboard   columns: 9, rows: 6 (inner corners), square_m: 0.025

Take twenty images or more, focus and zoom fixed as they will be used: the board in every part of the image, its
corners too, near enough to fill a third of it, and tilted by 30 to 45 degrees to all sides. A board of tags may stick
out of the image. The report says which view to add next.

Written to the folder of --out, all together at the end:
  camera.yaml       ROS camera_info with the covariance: name it in a session, and calibrate uses both
  intrinsics.json   the same for other programs, with residuals, uncertainty over the image, checks
  report.html       the same to look at

Exit codes:
  0  a camera was found
  1  no camera: too few views, or they leave it open; says why; nothing is written
  2  bad usage or bad input, images that contradict the board's file among them; one line says where and what to
     do; nothing is written

Examples:
  legible intrinsics images/*.png --board board.yaml
  legible intrinsics images --board target.yaml --lens fisheye --out wide --format json | jq .camera
  legible intrinsics --corners corners.csv --image-size 6016x4016 --board board.yaml --lens rational)";

// "640x480"
std::pair<int, int> ParseSize(const std::string& text) {
  const std::vector<std::string> parts = Split(text, 'x');
  if (parts.size() != 2 || !IsWholeNumber(parts[0]) || !IsWholeNumber(parts[1]) || std::stoi(parts[0]) < 1 ||
      std::stoi(parts[1]) < 1)
    throw std::invalid_argument("\"" + text + "\" is no size such as 1280x960");
  return {std::stoi(parts[0]), std::stoi(parts[1])};
}

std::vector<double> ParseDistances(const std::string& text) {
  std::vector<double> distances_m;
  for (const std::string& part : Split(text, ','))
    distances_m.push_back(part == "inf" ? std::numeric_limits<double>::infinity() : ParsePositive(part));
  return distances_m;
}

void AddInputOptions(CLI::App& command, IntrinsicsSettings& settings) {
  command.add_option("IMAGES", settings.images, "Images of the board, or folders of them")->type_name("");
  command.add_option("--board", settings.board, "The board")->required()->type_name("BOARD.yaml");
  command
      .add_option(
          "--corners", settings.corners,
          "Corners found elsewhere, instead of looking for\nthem: view,column,row,x_px,y_px (chessboard) "
          "or\nview,tag,corner,x_px,y_px, and weight or sigma_px\nif wanted")
      ->type_name("FILE.csv");
  AddText(
      command, "--image-size", "WxH",
      [&settings](const std::string& text) { settings.image_size_px = ParseSize(text); },
      "Of the images that the corners are from, in px");
  AddText(
      command, "--guess", "FILE|PX",
      [&settings](const std::string& text) {
        settings.guess = text;
        char* end = nullptr;
        std::strtod(text.c_str(), &end);
        if (end != text.c_str() && *end == '\0') settings.guessed_focal_length_px = ParsePositive(text);
      },
      "Focal length in px, or camera file of which that\ncounts, to start from as well; none is needed, "
      "and\none "
      "that is hopeless is refused");
}

void AddModelOptions(CLI::App& command, IntrinsicsSettings& settings) {
  command
      .add_option_function<std::string>(
          "--lens",
          [&settings](const std::string& name) {
            DemandOneOf("--lens", name, LensNames());
            settings.lens = LensFromName(name).value();
          },
          "Lens model: 0, 4, 5 or 8 coefficients;\nbrown-conrady without it")
      ->type_name(fmt::format("{}", fmt::join(LensNames(), "|")));
  AddBoardFitOptions(command, settings.board_fit);
}

}  // namespace

std::string OptionsText(const IntrinsicsSettings& settings) {
  std::vector<std::string> words;
  if (settings.lens != LensModel::kBrownConrady) words.push_back("--lens " + LensName(settings.lens));
  for (const std::string& word : OptionWords(settings.board_fit)) words.push_back(word);
  if (settings.guess) words.push_back("--guess " + *settings.guess);
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, " "));
}

const CLI::App* AddIntrinsicsCommand(CLI::App& program, IntrinsicsSettings& settings) {
  CLI::App* command = program.add_subcommand("intrinsics", kDescription)->group("Commands");
  command->footer(kFooter);
  AddInputOptions(*command, settings);
  AddModelOptions(*command, settings);
  command->add_option("--out", settings.out, "Folder for the results")
      ->check([](const std::string& text) { return text.empty() ? "name a folder" : std::string(); })
      ->type_name("DIR")
      ->default_str(settings.out.string());
  AddText(
      *command, "--distances", "M,...",
      [&settings](const std::string& text) { settings.distances_m = ParseDistances(text); },
      "At which the uncertainty over the image is told;\ninf is one. Without it the boards' distance, three\n"
      "times that, and inf");
  AddTableOrJson(*command, settings.prints_json,
                 "What goes to standard output: a summary for\npeople, or the text of intrinsics.json");
  command->add_flag_callback(
      "--no-pictures", [&settings] { settings.embeds_pictures = false; },
      "Leave the images out of report.html");
  AddThreadsOption(*command, settings.threads);
  return command;
}

}  // namespace legible
