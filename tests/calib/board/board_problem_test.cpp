#include "calib/board/board_problem.h"

#include <gtest/gtest.h>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

constexpr LensModel kLenses[] = {LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady,
                                 LensModel::kRational};

// One view with few corners, off its optimum, with a whitening that mixes x and y.
struct Case {
  Camera camera;
  BoardWarp warp;
  ViewObservation view;
  Vector6d displacement;
};

Case RandomCase(std::mt19937_64& generator, LensModel lens) {
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  Case one{BoardCamera(lens), FlatOver(points), {}, {}};
  one.warp.bend_m = {2e-3, -1e-3};
  const SyntheticBoardViews seen = SeeBoard(generator, one.camera, points, {.views = 1});
  one.view.camera_from_board = seen.camera_from_board[0];
  for (size_t k = 0; k < 5; ++k) {
    const BoardCorner& corner = seen.views[0].corners[7 * k];
    one.view.points_in_board_m.push_back(points[static_cast<size_t>(corner.point)]);
    one.view.pixels.push_back(corner.pixel + Eigen::Vector2d(1, -2));
    one.view.whitening_per_px.push_back((Eigen::Matrix2d() << 2, 0, 0.5, 3).finished());
  }
  one.displacement << UniformVector(generator, -0.01, 0.01), UniformVector(generator, -0.1, 0.1);
  return one;
}

using Rows = Eigen::Matrix<double, 10, 1>;

TEST(EvaluateView, DerivativesMatchCentralDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : kLenses) {
    const Case c = RandomCase(generator, lens);
    const auto found = EvaluateView(c.camera, c.warp, c.view, c.displacement);
    ASSERT_TRUE(found.has_value());
    const auto by_pose = [&](const Vector6d& displacement) -> Rows {
      return *ViewErrors(c.camera, c.warp, c.view, displacement);
    };
    EXPECT_TRUE(AreNear(found->d_pose, NumericJacobian(by_pose, c.displacement), 1e-4));
    const auto by_warp = [&](const Eigen::Vector2d& bend_m) -> Rows {
      BoardWarp warp = c.warp;
      warp.bend_m = bend_m;
      return *ViewErrors(c.camera, warp, c.view, c.displacement);
    };
    EXPECT_TRUE(AreNear(found->d_warp, NumericJacobian(by_warp, c.warp.bend_m), 1e-4));
    const Eigen::VectorXd unknowns = UnknownsOf(c.camera);
    for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
      const auto by_one = [&](const Eigen::Matrix<double, 1, 1>& value) -> Rows {
        Eigen::VectorXd moved = unknowns;
        moved[i] = value[0];
        return *ViewErrors(WithUnknowns(c.camera, moved), c.warp, c.view, c.displacement);
      };
      EXPECT_TRUE(AreNear(found->d_camera.col(i),
                          NumericJacobian(by_one, Eigen::Matrix<double, 1, 1>(unknowns[i])), 1e-6))
          << "lens " << static_cast<int>(lens) << ", unknown " << i;
    }
  }
}

TEST(EvaluateView, ErrorsAreTheResidualsOfBothFunctions) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : kLenses) {
    const Case c = RandomCase(generator, lens);
    EXPECT_TRUE(AreNear(EvaluateView(c.camera, c.warp, c.view, c.displacement)->residual,
                        *ViewErrors(c.camera, c.warp, c.view, c.displacement), 1e-9));
  }
}

TEST(EvaluateView, ACornerThatDoesNotCountHasNoInfluenceEvenBehindTheCamera) {
  std::mt19937_64 generator = TestGenerator();
  Case c = RandomCase(generator, LensModel::kRational);
  c.view.points_in_board_m[2] = Inverse(c.view.camera_from_board) * Eigen::Vector3d(0, 0, -1);
  EXPECT_FALSE(EvaluateView(c.camera, c.warp, c.view, Vector6d::Zero()).has_value());
  c.view.whitening_per_px[2].setZero();
  const auto found = EvaluateView(c.camera, c.warp, c.view, Vector6d::Zero());
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->residual.segment<2>(4).isZero(0));
  EXPECT_TRUE(found->d_pose.middleRows<2>(4).isZero(0));
}

TEST(SolveBoard, FindsTheExactCameraPosesAndBendFromNearby) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  for (const LensModel lens : kLenses) {
    const Camera truth = BoardCamera(lens);
    BoardWarp bent = FlatOver(points);
    bent.bend_m = {1.5e-3, -0.8e-3};
    std::vector<Eigen::Vector3d> bent_points;
    bent_points.reserve(points.size());
    for (const Eigen::Vector3d& point : points)
      bent_points.push_back(point + Eigen::Vector3d(0, 0, bent.ShapeAt(point).dot(bent.bend_m)));
    const SyntheticBoardViews seen = SeeBoard(generator, truth, bent_points, {.views = 12});
    BoardProblem problem{truth, {}, FlatOver(points), true};
    problem.camera.fx_px *= 1.02;
    problem.camera.cy_px += 5;
    problem.camera.distortion.setZero();
    for (size_t i = 0; i < seen.views.size(); ++i) {
      ViewObservation view{Displaced(seen.camera_from_board[i], 0.01 * Vector6d::Ones()), {}, {}, {}};
      for (const BoardCorner& corner : seen.views[i].corners) {
        view.points_in_board_m.push_back(points[static_cast<size_t>(corner.point)]);
        view.pixels.push_back(corner.pixel);
        view.whitening_per_px.push_back(Eigen::Matrix2d::Identity());
      }
      problem.views.push_back(view);
    }
    EXPECT_TRUE(SolveBoard(problem, {.max_iterations = 200, .relative_tolerance = 1e-16}).cost < 1e-10);
    EXPECT_TRUE(AreNear(UnknownsOf(problem.camera).head<4>(), UnknownsOf(truth).head<4>(), 1e-4));
    EXPECT_TRUE(AreNear(problem.warp.bend_m, bent.bend_m, 1e-8));
  }
}

}  // namespace
}  // namespace legible
