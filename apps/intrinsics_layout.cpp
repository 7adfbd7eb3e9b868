#include "apps/intrinsics_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "calib/board/layout_check.h"
#include "core/vision/gray_image.h"
#include "core/vision/tag_corners.h"
#include "core/vision/tags.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr double kManyContradict = 0.25;  // of the tags that were found and agree
constexpr int kMostNamed = 8;

// The images' tags wherever they are, without a word from the board's file but its family and its ids.
BoardCalibrationInput TagsAsTheyAre(const IntrinsicsRun& run) {
  const TagBoard& board = run.board.tags.value();
  std::map<int, int> index_of_id;
  for (size_t i = 0; i < board.tags.size(); ++i) index_of_id[board.tags[i].id] = static_cast<int>(i);
  const TagDetector detector(board.family, {.decimation = 1, .border_bits = board.border_bits});
  BoardCalibrationInput input = run.input;
  for (BoardView& view : input.views) {
    view.corners.clear();
    const auto image = ReadGrayImage(view.file);
    if (!image) continue;
    for (const TagDetection& detection : detector.Detect(*image)) {
      const auto index = index_of_id.find(detection.id);
      for (int corner = 0; index != index_of_id.end() && corner < 4; ++corner)
        view.corners.push_back({4 * index->second + corner, detection.corners_px[static_cast<size_t>(corner)],
                                Eigen::Matrix2d::Identity()});
    }
  }
  return input;
}

void DemandNoContradictions(const IntrinsicsRun& run) {
  if (!run.board.tags || run.settings.corners) return;
  double contradicting = 0, found = 0;
  for (size_t i = 0; i < run.left_out.size(); ++i) {
    contradicting += static_cast<double>(std::count_if(run.left_out[i].begin(), run.left_out[i].end(),
                                                       [](const LeftOut& one) { return one.contradicts; }));
    found += static_cast<double>(run.input.views[i].corners.size()) / 4;
  }
  if (contradicting <= kManyContradict * found) return;
  throw InputError(run.settings.board, 0, "does not describe the board in the images",
                   WhyNotFlat(run.board, TagsAsTheyAre(run)));
}

// "1, 2 and 5", at most some.
std::string ListOf(const std::set<int>& numbers) {
  std::string text;
  int count = 0;
  for (const int number : numbers) {
    if (count == kMostNamed) return text + fmt::format(" … ({} in all)", numbers.size());
    text += (count++ == 0 ? "" : ", ") + std::to_string(number);
  }
  return text;
}

// Whether a tag is among the board's: no farther from one of them than these are large.
bool IsBeside(const Eigen::Vector2d& pixel, const std::vector<BoardCorner>& corners) {
  return std::any_of(corners.begin(), corners.end(), [&](const BoardCorner& corner) {
    const auto next = std::find_if(corners.begin(), corners.end(), [&](const BoardCorner& other) {
      return other.point != corner.point && other.point / 4 == corner.point / 4;
    });
    if (next == corners.end()) return false;
    return (pixel - corner.pixel).norm() < 1.5 * (next->pixel - corner.pixel).norm();
  });
}

// Tags of the board's family that its file does not have, beside its own in most images: its rows or columns
// are wrong. (Tags elsewhere may be the robot's.)
void DemandNoForeignTags(const IntrinsicsRun& run) {
  std::map<std::string, int> images_of_tag;
  int with_board = 0;
  for (size_t i = 0; i < run.input.views.size(); ++i) {
    if (run.input.views[i].corners.empty()) continue;
    ++with_board;
    for (const LeftOut& one : run.left_out[i])
      if (one.points.empty() && one.pixel && IsBeside(*one.pixel, run.input.views[i].corners))
        ++images_of_tag[one.what];
  }
  std::string foreign;
  int count = 0;
  for (const auto& [tag, images] : images_of_tag)
    if (2 * images > with_board && ++count <= kMostNamed) foreign += (foreign.empty() ? "" : ", ") + tag;
  if (foreign.empty()) return;
  throw InputError(
      run.settings.board, 0,
      fmt::format("does not have {}{}, and most of the images that show the board show them beside it",
                  foreign, count > kMostNamed ? fmt::format(" … ({} in all)", count) : ""),
      "mend rows, columns, first_id or the list of tags");
}

// The last tags of the board that no image shows: a row too many. (Others may be hidden by what holds it.)
void DemandNoMissingTags(const IntrinsicsRun& run) {
  if (!run.board.tags) return;
  std::set<int> seen, missing;
  for (const BoardView& view : run.input.views)
    for (const BoardCorner& corner : view.corners)
      seen.insert(run.board.tags->tags[static_cast<size_t>(corner.point) / 4].id);
  for (const Tag& tag : run.board.tags->tags)
    if (!seen.contains(tag.id)) missing.insert(tag.id);
  constexpr size_t kFewest = 3;  // one may be dirty
  const bool are_last = !seen.empty() && !missing.empty() && *missing.begin() > *seen.rbegin();
  if (missing.size() < kFewest || !are_last) return;
  throw InputError(run.settings.board, 0,
                   fmt::format("has the tags {}, and no image shows any of them", ListOf(missing)),
                   "mend rows or the list of tags, or show the whole board in some image");
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

// Tags that a board's file may have meant.
struct PrintedTags {
  std::string family;
  int border_bits = 1;
};

// Those that are quickly looked for; families of many tags take a gigabyte.
std::vector<PrintedTags> UsualTags() {
  constexpr int kMostTags = 2500;
  std::vector<PrintedTags> usual;
  for (const TagFamily& family : kTagFamilies)
    if (family.tags <= kMostTags) usual.push_back({family.name, 1});
  for (const std::string& family : kWideBorderFamilies) usual.push_back({family, 2});
  return usual;
}

// At most that some image shows.
size_t MostTagsIn(const std::vector<GrayImage>& images, const PrintedTags& tags) {
  const TagDetector detector(tags.family, {.decimation = 1, .border_bits = tags.border_bits});
  size_t most = 0;
  for (const GrayImage& image : images) most = std::max(most, detector.Detect(image).size());
  return most;
}

// The first images in which the board was not found.
std::vector<GrayImage> ImagesWithoutBoard(const IntrinsicsRun& run) {
  constexpr size_t kImages = 2;
  std::vector<GrayImage> images;
  for (const BoardView& view : run.input.views) {
    if (images.size() == kImages) break;
    if (!view.corners.empty() || view.file.empty()) continue;
    if (auto image = ReadGrayImage(view.file)) images.push_back(std::move(*image));
  }
  return images;
}

}  // namespace

std::string OtherTagsSeen(const IntrinsicsRun& run) {
  constexpr size_t kChance = 2;  // as many may be read where there are none
  if (!run.board.tags) return "";
  const std::vector<GrayImage> images = ImagesWithoutBoard(run);
  if (images.empty()) return "";
  size_t most = kChance;
  std::string seen;
  for (const PrintedTags& tags : UsualTags()) {
    if (tags.family == run.board.tags->family && tags.border_bits == run.board.tags->border_bits) continue;
    const size_t count = MostTagsIn(images, tags);
    if (count <= most) continue;
    most = count;
    seen = PrintOf(tags.family, tags.border_bits);
  }
  return seen.empty() ? "" : fmt::format("the images show tags of {}: mend the board's file", seen);
}

void DemandAgreement(const IntrinsicsRun& run) {
  DemandNoForeignTags(run);
  DemandNoContradictions(run);
}

void DemandWholeBoard(const IntrinsicsRun& run) {
  DemandNoMissingTags(run);
  if (run.settings.corners) DemandAllLines(run);
}

}  // namespace legible
