#include "core/session/board.h"

namespace legible {
namespace {

// y is up and row 0 on top; the middle of the corners is the origin.
std::vector<Eigen::Vector3d> InnerCorners(const Chessboard& board) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      points.emplace_back((column - 0.5 * (board.columns - 1)) * board.column_step_m,
                          (0.5 * (board.rows - 1) - row) * board.row_step_m, 0);
  return points;
}

}  // namespace

std::vector<Eigen::Vector3d> PointsOf(const Board& board) {
  if (board.chessboard) return InnerCorners(*board.chessboard);
  std::vector<Eigen::Vector3d> points;
  for (const Tag& tag : board.tags.value().tags)
    points.insert(points.end(), tag.corners_m.begin(), tag.corners_m.end());
  return points;
}

}  // namespace legible
