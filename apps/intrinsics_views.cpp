// Where the views of `legible intrinsics` come from: images, or a file of corners.
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <set>

#include "apps/intrinsics_layout.h"
#include "apps/intrinsics_run.h"
#include "core/vision/board_detection.h"
#include "core/vision/gray_image.h"
#include "datasets/board_file.h"
#include "datasets/content_hash.h"
#include "datasets/corner_file.h"
#include "datasets/image_folder.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

// Files as they are, folders by the images in them.
std::vector<std::filesystem::path> ImageFiles(const std::vector<std::filesystem::path>& named) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : named) {
    if (!std::filesystem::exists(path))
      throw InputError(path, 0, "is not there", "name images of the board, or folders of them");
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const std::set<std::string> names = ImagesIn(path);
    if (names.empty()) throw InputError(path, 0, "no image in this folder", "name a folder of images");
    for (const std::string& name : names) files.push_back(path / name);
  }
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& file : files)
    if (!seen.insert(std::filesystem::weakly_canonical(file)).second)
      throw InputError(file, 0, "is named twice, and would count twice", "name it once");
  return files;
}

struct Found {
  int width_px = 0, height_px = 0;  // 0: not an image
  BoardSighting sighting;
};

std::vector<Found> FindBoard(const Board& board, const std::vector<std::filesystem::path>& files, int threads,
                             ProgressLine& progress) {
  std::vector<Found> found(files.size());
  std::atomic<int> done = 0;
  // A detector is costly to make and no two threads' own.
  tbb::enumerable_thread_specific<std::unique_ptr<BoardDetector>> detectors;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, files.size(), [&](size_t i) {
      std::unique_ptr<BoardDetector>& detector = detectors.local();
      if (!detector) detector = std::make_unique<BoardDetector>(board);
      if (const auto image = ReadGrayImage(files[i]))
        found[i] = {image->width, image->height, detector->Detect(*image)};
      progress.Show(StageText("finding the board", ++done, static_cast<int>(files.size())));
    });
  });
  return found;
}

void DemandImagesOfOneSize(const std::vector<std::filesystem::path>& files, const std::vector<Found>& found) {
  for (size_t i = 0; i < files.size(); ++i) {
    if (found[i].width_px == 0)
      throw InputError(files[i], 0, "is not an image, or damaged", "save it again, or leave it out");
    if (found[i].width_px == found[0].width_px && found[i].height_px == found[0].height_px) continue;
    throw InputError(files[i], 0,
                     fmt::format("is {} x {} px, and {} is {} x {} px", found[i].width_px, found[i].height_px,
                                 files[0].string(), found[0].width_px, found[0].height_px),
                     "give images of one camera at one resolution");
  }
}

void AddImages(IntrinsicsRun& run, const std::vector<std::filesystem::path>& files, ProgressLine& progress) {
  const std::vector<Found> found = FindBoard(run.board, files, run.settings.threads, progress);
  DemandImagesOfOneSize(files, found);
  run.input.width_px = found.front().width_px;
  run.input.height_px = found.front().height_px;
  std::map<std::filesystem::path, int> files_of_name;
  for (const std::filesystem::path& file : files) ++files_of_name[file.filename()];
  for (size_t i = 0; i < files.size(); ++i) {
    const bool is_unique = files_of_name[files[i].filename()] == 1;
    const std::filesystem::path name = is_unique ? files[i].filename() : files[i];
    run.input.views.push_back({name.string(), files[i], found[i].sighting.corners});
    run.left_out.push_back(found[i].sighting.left_out);
  }
}

void AddCorners(IntrinsicsRun& run) {
  for (ReadView& read : ReadCorners(*run.settings.corners, run.board, run.settings.board_fit.trusts_all)) {
    run.input.views.push_back(std::move(read.view));
    run.left_out.push_back(std::move(read.left_out));
  }
  std::tie(run.input.width_px, run.input.height_px) = *run.settings.image_size_px;
  for (const BoardView& view : run.input.views)
    for (const BoardCorner& corner : view.corners) {
      const Eigen::Vector2d& pixel = corner.pixel;
      if (pixel.minCoeff() >= -0.5 && pixel.x() <= run.input.width_px - 0.5 &&
          pixel.y() <= run.input.height_px - 0.5)
        continue;
      throw InputError(
          *run.settings.corners, 0,
          fmt::format("has a corner of view {} at ({:.1f}, {:.1f}) px, outside an image of {} x {} px",
                      view.name, pixel.x(), pixel.y(), run.input.width_px, run.input.height_px),
          "mend --image-size or the corners");
    }
}

void DemandOneSource(const IntrinsicsSettings& settings) {
  if (settings.images.empty() == !settings.corners.has_value())
    throw InputError(settings.board, 0,
                     settings.corners ? "is to be looked for in images, and --corners is given too"
                                      : "is to be looked for, and no image is given",
                     "name images, or corners found elsewhere with --corners");
  if (settings.corners.has_value() != settings.image_size_px.has_value())
    throw InputError(settings.corners.value_or(settings.board), 0,
                     settings.corners ? "does not say how large the images are"
                                      : "is looked for in images, which say their size themselves",
                     settings.corners ? "give --image-size WxH" : "leave --image-size out");
}

// A board of a single tag.
void DemandEnoughPoints(const IntrinsicsRun& run) {
  const auto points = std::ssize(run.input.points_in_board_m);
  if (points >= kFewestViewCorners) return;
  throw InputError(
      run.settings.board, 0,
      fmt::format("has {} corners, and a view counts with {} or more", points, kFewestViewCorners),
      "take a board of several tags");
}

}  // namespace

IntrinsicsRun LoadViews(const IntrinsicsSettings& settings, ProgressLine& progress) {
  DemandOneSource(settings);
  IntrinsicsRun run;
  run.settings = settings;
  run.board = ReadBoard(settings.board);
  run.input.points_in_board_m = PointsOf(run.board);
  DemandEnoughPoints(run);
  const std::vector<std::filesystem::path> images = ImageFiles(settings.images);
  if (settings.corners)
    AddCorners(run);
  else
    AddImages(run, images, progress);
  DemandAgreement(run);
  run.files = {settings.board};
  run.files.insert(run.files.end(), images.begin(), images.end());
  if (settings.corners) run.files.push_back(*settings.corners);
  run.content_hash = ContentHash(run.files);
  return run;
}

}  // namespace legible
