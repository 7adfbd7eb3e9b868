#include "apps/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/accuracy_command.h"
#include "apps/calibrate_command.h"
#include "apps/capture_command.h"
#include "apps/convert_command.h"
#include "apps/intrinsics_command.h"
#include "apps/legs_command.h"
#include "apps/replay_command.h"
#include "apps/servo_command.h"
#include "apps/simulate_command.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr char kDescription[] =
    "Calibrates parallel robots by the edges of their legs, seen by one fixed camera, and says how accurate "
    "they are.";
constexpr char kFooter[] =
    R"(Exit codes: 0 success; 1 no usable result, or nowhere to print it; 2 bad usage or bad input.
`legible COMMAND --help` explains a command.)";

// The command line as far as it could be understood: "legible calibrate".
std::string CommandOf(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app.get_name() : app.get_name() + " " + commands.front()->get_name();
}

// "unknown option --ot", "unknown command bogus" or "unexpected argument b".
std::string WhatIsUnexpected(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  const auto option =
      std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.starts_with('-'); });
  if (option != words.end()) return "unknown option " + *option;
  return (app.get_subcommands().empty() ? "unknown command " : "unexpected argument ") + words.front();
}

int ReportUsageError(const CLI::App& app, const CLI::ParseError& error, std::ostream& err) {
  const bool is_unexpected = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                             (app.get_subcommands().empty() && app.remaining_size(true) > 0);
  std::string what = is_unexpected ? WhatIsUnexpected(app) : error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  err << "legible: " << what << "; see `" << CommandOf(app) << " --help`\n";
  return kExitBadInput;
}

int ParseAndRun(CLI::App& app, std::vector<std::string> arguments, const Console& console) {
  IntrinsicsSettings intrinsics;
  const CLI::App* intrinsics_command = AddIntrinsicsCommand(app, intrinsics);
  CalibrateSettings calibrate;
  const CLI::App* calibrate_command = AddCalibrateCommand(app, calibrate);
  AccuracySettings accuracy;
  const CLI::App* accuracy_command = AddAccuracyCommand(app, accuracy);
  LegsSettings legs;
  const CLI::App* legs_command = AddLegsCommand(app, legs);
  ServoSettings servo;
  const CLI::App* servo_command = AddServoCommand(app, servo);
  ReplaySettings replay;
  const CLI::App* replay_command = AddReplayCommand(app, replay);
  CaptureSettings capture;
  const CLI::App* capture_command = AddCaptureCommand(app, capture);
  SimulateSettings simulate;
  const CLI::App* simulate_command = AddSimulateCommand(app, simulate);
  ConvertSettings convert;
  const CLI::App* convert_command = AddConvertCommand(app, convert);
  try {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app.parse(std::move(arguments));
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version, console.out, console.err);
  } catch (const CLI::ParseError& error) {
    return ReportUsageError(app, error, console.err);
  }
  if (intrinsics_command->parsed()) return RunIntrinsics(intrinsics, console);
  if (calibrate_command->parsed()) return RunCalibrate(calibrate, console);
  if (accuracy_command->parsed()) return RunAccuracy(accuracy, console);
  if (legs_command->parsed()) return RunLegs(legs, console);
  if (capture_command->parsed()) return RunCapture(capture, console);
  if (simulate_command->parsed()) return RunSimulate(simulate, console);
  if (convert_command->parsed()) return RunConvert(convert, console);
  if (servo_command->parsed()) return RunServoCommand(servo, console);
  return replay_command->parsed() ? RunReplay(replay, console) : kExitBadInput;
}

}  // namespace

const char* ProgramVersion() { return LEGIBLE_VERSION; }

int RunProgram(const std::vector<std::string>& arguments, const Console& console) {
  CLI::App app(kDescription, "legible");
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("legible ") + ProgramVersion(), "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  try {
    const int code = ParseAndRun(app, arguments, console);
    if (console.out.flush()) return code;
    console.err << "legible: standard output cannot be written\n";
    return std::max(code, kExitNoResult);
  } catch (const InputError& error) {
    console.err << "legible: " << error.what() << "\n";
    return kExitBadInput;
  } catch (const std::exception& error) {
    console.err << "legible: the computation failed: " << error.what() << "\n";
    return kExitNoResult;
  }
}

}  // namespace legible
