#include "datasets/board_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/tag_yaml.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

constexpr double kLargestPart_m = 2;  // a tag or a square of more is given in millimetres
constexpr int kMostRows = 1000;
constexpr int kLeastInnerCorners = 3;  // along a side; fewer are not found
constexpr int kMostBorderBits = 4;

double PartFromYaml(const YamlValue& value) {
  const double length_m = value.PositiveNumber();
  if (length_m > kLargestPart_m)
    value.Fail(fmt::format("is {} m", length_m),
               fmt::format("give metres, at most {}: it is usually in millimetres", kLargestPart_m));
  return length_m;
}

int CountFromYaml(const YamlValue& value) {
  const int count = value.PositiveInteger();
  if (count > kMostRows) value.Fail(fmt::format("is {}", count), fmt::format("give at most {}", kMostRows));
  return count;
}

int InnerCornersFromYaml(const YamlValue& value) {
  const int count = CountFromYaml(value);
  if (count < kLeastInnerCorners)
    value.Fail(
        fmt::format("is {}", count),
        fmt::format("count the inner corners, where four squares meet: at least {}", kLeastInnerCorners));
  return count;
}

struct GridOfTags {
  int columns, rows;
  double tag_m, gap_m;
  int first_id;
  bool counts_upwards;  // from the bottom-left as Kalibr does, else from the top-left
};

Tag TagOf(const GridOfTags& grid, int row, int column) {
  const double step_m = grid.tag_m + grid.gap_m;
  const double left_m = column * step_m - 0.5 * (grid.columns * step_m - grid.gap_m);
  const double bottom_m = 0.5 * (grid.rows * step_m - grid.gap_m) - row * step_m - grid.tag_m;
  const double right_m = left_m + grid.tag_m, top_m = bottom_m + grid.tag_m;
  const int counted_row = grid.counts_upwards ? grid.rows - 1 - row : row;
  return {grid.first_id + counted_row * grid.columns + column,
          {Eigen::Vector3d(left_m, bottom_m, 0),
           {right_m, bottom_m, 0},
           {right_m, top_m, 0},
           {left_m, top_m, 0}}};
}

// The board's middle is the origin.
std::vector<Tag> TagsOf(const GridOfTags& grid, const TagFamily& family, const YamlValue& section) {
  const int last_id = grid.first_id + grid.columns * grid.rows - 1;
  if (grid.first_id < 0 || last_id >= family.tags)
    section.Fail(fmt::format("asks for the ids {} to {}", grid.first_id, last_id),
                 fmt::format("{} has the ids 0 to {}", family.name, family.tags - 1));
  std::vector<Tag> tags;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) tags.push_back(TagOf(grid, row, column));
  return tags;
}

Eigen::Vector3d CornerFromYaml(const YamlValue& value) {
  const std::vector<double> numbers = value.Numbers();
  if (numbers.size() < 2 || numbers.size() > 3)
    value.Fail(fmt::format("has {} values", numbers.size()), "give [x, y] or [x, y, z]");
  return {numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0};
}

double SideOf(const Tag& tag) { return (tag.corners_m[1] - tag.corners_m[0]).norm(); }
Eigen::Vector3d MiddleOf(const Tag& tag) { return (tag.corners_m[0] + tag.corners_m[2]) / 2; }

void DemandLiesOnBoard(const YamlValue& corners, const Tag& tag) {
  constexpr double kFlat = 0.1;  // of a side
  if (SideOf(tag) > kLargestPart_m)
    corners.Fail(fmt::format("are {:.4g} m apart", SideOf(tag)),
                 "give metres: they are usually in millimetres");
  for (const Eigen::Vector3d& corner : tag.corners_m)
    if (std::abs(corner.z()) > kFlat * SideOf(tag))
      corners.Fail(fmt::format("are {:.4g} m off the plane z = 0", corner.z()), "a board is flat");
  if ((tag.corners_m[1] - tag.corners_m[0]).cross(tag.corners_m[3] - tag.corners_m[0]).z() < 0)
    corners.Fail("are those of a tag that is seen from behind",
                 "give bottom-left, bottom-right, top-right, top-left of the black border, x right and y up");
}

