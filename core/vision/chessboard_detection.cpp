#include "core/vision/chessboard_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

namespace legible {

ChessboardDetector::ChessboardDetector(const Chessboard& board) : board_(board) {
  if (board.columns < 3 || board.rows < 3)
    throw std::invalid_argument("BoardDetector: a chessboard has at least 3 inner corners a side");
}

BoardSighting ChessboardDetector::Detect(const GrayImage& image) const {
  std::vector<Eigen::Vector2d> corners = Find(image);
  if (corners.empty())
    return {{},
            {WholeBoard(board_.columns * board_.rows,
                        "was not found with all of its corners: a chessboard counts only as a whole")}};
  const std::vector<CornerFit> rough = FitCorners(image, Expected(corners), kDetectedSigma_px, {});
  for (size_t i = 0; i < corners.size(); ++i)
    if (rough[i].status == CornerStatus::kFitted) corners[i] = rough[i].pixel;
  const std::vector<ExpectedCorner> expected = Expected(corners);
  const std::vector<CornerFit> fits = FitCorners(image, expected, kFittedSigma_px, ExpectationsFrom(rough));
  return SightingOf(expected, WithColours(fits), [&](int point) {
    return fmt::format("corner {} of row {}", point % board_.columns + 1, point / board_.columns + 1);
  });
}

// Roughly, row by row as the board's points; empty where the board is not found as a whole.
std::vector<Eigen::Vector2d> ChessboardDetector::Find(const GrayImage& image) const {
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  const cv::Size size(board_.columns, board_.rows);
  constexpr int kQuick = cv::CALIB_CB_NORMALIZE_IMAGE;
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCornersSB(view, size, found, kQuick) &&
      !cv::findChessboardCornersSB(view, size, found, kQuick | cv::CALIB_CB_EXHAUSTIVE))
    return {};
  std::vector<Eigen::Vector2d> corners;
  corners.reserve(found.size());
  for (const cv::Point2f& corner : found) corners.emplace_back(corner.x, corner.y);
  // Rows go down where columns go right, seen from the printed side.
  const Eigen::Vector2d right = corners[1] - corners[0], down = corners[At(1, 0)] - corners[0];
  if (right.x() * down.y() - right.y() * down.x() < 0)
    for (int row = 0; row < board_.rows; ++row)
      std::reverse(corners.begin() + row * board_.columns, corners.begin() + (row + 1) * board_.columns);
  return corners;
}

std::vector<ExpectedCorner> ChessboardDetector::Expected(const std::vector<Eigen::Vector2d>& corners) const {
  std::vector<ExpectedCorner> expected;
  for (int row = 0; row < board_.rows; ++row)
    for (int column = 0; column < board_.columns; ++column) {
      const int left = std::max(column - 1, 0), right = std::min(column + 1, board_.columns - 1);
      const int above = std::max(row - 1, 0), below = std::min(row + 1, board_.rows - 1);
      const Eigen::Vector2d step_right = (corners[At(row, right)] - corners[At(row, left)]) / (right - left);
      const Eigen::Vector2d step_down =
          (corners[At(below, column)] - corners[At(above, column)]) / (below - above);
      expected.push_back({static_cast<int>(At(row, column)),
                          {corners[At(row, column)], {step_right, step_down}, DarkSaddle()},
                          {step_right.norm(), step_down.norm()}});
    }
  return expected;
}

// Contrasts below 0 where the colours are not the board's, corners in the order that its colours tell.
std::vector<CornerFit> ChessboardDetector::WithColours(std::vector<CornerFit> fits) const {
  const bool has_ends = (board_.columns + board_.rows) % 2 == 1;
  const bool is_first_dark = DarknessOfFirst(fits) > 0;
  if (has_ends && !is_first_dark) std::reverse(fits.begin(), fits.end());
  for (size_t point = 0; point < fits.size(); ++point)
    fits[point].contrast *= has_ends || is_first_dark ? Colour(point) : -Colour(point);
  return fits;
}

// Above 0 where the square from the first corner towards the middle is dark.
double ChessboardDetector::DarknessOfFirst(const std::vector<CornerFit>& fits) const {
  double sum = 0;
  for (size_t point = 0; point < fits.size(); ++point)
    if (fits[point].status == CornerStatus::kFitted) sum += Colour(point) * fits[point].contrast;
  return sum;
}

// 1 where the square to the bottom-right is as that of the first corner, else -1.
double ChessboardDetector::Colour(size_t point) const {
  const auto columns = static_cast<size_t>(board_.columns);
  return (point % columns + point / columns) % 2 == 0 ? 1 : -1;
}

}  // namespace legible
