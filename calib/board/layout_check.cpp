#include "calib/board/layout_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <map>
#include <optional>

#include "calib/board/board_start.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr double kFits = 0.04;  // of the distance of neighbours: how far off a layout's centres may lie
constexpr int kMostColumns = 60;
constexpr size_t kFewestTags = 6;

// A tag seen in an image, by its corners.
struct SeenTag {
  size_t index;  // on the board
  std::array<Eigen::Vector2d, 4> corners_px;

  Eigen::Vector2d Centre() const {
    const Eigen::Vector3d diagonals[] = {corners_px[0].homogeneous().cross(corners_px[2].homogeneous()),
                                         corners_px[1].homogeneous().cross(corners_px[3].homogeneous())};
    return diagonals[0].cross(diagonals[1]).hnormalized();
  }
};
using SeenTags = std::vector<SeenTag>;

// The tags of a view of which all four corners are there.
SeenTags WholeTagsOf(const BoardView& view) {
  std::map<size_t, std::map<size_t, Eigen::Vector2d>> corners;
  for (const BoardCorner& corner : view.corners) {
    const size_t point = static_cast<size_t>(corner.point);
    corners[point / 4][point % 4] = corner.pixel;
  }
  SeenTags tags;
  for (const auto& [index, of_tag] : corners)
    if (of_tag.size() == 4) tags.push_back({index, {of_tag.at(0), of_tag.at(1), of_tag.at(2), of_tag.at(3)}});
  return tags;
}

// The centres of a view's tags, where a layout has them.
ViewObservation CentresOf(const SeenTags& tags, const std::vector<Eigen::Vector3d>& layout) {
  ViewObservation view;
  for (const SeenTag& tag : tags) {
    view.points_in_board_m.push_back(layout[tag.index]);
    view.pixels.push_back(tag.Centre());
  }
  return view;
}

struct LayoutFit {
  double unevenness = 1;  // median over the views, of the distance of neighbours in the image
  StraightenedViews views;
};

LayoutFit FitLayout(const std::vector<SeenTags>& views, const std::vector<Eigen::Vector3d>& layout,
                    const BoardCalibrationInput& input, bool may_bend) {
  std::vector<ViewObservation> observed;
  observed.reserve(views.size());
  for (const SeenTags& tags : views) observed.push_back(CentresOf(tags, layout));
  LayoutFit fit{1, Straighten(observed, input.width_px, input.height_px, may_bend)};
  std::vector<double> shares;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (!fit.views.views[i]) continue;
    const double neighbours_px = NeighbourDistance_px(observed[i]);
    shares.push_back(fit.views.views[i]->median_error * fit.views.unit_px / neighbours_px);
  }
  if (!shares.empty()) fit.unevenness = MedianOf(shares);
  return fit;
}

// By how much larger than stated the tags are, against the distances of their centres.
double SizeFactor(const std::vector<SeenTags>& views, const LayoutFit& fit, const TagBoard& board) {
  std::vector<double> factors;
  for (size_t i = 0; i < views.size(); ++i) {
    if (!fit.views.views[i]) continue;
    const Eigen::Matrix3d board_from_image = fit.views.views[i]->image_from_board.inverse();
    const auto on_board = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
      return (board_from_image * fit.views.StraightPlace(pixel).homogeneous()).hnormalized();
    };
    for (const SeenTag& tag : views[i]) {
      const auto& stated_m = board.tags[tag.index].corners_m;
      for (size_t c = 0; c < 4; ++c) {
        const double seen = (on_board(tag.corners_px[(c + 1) % 4]) - on_board(tag.corners_px[c])).norm();
        factors.push_back(seen / (stated_m[(c + 1) % 4] - stated_m[c]).norm());
      }
    }
  }
  return MedianOf(factors);
}

// Tags row by row in the order of their ids, from the top or from the bottom, one apart.
std::vector<Eigen::Vector3d> RowByRow(const TagBoard& board, int columns, bool from_top) {
  int first = board.tags.front().id;
  for (const Tag& tag : board.tags) first = std::min(first, tag.id);
  std::vector<Eigen::Vector3d> layout;
  for (const Tag& tag : board.tags) {
    const int place = tag.id - first, row = place / columns;
    layout.emplace_back(place % columns, from_top ? -row : row, 0);
  }
  return layout;
}

std::string OtherLayout(const std::vector<SeenTags>& views, const TagBoard& board,
                        const BoardCalibrationInput& input) {
  for (int columns = 1; columns <= kMostColumns; ++columns)
    for (const bool from_top : {true, false}) {
      if (FitLayout(views, RowByRow(board, columns, from_top), input, false).unevenness > kFits) continue;
      return fmt::format("in the images they lie as in {} columns, ids row by row from the {}", columns,
                         from_top ? "top left" : "bottom left");
    }
  return "check the order of its ids, rows, columns and corners";
}

std::vector<Eigen::Vector3d> CentresOf(const TagBoard& board) {
  std::vector<Eigen::Vector3d> centres;
  for (const Tag& tag : board.tags)
    centres.push_back((tag.corners_m[0] + tag.corners_m[1] + tag.corners_m[2] + tag.corners_m[3]) / 4);
  return centres;
}

std::vector<SeenTags> WholeTags(const BoardCalibrationInput& input) {
  std::vector<SeenTags> views;
  for (const BoardView& view : input.views)
    if (SeenTags tags = WholeTagsOf(view); tags.size() >= kFewestTags) views.push_back(std::move(tags));
  return views;
}

}  // namespace

std::optional<double> TagSizeFactor(const TagBoard& board, const BoardCalibrationInput& input) {
  const std::vector<SeenTags> views = WholeTags(input);
  if (views.empty()) return std::nullopt;
  const LayoutFit stated = FitLayout(views, CentresOf(board), input, true);
  if (stated.unevenness > kFits) return std::nullopt;
  return SizeFactor(views, stated, board);
}

std::string WhyNotFlat(const Board& board, const BoardCalibrationInput& input) {
  const std::string what = "the corners in the images do not lie to each other as on the board: ";
  if (!board.tags) return what + "check its columns and rows, and whether it is flat";
  if (const auto factor = TagSizeFactor(*board.tags, input))
    return what +
           fmt::format("its tags are {:.3g} times as large, against their distances, as it says", *factor);
  const std::vector<SeenTags> views = WholeTags(input);
  return what + (views.empty() ? "check its layout, and whether it is flat"
                               : OtherLayout(views, *board.tags, input));
}

}  // namespace legible
