#include "datasets/corner_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "datasets/csv_table.h"
#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

// What a file says of one corner, in the order of its columns.
enum Column { kView, kX, kY, kFirst, kSecond, kWeight, kSigma };

CsvColumns ColumnsFor(const Board& board) {
  std::vector<std::string> required = {"view", "x_px", "y_px"};
  const std::vector<std::string> places = board.chessboard ? std::vector<std::string>{"column", "row"}
                                                           : std::vector<std::string>{"tag", "corner"};
  required.insert(required.end(), places.begin(), places.end());
  return {required, {"weight", "sigma_px"}};
}

double NumberIn(const std::filesystem::path& file, const CsvRow& row, Column column, const char* name) {
  const auto number = ParseFinite(row.fields[column]);
  if (number) return *number;
  throw InputError(file, row.line, fmt::format("{} is \"{}\", not a finite number", name, row.fields[column]),
                   "mend it, or take this row out");
}

// A whole number from 0 to count - 1.
int IndexIn(const std::filesystem::path& file, const CsvRow& row, Column column, const std::string& name,
            int count) {
  const auto index = ParseInteger(row.fields[column]);
  if (index && *index >= 0 && *index < count) return *index;
  throw InputError(
      file, row.line,
      fmt::format("{} is {}, and the board has {} 0 to {}", name, row.fields[column], name, count - 1),
      "mend the row, or the board's file");
}

int PointOf(const std::filesystem::path& file, const CsvRow& row, const Board& board,
            const std::map<int, int>& tag_of_id) {
  if (board.chessboard) {
    const int column = IndexIn(file, row, kFirst, "column", board.chessboard->columns);
    return IndexIn(file, row, kSecond, "row", board.chessboard->rows) * board.chessboard->columns + column;
  }
  const auto id = ParseInteger(row.fields[kFirst]);
  const auto tag = id ? tag_of_id.find(*id) : tag_of_id.end();
  if (tag == tag_of_id.end())
    throw InputError(file, row.line,
                     fmt::format("tag is {}, which the board does not have", row.fields[kFirst]),
                     "mend the row, or the board's file");
  return 4 * tag->second + IndexIn(file, row, kSecond, "corner", 4);
}

// The value, which no corner has much smaller or larger.
double Demanded(const std::filesystem::path& file, const CsvRow& row, const char* name, double value) {
  constexpr double kLeast = 1e-6, kMost = 1e6;
  if (value >= kLeast && value <= kMost) return value;
  throw InputError(file, row.line, fmt::format("{} is {}", name, value),
                   fmt::format("give a number from {} to {}", kLeast, kMost));
}

// In units of the corners' common variance; nothing where the file marks the corner as wrong.
std::optional<double> VarianceOf(const std::filesystem::path& file, const CsvRow& row) {
  if (!row.fields[kWeight].empty() && !row.fields[kSigma].empty())
    throw InputError(file, row.line, "has both weight and sigma_px", "keep one of the two columns");
  if (!row.fields[kSigma].empty())
    return std::pow(Demanded(file, row, "sigma_px", NumberIn(file, row, kSigma, "sigma_px")), 2);
  if (row.fields[kWeight].empty()) return 1;
  const double weight = NumberIn(file, row, kWeight, "weight");
  if (weight <= 0) return std::nullopt;
  return 1 / std::pow(Demanded(file, row, "weight", weight), 2);
}

void SortByPoint(std::vector<ReadView>& views) {
  for (ReadView& one : views)
    std::sort(one.view.corners.begin(), one.view.corners.end(),
              [](const BoardCorner& a, const BoardCorner& b) { return a.point < b.point; });
}

std::string NameOf(const CsvRow& row, const Board& board) {
  if (board.chessboard)
    return fmt::format("the corner in column {}, row {},", row.fields[kFirst], row.fields[kSecond]);
  return fmt::format("corner {} of tag {}", row.fields[kSecond], row.fields[kFirst]);
}

}  // namespace

std::vector<ReadView> ReadCorners(const std::filesystem::path& file, const Board& board, bool counts_alike) {
  std::map<int, int> tag_of_id;
  if (board.tags)
    for (size_t i = 0; i < board.tags->tags.size(); ++i)
      tag_of_id[board.tags->tags[i].id] = static_cast<int>(i);
  const std::string text = ReadTextFile(file);
  std::vector<ReadView> views;
  std::map<std::string, size_t, std::less<>> view_of_name;
  std::set<std::pair<size_t, int>> seen;
  for (const CsvRow& row : ArrangeCsv(file, SplitCsv(text), ColumnsFor(board))) {
    const std::string name(row.fields[kView]);
    if (name.empty()) throw InputError(file, row.line, "view is empty", "name the view or its image");
    const auto [view, is_new] = view_of_name.emplace(name, views.size());
    if (is_new) views.push_back({{name, {}, {}}, {}});
    const int point = PointOf(file, row, board, tag_of_id);
    if (!seen.insert({view->second, point}).second)
      throw InputError(file, row.line, "is a corner that this view has already", "keep one row for it");
    const auto variance = counts_alike ? std::optional(1.0) : VarianceOf(file, row);
    const Eigen::Vector2d pixel(NumberIn(file, row, kX, "x_px"), NumberIn(file, row, kY, "y_px"));
    if (variance)
      views[view->second].view.corners.push_back({point, pixel, *variance * Eigen::Matrix2d::Identity()});
    else
      views[view->second].left_out.push_back(
          {NameOf(row, board), "is marked as wrong in the file of corners", {point}, pixel});
  }
  if (views.empty()) throw InputError(file, 0, "no corner: there is no row below the header", "add some");
  SortByPoint(views);
  return views;
}

}  // namespace legible
