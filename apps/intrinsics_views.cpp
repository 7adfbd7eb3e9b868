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

#include "apps/intrinsics_run.h"
#include "core/vision/board_detection.h"
#include "core/vision/gray_image.h"
#include "datasets/board_file.h"
#include "datasets/camera_file.h"
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

// "1, 2 and 5", at most some.
std::string ListOf(const std::set<int>& numbers) {
  constexpr size_t kMost = 8;
  std::string text;
  size_t count = 0;
  for (const int number : numbers) {
    if (count == kMost) return text + fmt::format(" … ({} in all)", numbers.size());
    text += (count++ == 0 ? "" : ", ") + std::to_string(number);
  }
  return text;
}

// Tags of the board's family that its file does not have, in most images: its rows or columns are wrong.
void DemandNoForeignTags(const IntrinsicsRun& run) {
  std::map<std::string, int> images_of_tag;
  int with_board = 0;
  for (size_t i = 0; i < run.input.views.size(); ++i) {
    if (run.input.views[i].corners.empty()) continue;
    ++with_board;
    for (const LeftOut& one : run.left_out[i])
      if (one.points.empty()) ++images_of_tag[one.what];
  }
  std::string foreign;
  for (const auto& [tag, images] : images_of_tag)
    if (2 * images > with_board) foreign += (foreign.empty() ? "" : ", ") + tag;
  if (foreign.empty()) return;
  throw InputError(
      run.settings.board, 0,
      fmt::format("does not have {}, and most of the images that show the board show them", foreign),
      "mend rows, columns, first_id or the list of tags");
}

// Tags that no image shows, while all others are there: a whole row or column too many.
void DemandNoMissingTags(const IntrinsicsRun& run) {
  if (!run.board.tags) return;
  std::map<size_t, int> seen;
  for (const BoardView& view : run.input.views)
    for (const BoardCorner& corner : view.corners) ++seen[static_cast<size_t>(corner.point) / 4];
  std::set<int> missing;
  for (size_t i = 0; i < run.board.tags->tags.size(); ++i)
    if (!seen.contains(i)) missing.insert(run.board.tags->tags[i].id);
  constexpr size_t kFewest = 3;  // one may be dirty
  if (seen.empty() || missing.size() < kFewest) return;
  throw InputError(run.settings.board, 0,
                   fmt::format("has the tags {}, and no image shows any of them", ListOf(missing)),
                   "mend rows, columns or the list of tags, or show the whole board in some image");
}

// The last column or row of a chessboard without a corner in a whole file.
void DemandAllLines(const IntrinsicsRun& run) {
  if (!run.board.chessboard) return;
  const Chessboard& board = *run.board.chessboard;
  int columns = 0, rows = 0;
  for (const BoardView& view : run.input.views)
    for (const BoardCorner& corner : view.corners) {
      columns = std::max(columns, corner.point % board.columns + 1);
      rows = std::max(rows, corner.point / board.columns + 1);
    }
  if (columns == 0 || (columns == board.columns && rows == board.rows)) return;
  throw InputError(run.settings.board, 0,
                   fmt::format("has {} columns and {} rows of corners, and {} has {} and {}", board.columns,
                               board.rows, run.settings.corners->string(), columns, rows),
                   "mend columns and rows, or take them from the board itself");
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
  run.input.views = ReadCorners(*run.settings.corners, run.board, run.settings.trusts_all);
  run.left_out.resize(run.input.views.size());
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

}  // namespace

IntrinsicsRun LoadViews(const IntrinsicsSettings& settings, ProgressLine& progress) {
  DemandOneSource(settings);
  IntrinsicsRun run;
  run.settings = settings;
  run.board = ReadBoard(settings.board);
  run.input.points_in_board_m = PointsOf(run.board);
  std::vector<std::filesystem::path> files = ImageFiles(settings.images);
  if (settings.corners)
    AddCorners(run);
  else
    AddImages(run, files, progress);
  DemandNoForeignTags(run);
  DemandNoMissingTags(run);
  if (settings.corners) DemandAllLines(run);
  files.insert(files.begin(), settings.board);
  if (settings.corners) files.push_back(*settings.corners);
  run.content_hash = ContentHash(files);
  return run;
}

}  // namespace legible