Tag TagFromYaml(const YamlValue& section, const TagFamily& family) {
  section.AllowKeys({"id", "corners_m"});
  Tag tag;
  tag.id = TagIdFromYaml(section, family);
  const YamlValue corners = section.Get("corners_m");
  const std::vector<YamlValue> list = corners.List(4);
  for (size_t i = 0; i < 4; ++i) tag.corners_m[i] = CornerFromYaml(list[i]);
  DemandSquare(corners, tag.corners_m);
  DemandLiesOnBoard(corners, tag);
  return tag;
}

void DemandApart(const YamlValue& section, const Tag& tag, const std::vector<Tag>& others) {
  constexpr double kTouching = 0.9;  // of a side, between two middles
  for (const Tag& other : others)
    if ((MiddleOf(tag) - MiddleOf(other)).norm() < kTouching * std::min(SideOf(tag), SideOf(other)))
      section.Fail(fmt::format("overlaps the tag {}", other.id), "give each tag its own place");
}

std::vector<Tag> ListedTags(const YamlValue& list, const TagFamily& family) {
  std::vector<Tag> tags;
  Once ids;
  for (const YamlValue& section : list.List()) {
    const Tag tag = TagFromYaml(section, family);
    ids.Demand(section, fmt::format("the id {}", tag.id));
    DemandApart(section, tag, tags);
    tags.push_back(tag);
  }
  if (tags.empty()) list.Fail("has no tags", "give those of the board");
  return tags;
}

int BorderBitsFromYaml(const YamlValue& value, const TagFamily& family) {
  const int bits = value.PositiveInteger();
  if (bits > kMostBorderBits)
    value.Fail(fmt::format("is {}", bits), fmt::format("give 1 to {}", kMostBorderBits));
  const bool may_be_wide = std::find(kWideBorderFamilies.begin(), kWideBorderFamilies.end(), family.name) !=
                           kWideBorderFamilies.end();
  if (bits > 1 && !may_be_wide)
    value.Fail(fmt::format("is {}", bits),
               fmt::format("borders of more than a bit are for {}", fmt::join(kWideBorderFamilies, ", ")));
  return bits;
}

bool BooleanFromYaml(const YamlValue& value) {
  const std::string text = value.Text();
  if (text != "true" && text != "false") value.Fail(fmt::format("is \"{}\"", text), "give true or false");
  return text == "true";
}

TagBoard TagBoardFromYaml(const YamlValue& root) {
  const std::optional<YamlValue> list = root.Find("tags");
  if (list)
    root.AllowKeys({"board", "name", "family", "tags", "border_bits", "corner_squares"});
  else
    root.AllowKeys({"board", "name", "family", "columns", "rows", "tag_size_m", "spacing_m", "first_id",
                    "border_bits", "corner_squares", "tags"});
  TagBoard board;
  const TagFamily& family = FamilyFromYaml(root.Get("family"));
  board.family = family.name;
  if (const auto bits = root.Find("border_bits")) board.border_bits = BorderBitsFromYaml(*bits, family);
  if (const auto squares = root.Find("corner_squares")) board.has_corner_squares = BooleanFromYaml(*squares);
  if (list) {
    board.tags = ListedTags(*list, family);
    return board;
  }
  GridOfTags grid{CountFromYaml(root.Get("columns")),
                  CountFromYaml(root.Get("rows")),
                  PartFromYaml(root.Get("tag_size_m")),
                  PartFromYaml(root.Get("spacing_m")),
                  0,
                  false};
  if (const auto first_id = root.Find("first_id")) grid.first_id = first_id->Integer();
  board.tags = TagsOf(grid, family, root);
  return board;
}

