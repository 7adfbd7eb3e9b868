#include "calib/board/board_start.h"

#include <gtest/gtest.h>

#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

std::vector<ViewObservation> Observe(const SyntheticBoardViews& seen,
                                     const std::vector<Eigen::Vector3d>& points) {
  std::vector<ViewObservation> views;
  views.reserve(seen.views.size());
  for (const BoardView& view : seen.views) {
    ViewObservation one;
    for (const BoardCorner& corner : view.corners) {
      one.points_in_board_m.push_back(points[static_cast<size_t>(corner.point)]);
      one.pixels.push_back(corner.pixel);
      one.whitening_per_px.push_back(Eigen::Matrix2d::Identity());
    }
    views.push_back(one);
  }
  return views;
}

Camera CentredPinhole(double fx_px) {
  return {1280, 960, fx_px, fx_px, 639.5, 479.5, LensModel::kPinhole, Distortion::Zero()};
}

TEST(FocalLengthOf, IsExactForAPinholeWithCentredAxis) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  for (const double fx_px : {400.0, 1250.0, 5000.0}) {
    const SyntheticBoardViews seen = SeeBoard(generator, CentredPinhole(fx_px), points, {.views = 8});
    const StraightenedViews straight = Straighten(Observe(seen, points), 1280, 960, false);
    const std::optional<double> focal_length = FocalLengthOf(straight);
    ASSERT_TRUE(focal_length.has_value());
    EXPECT_NEAR(*focal_length * straight.unit_px / fx_px, 1, 1e-6);
  }
}

TEST(FocalLengthOf, IsNothingForBoardsParallelToTheImage) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  const SyntheticBoardViews seen =
      SeeBoard(generator, CentredPinhole(1250), points, {.views = 8, .largest_tilt_rad = 0});
  const std::optional<double> focal_length =
      FocalLengthOf(Straighten(Observe(seen, points), 1280, 960, false));
  // Out of rounding, if at all: nowhere near the true one.
  EXPECT_TRUE(!focal_length || std::abs(std::log(*focal_length * 800 / 1250)) > 1) << *focal_length;
}

TEST(Straighten, FindsTheDivisionModelThatBentTheImage) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  for (const double lambda : {-0.5, -0.2, 0.0, 0.15}) {
    SyntheticBoardViews seen =
        SeeBoard(generator, CentredPinhole(1000), points, {.views = 12, .largest_tilt_rad = 0.5});
    for (BoardView& view : seen.views)
      for (BoardCorner& corner : view.corners) {
        const Eigen::Vector2d x = (corner.pixel - Eigen::Vector2d(639.5, 479.5)) / 800;
        corner.pixel =
            Eigen::Vector2d(639.5, 479.5) + 800 * x * 2 / (1 + std::sqrt(1 - 4 * lambda * x.squaredNorm()));
      }
    EXPECT_NEAR(Straighten(Observe(seen, points), 1280, 960, true).lambda, lambda, 0.01);
  }
}

TEST(ProblemAt, PutsTheBoardsWhereTheyStand) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  const SyntheticBoardViews seen = SeeBoard(generator, CentredPinhole(1250), points, {.views = 8});
  const std::vector<ViewObservation> views = Observe(seen, points);
  const BoardProblem problem =
      ProblemAt(Straighten(views, 1280, 960, false), 1250 / 800.0, LensModel::kPinhole, 1280, 960, views);
  for (size_t i = 0; i < views.size(); ++i)
    EXPECT_LT(Displacement(seen.camera_from_board[i], problem.views[i].camera_from_board).norm(), 1e-5);
}

}  // namespace
}  // namespace legible
