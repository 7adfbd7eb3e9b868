// What is printed about the corners of tags, and where an image should show it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/session/session.h"
#include "core/vision/board_corners.h"
#include "core/vision/tags.h"

namespace legible {

// Brightness of a tag's picture, 0 or 1, at a column and row of its modules; the paper about it is light.
double LevelAt(const TagPicture& picture, const Eigen::Vector2d& column_and_row);

// What is printed about one corner of a tag.
struct TagCornerPattern {
  std::array<double, 2> next_line;  // along edges 1 and 2, over the tag's sides there
  CornerCells cells;
  bool knows_beyond = false;  // see CornerSite
};
// By corner. Edge 1 leads to the next corner, edge 2 to the one before.
using TagPattern = std::array<TagCornerPattern, 4>;

struct TagPrint {
  int border_bits = 1;              // width of the border in the tag's own bits
  bool has_corner_squares = false;  // black squares that join the corners of neighbouring tags
};

// As messages name tags: "tag36h11" or "tag36h11 with borders of 2 bits".
std::string PrintOf(const std::string& family, int border_bits);

// `tags` are all that are printed together, the tag among them: the nearest one ends the light margin.
TagPattern PatternOf(const Tag& tag, const std::vector<Tag>& tags, const TagPicture& picture,
                     const TagPrint& print);

// The corners of a tag that was found in an image, as points first_point and the three that follow.
std::array<ExpectedCorner, 4> ExpectedCornersOf(const TagPattern& pattern,
                                                const std::array<Eigen::Vector2d, 4>& corners_px,
                                                int first_point);

// The corners, where they were fitted as found there; `fits` begins with theirs.
std::array<Eigen::Vector2d, 4> Refined(std::array<Eigen::Vector2d, 4> corners_px, const CornerFit* fits);

}  // namespace legible
