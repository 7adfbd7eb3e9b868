// All there is to say about one calibration of a camera by a board: what went in, what came out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/intrinsics_settings.h"
#include "apps/progress.h"
#include "calib/board/board_calibration.h"
#include "calib/board/coverage.h"
#include "calib/board/halves.h"
#include "calib/board/next_view.h"
#include "calib/board/pixel_uncertainty.h"
#include "core/session/board.h"
#include "core/vision/board_sighting.h"

namespace legible {

struct IntrinsicsRun {
  IntrinsicsSettings settings;
  Board board;
  BoardCalibrationInput input;
  std::vector<std::vector<LeftOut>> left_out;  // of each view, by the detection
  BoardCalibrationOptions options;
  std::vector<std::filesystem::path> files;  // that went in: the board's, then images or corners
  std::string content_hash;                  // of these

  BoardCalibration result;  // widened where the halves say that the lens model does not fit
  // Where there is a camera:
  double board_distance_m = 0;  // median over the views
  HalvesComparison halves;
  std::optional<double> neighbour_scatter;  // in units of noise_factor
  Coverage coverage;
  std::vector<UncertaintyMap> maps;  // by WorkOutUncertainty, as is
  std::optional<NextView> next_view;

  double seconds = 0;  // of the whole command up to the writing of files

  // Of one coordinate of one corner, among its neighbours, px.
  std::optional<double> NeighbourSigma_px() const;
};

// Reads the board and finds its corners in the images, or reads them. Throws InputError for what cannot be
// read, images of two sizes, and tags that contradict the board's file.
IntrinsicsRun LoadViews(const IntrinsicsSettings& settings, ProgressLine& progress);

// Calibrates, and checks the camera where there is one. Throws InputError where the board's file or the guess
// is wrong by what the images show.
void Calibrate(IntrinsicsRun& run, ProgressLine& progress);

// How well a camera that was found is known over the image, and what would make it better.
void WorkOutUncertainty(IntrinsicsRun& run, ProgressLine& progress);

}  // namespace legible
