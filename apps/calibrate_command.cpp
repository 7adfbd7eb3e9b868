#include "apps/calibrate_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/calibration_json.h"
#include "apps/calibration_report.h"
#include "apps/calibration_run.h"
#include "apps/console_summary.h"
#include "apps/json_text.h"
#include "apps/judgement.h"
#include "apps/output_folder.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report_images.h"
#include "apps/report_page.h"
#include "apps/wording.h"
#include "core/stopwatch.h"
#include "core/vision/gray_image.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"
#include "datasets/session_file.h"

namespace legible {
namespace {

const std::vector<std::string> kResultFiles = {"model.yaml", "calibration.json", "report.html"};

// What no estimation is needed for to see that it cannot start.
void DemandPlaceOfCamera(const Session& session) {
  if (session.camera_from_base) return;
  if (session.tags)
    for (const TagGroup& group : session.tags->groups)
      if (group.carrier == TagCarrier::kBase) return;
  const std::filesystem::path& camera_yaml = session.files.at(2);
  throw InputError(camera_yaml, 0,
                   "does not say where the camera is, and the session names no tags on the base",
                   "give camera_from_base (a tape measure will do), or tags on the base");
}

// What is said of the camera beside a board would count twice.
void DemandCameraToldOnce(const CalibrateSettings& settings, const Session& session) {
  const PriorKnowledge& known = session.known;
  const bool has_board = settings.board || known.camera_information.size() > 0;
  const bool says_more = known.focal_length_px || known.principal_point_px || known.distortion;
  if (has_board && says_more)
    throw InputError(session.files.at(0), 0,
                     "or --known says how well the camera is known, and so does a board",
                     "take focal_length_px, principal_point_px and distortion out, or the board");
}

// What a board told of one lens says nothing of another's coefficients.
void DemandLensOfBoard(const CalibrateSettings& settings, const Session& session) {
  if (session.known.camera_information.size() == 0 || !settings.lens || *settings.lens == session.camera.lens)
    return;
  throw InputError(session.files.at(2), 0,
                   fmt::format("has the information of a board on the {} lens, and --lens says {}",
                               LensName(session.camera.lens), LensName(*settings.lens)),
                   "leave --lens out, or forget the board with --known camera=none");
}

InputError CannotBeUsed(const Session& session, const SessionImage& image,
                        const std::optional<GrayImage>& pixels) {
  const Camera& camera = session.camera;
  const std::string others = session.images.size() > 1 ? ", and no other image can be used either" : "";
  if (!pixels)
    return InputError(image.file, 0, "is not an image, or damaged" + others,
                      "give images that can be opened");
  return InputError(image.file, 0,
                    fmt::format("is {} x {} px, where {} says {} x {}{}", pixels->width, pixels->height,
                                session.files.at(2).string(), camera.width_px, camera.height_px, others),
                    "give the camera of these images, or images of this camera");
}

// Throws for the first image if none at all can be used; an image among others is left out instead.
void DemandSomeImage(const Session& session) {
  std::optional<InputError> first_error;
  for (const SessionImage& image : session.images) {
    const std::optional<GrayImage> pixels = ReadGrayImage(image.file);
    if (pixels && pixels->width == session.camera.width_px && pixels->height == session.camera.height_px)
      return;
    if (!first_error) first_error = CannotBeUsed(session, image, pixels);
  }
  if (first_error) throw *first_error;
}

// The camera as the board has it is where the legs' estimate begins; together both tell more.
void AddBoard(CalibrationRun& run, ProgressLine& progress) {
  const CalibrateSettings& settings = run.settings;
  IntrinsicsSettings board;
  board.images = settings.board_images;
  board.board = *settings.board;
  board.lens = settings.lens.value_or(run.session.camera.lens);
  board.board_fit = settings.board_fit;
  board.threads = settings.threads;
  run.board = LoadViews(board, progress);
  const BoardCalibrationInput& input = run.board->input;
  Camera& camera = run.session.camera;
  if (input.width_px != camera.width_px || input.height_px != camera.height_px)
    throw InputError(input.views.front().file, 0,
                     fmt::format("is {} x {} px, and the session's camera has {} x {}", input.width_px,
                                 input.height_px, camera.width_px, camera.height_px),
                     "give board images of the same camera, at the same resolution");
  Calibrate(*run.board, progress);
  if (run.board->result.status != BoardCalibrationStatus::kConverged)
    throw InputError(*settings.board, 0, "leads to no camera: " + run.board->result.message,
                     "see what legible intrinsics says of these images");
  camera = run.board->result.camera;
  run.session.known.camera_information.resize(0, 0);
  run.options.board = SolvedProblem(input, run.board->result, run.board->options);
}

CalibrationRun Load(const CalibrateSettings& settings, ProgressLine& progress) {
  CalibrationRun run;
  run.settings = settings;
  run.session = ReadSession(settings.session);
  DemandPlaceOfCamera(run.session);
  DemandSomeImage(run.session);
  run.session.known = WithSettings(run.session.known, settings);
  DemandLensOfBoard(settings, run.session);
  DemandCameraToldOnce(settings, run.session);
  try {
    run.options = ToOptions(settings, run.session);
  } catch (const std::invalid_argument& error) {
    throw InputError(run.session.folder, 0, "cannot be calibrated with these --tags", error.what());
  }
  if (settings.board) AddBoard(run, progress);
  run.content_hash =
      ContentHash(run.session, run.board ? run.board->files : std::vector<std::filesystem::path>{});
  return run;
}

void ShowProgressOn(ProgressLine& line, SessionCalibrationOptions& options) {
  options.progress = [&line](const std::string& stage, int done, int total) {
    line.Show(StageText(stage, done, total));
  };
  options.estimation.progress = [&line](int iteration, double rms_px) {
    line.Show(IterationText(iteration, rms_px));
  };
}

// What the library finds wrong with a session only once it is at work is bad input all the same.
SessionCalibration Calibrate(const CalibrationRun& run) try {
  return CalibrateSession(run.session, run.options);
} catch (const std::invalid_argument& error) {
  throw InputError(run.settings.session, 0, "cannot be calibrated", error.what());
}

CalibratedModel ModelOf(const CalibrationRun& run) {
  CalibratedModel model = ToModel(run.result.calibration);
  model.provenance = {{"session", SessionPath(run)},
                      {"content_hash", run.content_hash},
                      {"program_version", ProgramVersion()},
                      {"options", OptionsText(run.settings)}};
  return model;
}

void Write(const CalibrationRun& run, const std::string& json, const std::string& page) {
  WriteTogether(run.settings.out, kResultFiles, [&](const std::filesystem::path& folder) {
    if (run.result.calibration.status == CalibrationStatus::kConverged)
      WriteModel(folder / "model.yaml", ModelOf(run));
    WriteFileAtomically(folder / "calibration.json", json);
    WriteFileAtomically(folder / "report.html", page);
  });
}

void Print(const CalibrationRun& run, const FoundParameters& found, const std::vector<std::string>& warnings,
           const std::string& json, const Console& console) {
  console.err << WarningsText(warnings);
  if (run.settings.prints_json)
    console.out << json;
  else
    console.out << SummaryText(run, found) << FilesText(run);
  console.err << FailureText(run);
}

}  // namespace

int RunCalibrate(const CalibrateSettings& settings, const Console& console) {
  const Stopwatch total;
  DemandWritable(settings.out, kResultFiles);
  ProgressLine progress(console);
  CalibrationRun run = Load(settings, progress);
  const double load_s = total.Seconds();

  ShowProgressOn(progress, run.options);
  run.result = Calibrate(run);
  progress.Show("writing the report");
  const Stopwatch report;
  const nlohmann::json images = ReportImages(run);
  run.report_s = report.Seconds();
  run.result.times.read_s += load_s;
  run.result.times.total_s = total.Seconds();

  const FoundParameters found = WhatWasFound(run);
  const std::vector<std::string> warnings = Warnings(run, found);
  const nlohmann::ordered_json calibration = CalibrationJson(run, found, warnings);
  const std::string json = JsonText(calibration);
  Write(run, json, RenderCalibrationPage(ReportData(run, found, calibration, images)));
  progress.Clear();
  Print(run, found, warnings, json, console);
  return run.result.calibration.status == CalibrationStatus::kConverged ? kExitSuccess : kExitNoResult;
}

}  // namespace legible
