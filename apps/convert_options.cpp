#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/convert_command.h"
#include "apps/option_checks.h"
#include "apps/option_values.h"

namespace legible {
namespace {

constexpr char kDescription[] =
    "Write a camera or a robot as OpenCV, ROS, Kalibr, ViSP, mrcal or LinuxCNC read it";
constexpr char kFooter[] =
    R"(IN is a camera in any of these formats, recognised by its content, or a model.yaml, whose camera is taken; for
linuxcnc a model.yaml or a robot.yaml. A folder stands for what it holds: of a calibration model.yaml, of a session
the camera or the drawing that session.yaml names. Which file was taken is said.

  opencv    cv::FileStorage: YAML, or XML if FILE ends with .xml
  ros       camera_info YAML, legible's own camera.yaml
  kalibr    camchain YAML: pinhole with radtan (k1 k2 p1 p2) or equidistant
  visp      vpXmlParserCamera's XML: one radial coefficient kud and its inverse kdu; of a fisheye all four
  mrcal     .cameramodel: LENSMODEL_PINHOLE, _OPENCV5 or _OPENCV8
  linuxcnc  HAL lines for genhexkins, with HOME_OFFSET for the ini file in comments

A lens that the format does not have is fitted by its nearest one, focal lengths and principal point with it. How far
pixels then move, at most and rms over the image, is said; beyond --accept-error nothing is written. What else the
format has no place for is named as well.

Exit codes:
  0  written
  1  the format comes no nearer to the camera than --accept-error; says how near
  2  bad usage or bad input; one line says what; nothing is written

Examples:
  legible convert result --to opencv --out camera.yml
  legible convert camchain.yaml --to ros --out camera.yaml
  legible convert camera.yaml --to visp --accept-error 0.5 --out camera.xml
  legible convert result/model.yaml --to linuxcnc --unit inch --out hexapod.hal)";

}  // namespace

const CLI::App* AddConvertCommand(CLI::App& program, ConvertSettings& settings) {
  CLI::App* command = program.add_subcommand("convert", kDescription)->group("Commands");
  command->footer(kFooter);
  command->add_option("IN", settings.input, "A camera, a model or a folder with one")
      ->required()
      ->type_name("");
  AddText(
      *command, "--to", fmt::format("{}", fmt::join(ConvertTargets(), "|")),
      [&settings](const std::string& name) {
        DemandOneOf("--to", name, ConvertTargets());
        settings.to = name;
      },
      "Format to write")
      ->required();
  command->add_option("--out", settings.out, "File for it; standard output without it")
      ->check([](const std::string& text) { return text.empty() ? "name a file" : std::string(); })
      ->type_name("FILE");
  AddText(
      *command, "--accept-error", "PX",
      [&settings](const std::string& text) { settings.accepted_error_px = ParsePositive(text); },
      fmt::format("By how much a fitted lens may move a pixel; {:g}\nwithout it",
                  settings.accepted_error_px));
  AddText(
      *command, "--unit", "mm|inch",
      [&settings](const std::string& name) {
        DemandOneOf("--unit", name, {"mm", "inch"});
        settings.unit = name == "inch" ? LengthUnit::kInch : LengthUnit::kMillimetre;
      },
      "Of the machine, for linuxcnc; mm without it");
  command->parse_complete_callback([command, &settings] {
    const bool is_robot = settings.to == "linuxcnc";
    if (!is_robot && command->count("--unit") > 0)
      throw CLI::ValidationError("--unit", "belongs to --to linuxcnc");
    if (is_robot && command->count("--accept-error") > 0)
      throw CLI::ValidationError("--accept-error", "belongs to cameras, not to --to linuxcnc");
  });
  return command;
}

}  // namespace legible
