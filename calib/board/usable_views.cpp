#include "calib/board/usable_views.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace legible {
namespace {

constexpr double kSameView = 5e-3;      // of the image's diagonal: views whose corners differ by less
constexpr double kCommonCorners = 0.7;  // of the fewer: that two views of one place have in common

// The pixel of each of the board's points in a view; NaN where it is not seen.
using PixelOfPoint = std::vector<Eigen::Vector2d>;

PixelOfPoint PixelsByPoint(const BoardView& view, size_t points) {
  PixelOfPoint pixels(points, Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (const BoardCorner& corner : view.corners) pixels[static_cast<size_t>(corner.point)] = corner.pixel;
  return pixels;
}

// Whether two views show the board in the same place, by the corners that both have.
bool AreSame(const PixelOfPoint& a, const PixelOfPoint& b, double tolerance_px) {
  double squares = 0, common = 0, of_a = 0, of_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const bool in_a = !std::isnan(a[i].x()), in_b = !std::isnan(b[i].x());
    of_a += in_a;
    of_b += in_b;
    if (!in_a || !in_b) continue;
    squares += (a[i] - b[i]).squaredNorm();
    common += 1;
  }
  return common > kCommonCorners * std::min(of_a, of_b) && squares <= tolerance_px * tolerance_px * common;
}

}  // namespace

bool AreOnOneLine(const ViewObservation& view) {
  constexpr double kLeastWidth = 0.02;  // of the length
  const Eigen::Index count = static_cast<Eigen::Index>(view.pixels.size());
  Eigen::MatrixX2d on_board(count, 2), in_image(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    on_board.row(k) = view.points_in_board_m[static_cast<size_t>(k)].head<2>();
    in_image.row(k) = view.pixels[static_cast<size_t>(k)];
  }
  const auto is_narrow = [](Eigen::MatrixX2d points) {
    points.rowwise() -= points.colwise().mean();
    const Eigen::Vector2d widths = points.jacobiSvd().singularValues();
    return !(widths[1] > kLeastWidth * widths[0]);
  };
  return is_narrow(on_board) || is_narrow(in_image);
}

int CountDistinctViews(const BoardCalibrationInput& input, const std::vector<size_t>& views) {
  const double tolerance_px = kSameView * std::hypot(input.width_px, input.height_px);
  std::vector<PixelOfPoint> distinct;
  for (const size_t view : views) {
    PixelOfPoint seen = PixelsByPoint(input.views[view], input.points_in_board_m.size());
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const PixelOfPoint& other) { return AreSame(seen, other, tolerance_px); }))
      distinct.push_back(std::move(seen));
  }
  return static_cast<int>(distinct.size());
}

}  // namespace legible