Chessboard ChessboardFromYaml(const YamlValue& root) {
  const std::optional<YamlValue> square = root.Find("square_m");
  if (square)
    root.AllowKeys({"board", "name", "columns", "rows", "square_m"});
  else
    root.AllowKeys({"board", "name", "columns", "rows", "square_m", "column_step_m", "row_step_m"});
  Chessboard board;
  board.columns = InnerCornersFromYaml(root.Get("columns"));
  board.rows = InnerCornersFromYaml(root.Get("rows"));
  if (square) {
    board.column_step_m = board.row_step_m = PartFromYaml(*square);
  } else {
    const std::optional<YamlValue> column_step = root.Find("column_step_m"),
                                   row_step = root.Find("row_step_m");
    if (!column_step || !row_step) root.Fail("does not say how large a square is", "give square_m");
    board.column_step_m = PartFromYaml(*column_step);
    board.row_step_m = PartFromYaml(*row_step);
  }
  return board;
}

Board BoardFromYaml(const YamlValue& root) {
  const YamlValue kind = root.Get("board");
  if (kind.Text() == "tags") return {"", TagBoardFromYaml(root), std::nullopt};
  if (kind.Text() == "chessboard") return {"", std::nullopt, ChessboardFromYaml(root)};
  kind.Fail(fmt::format("is \"{}\"", kind.Text()), "give tags or chessboard");
}

// Kalibr's boards: tag36h11, borders of two bits, black squares between the tags.
TagBoard AprilgridFromYaml(const YamlValue& root) {
  root.AllowKeys({"target_type", "tagCols", "tagRows", "tagSize", "tagSpacing", "codeOffset"});
  const YamlValue spacing = root.Get("tagSpacing");
  const double gap_by_size = spacing.PositiveNumber();
  if (gap_by_size > 1)
    spacing.Fail(fmt::format("is {}", gap_by_size), "give the gap between tags over their size, at most 1");
  const double tag_m = PartFromYaml(root.Get("tagSize"));
  GridOfTags grid{CountFromYaml(root.Get("tagCols")),
                  CountFromYaml(root.Get("tagRows")),
                  tag_m,
                  gap_by_size * tag_m,
                  0,
                  true};
  if (const auto offset = root.Find("codeOffset")) grid.first_id = offset->Integer();
  TagBoard board{"tag36h11", 2, true, {}};
  const auto family = std::find_if(kTagFamilies.begin(), kTagFamilies.end(),
                                   [&](const TagFamily& one) { return one.name == board.family; });
  board.tags = TagsOf(grid, *family, root);
  return board;
}

Chessboard CheckerboardFromYaml(const YamlValue& root) {
  root.AllowKeys({"target_type", "targetCols", "targetRows", "rowSpacingMeters", "colSpacingMeters"});
  return {InnerCornersFromYaml(root.Get("targetCols")), InnerCornersFromYaml(root.Get("targetRows")),
          PartFromYaml(root.Get("colSpacingMeters")), PartFromYaml(root.Get("rowSpacingMeters"))};
}

Board KalibrBoardFromYaml(const YamlValue& root) {
  const YamlValue kind = root.Get("target_type");
  if (kind.Text() == "aprilgrid") return {"", AprilgridFromYaml(root), std::nullopt};
  if (kind.Text() == "checkerboard") return {"", std::nullopt, CheckerboardFromYaml(root)};
  if (kind.Text() == "circlegrid")
    kind.Fail("is \"circlegrid\", which cannot be read", "use an aprilgrid or a checkerboard");
  kind.Fail(fmt::format("is \"{}\"", kind.Text()), "give aprilgrid or checkerboard");
}

}  // namespace

Board ReadBoard(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::LoadFile(file);
  Board board = root.Find("target_type") ? KalibrBoardFromYaml(root) : BoardFromYaml(root);
  const std::optional<YamlValue> name = root.Find("name");
  board.name = name ? name->Text() : file.stem().string();
  return board;
}

}  // namespace legible
