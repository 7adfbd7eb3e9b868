#include "core/vision/tag_corners.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/vision/tag_agreement.h"

namespace legible {
namespace {

// The corners of a square of side 1.
const std::array<Eigen::Vector3d, 4> kUnitSquare = {
    Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

size_t FarEndOf(size_t edge, size_t corner) { return (corner + (edge == 0 ? 1 : 3)) % 4; }

// The modules about a corner, along its edges to the next corner and to the one before.
CornerCells CellsOf(const TagPicture& picture, size_t corner) {
  const int low = picture.ring, high = picture.modules - picture.ring;
  const Eigen::Vector2d at(corner == 1 || corner == 2 ? high : low, corner >= 2 ? low : high);  // column, row
  const std::array<Eigen::Vector2d, 4> along = {Eigen::Vector2d(1, 0), {0, -1}, {-1, 0}, {0, 1}};
  const Eigen::Vector2d& edge_1 = along[corner];
  const Eigen::Vector2d edge_2 = -along[(corner + 3) % 4];
  CornerCells cells;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      cells(row, column) = LevelAt(picture, at + (column - 1.5) * edge_1 + (row - 1.5) * edge_2);
  return cells;
}

// From a corner to the nearest other tag.
double Gap_m(const Tag& tag, size_t corner, const std::vector<Tag>& tags) {
  double gap_m = std::numeric_limits<double>::infinity();
  for (const Tag& other : tags) {
    if (other.id == tag.id) continue;
    for (const Eigen::Vector3d& theirs : other.corners_m)
      gap_m = std::min(gap_m, (theirs - tag.corners_m[corner]).norm());
  }
  return gap_m;
}

}  // namespace

double LevelAt(const TagPicture& picture, const Eigen::Vector2d& column_and_row) {
  if (column_and_row.minCoeff() < 0 || column_and_row.maxCoeff() > picture.modules) return 1;
  const auto column = static_cast<size_t>(column_and_row.x()), row = static_cast<size_t>(column_and_row.y());
  return picture.is_light[row * static_cast<size_t>(picture.modules) + column] ? 1 : 0;
}

std::string PrintOf(const std::string& family, int border_bits) {
  return border_bits == 1 ? family : fmt::format("{} with borders of {} bits", family, border_bits);
}

TagPattern PatternOf(const Tag& tag, const std::vector<Tag>& tags, const TagPicture& picture,
                     const TagPrint& print) {
  const bool is_wide = print.border_bits > 1;
  const double border = print.border_bits / static_cast<double>(picture.modules - 2 * picture.ring);
  TagPattern pattern;
  for (size_t corner = 0; corner < 4; ++corner) {
    TagCornerPattern& one = pattern[corner];
    one.cells = is_wide ? DarkWedge() : CellsOf(picture, corner);
    if (print.has_corner_squares) one.cells.topLeftCorner<2, 2>().setZero();
    one.knows_beyond = !is_wide && !print.has_corner_squares;
    for (size_t edge = 0; edge < 2; ++edge) {
      const double side_m = (tag.corners_m[FarEndOf(edge, corner)] - tag.corners_m[corner]).norm();
      one.next_line[edge] = std::min(border, Gap_m(tag, corner, tags) / side_m);
    }
  }
  return pattern;
}

std::array<ExpectedCorner, 4> ExpectedCornersOf(const TagPattern& pattern,
                                                const std::array<Eigen::Vector2d, 4>& corners_px,
                                                int first_point) {
  const TagPlane plane(kUnitSquare, corners_px);
  std::array<ExpectedCorner, 4> expected;
  for (size_t c = 0; c < 4; ++c) {
    ExpectedCorner& corner = expected[c];
    corner.point = first_point + static_cast<int>(c);
    corner.site.pixel = corners_px[c];
    corner.site.cells = pattern[c].cells;
    corner.site.knows_beyond = pattern[c].knows_beyond;
    for (size_t edge = 0; edge < 2; ++edge) {
      const size_t end = FarEndOf(edge, c);
      const Eigen::Vector3d next_line =
          kUnitSquare[c] + pattern[c].next_line[edge] * (kUnitSquare[end] - kUnitSquare[c]);
      corner.site.edges_px[edge] = plane * next_line.head<2>() - corners_px[c];
      corner.sides_px[edge] = (corners_px[end] - corners_px[c]).norm();
    }
  }
  return expected;
}

std::array<Eigen::Vector2d, 4> Refined(std::array<Eigen::Vector2d, 4> corners_px, const CornerFit* fits) {
  for (size_t i = 0; i < 4; ++i)
    if (fits[i].status == CornerStatus::kFitted) corners_px[i] = fits[i].pixel;
  return corners_px;
}

}  // namespace legible
