// Calibration boards, and what images show of them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/session/session.h"

namespace legible {

// A flat board of AprilTags. The frame of a board is x right, y up, z towards who looks at it.
struct TagBoard {
  std::string family;   // of kTagFamilies
  int border_bits = 1;  // width of the black border in the tag's own bits; Kalibr's boards have 2
  // Whether black squares join the tags' corners, as on Kalibr's boards: a corner is then a saddle.
  bool has_corner_squares = false;
  std::vector<Tag> tags;
};

// Families whose tags can be read with borders wider than a bit.
inline const std::vector<std::string> kWideBorderFamilies = {"tag36h11", "tag36h10", "tag25h9", "tag16h5"};

// A chessboard by its inner corners.
struct Chessboard {
  int columns = 0, rows = 0;                 // inner corners
  double column_step_m = 0, row_step_m = 0;  // between neighbouring columns, and rows
};

// Exactly one of the two is there.
struct Board {
  std::string name;
  std::optional<TagBoard> tags;
  std::optional<Chessboard> chessboard;
};

// All points of a board in its frame, m. Corner c of tag t is point 4 t + c; the inner corner in column c and
// row r is point r columns + c, the first in the top-left of the board.
std::vector<Eigen::Vector3d> PointsOf(const Board& board);

// A point of the board as it was found in an image.
struct BoardCorner {
  int point = 0;                                                 // of PointsOf(board)
  Eigen::Vector2d pixel;                                         // px, centre of the top-left pixel at (0, 0)
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();  // up to a factor that all corners share
};

// One view of the board.
struct BoardView {
  std::string name;                  // the image's file name, or the view's name in a file of corners
  std::filesystem::path file;        // of the image; empty where corners were found elsewhere
  std::vector<BoardCorner> corners;  // by point: neighbours on the board are mostly neighbours here
};

}  // namespace legible
