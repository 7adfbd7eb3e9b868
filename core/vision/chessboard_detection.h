// A chessboard in images.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/session/board.h"
#include "core/vision/board_corners.h"
#include "core/vision/gray_image.h"

namespace legible {

// See BoardDetector.
class ChessboardDetector {
 public:
  // Throws std::invalid_argument for fewer than three inner corners a side.
  explicit ChessboardDetector(const Chessboard& board);

  BoardSighting Detect(const GrayImage& image) const;

 private:
  std::vector<Eigen::Vector2d> Find(const GrayImage& image) const;
  std::vector<ExpectedCorner> Expected(const std::vector<Eigen::Vector2d>& corners) const;
  std::vector<CornerFit> WithColours(std::vector<CornerFit> fits) const;
  double DarknessOfFirst(const std::vector<CornerFit>& fits) const;
  double Colour(size_t point) const;
  size_t At(int row, int column) const { return static_cast<size_t>(row * board_.columns + column); }

  Chessboard board_;
};

}  // namespace legible
