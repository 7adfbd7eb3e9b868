#include "calib/board/board_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

using ::testing::HasSubstr;

const std::vector<Eigen::Vector3d>& Points() {
  static const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  return points;
}

BoardCalibrationInput InputOf(const SyntheticBoardViews& seen) { return {Points(), seen.views, 1280, 960}; }

BoardCalibrationInput Seen(LensModel lens, const SyntheticBoardOptions& options) {
  std::mt19937_64 generator = TestGenerator();
  return InputOf(SeeBoard(generator, BoardCamera(lens), Points(), options));
}

TEST(CalibrateCamera, FindsTheExactCameraFromNoGuess) {
  for (const LensModel lens : {LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady}) {
    const BoardCalibration found = CalibrateCamera(Seen(lens, {.views = 15}), {.lens = lens});
    ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
    EXPECT_LT(found.rms_px, 1e-6);
    EXPECT_TRUE(AreNear(UnknownsOf(found.camera).head<4>(), UnknownsOf(BoardCamera(lens)).head<4>(), 1e-3));
  }
}

// Eight coefficients are known together, not apart: what counts is where they put points.
TEST(CalibrateCamera, FindsARationalLensThatProjectsAsTheTrueOne) {
  std::mt19937_64 generator = TestGenerator();
  const Camera truth = BoardCamera(LensModel::kRational);
  const SyntheticBoardViews seen = SeeBoard(generator, truth, Points(), {.views = 20});
  const BoardCalibration found = CalibrateCamera(InputOf(seen), {.lens = LensModel::kRational});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  EXPECT_LT(found.rms_px, 1e-3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d x(Uniform(generator, -0.4, 0.4), Uniform(generator, -0.3, 0.3), 1);
    EXPECT_TRUE(AreNear(Project(found.camera, x), Project(truth, x), 0.05));
  }
}

TEST(CalibrateCamera, LeavesOutGrossOutliersAndCountsThem) {
  std::mt19937_64 generator = TestGenerator();
  const Camera truth = BoardCamera(LensModel::kBrownConrady);
  const SyntheticBoardViews clean = SeeBoard(generator, truth, Points(), {.views = 15, .noise_px = 0.1});
  SyntheticBoardViews spoilt = clean;
  int count = 0;
  for (BoardView& view : spoilt.views)
    for (size_t k = 3; k < view.corners.size(); k += 50, ++count) view.corners[k].pixel.x() += 20;
  const BoardCalibration found = CalibrateCamera(InputOf(spoilt), {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  EXPECT_EQ(found.corners_left_out, count);
  for (const ViewFit& view : found.views)
    for (size_t k = 0; k < view.weight.size(); ++k)
      EXPECT_EQ(view.weight[k] == 0, k % 50 == 3) << "corner " << k;
  const BoardCalibration without = CalibrateCamera(InputOf(clean), {});
  EXPECT_NEAR(found.camera.fx_px, without.camera.fx_px, std::sqrt(without.information.covariance(0, 0)));
  EXPECT_NEAR(found.noise_factor, 0.1, 0.01);
}

TEST(CalibrateCamera, CountsEveryCornerWholeIfAskedTo) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 10, .noise_px = 0.1});
  input.views[0].corners[5].pixel.x() += 8;
  const BoardCalibration found = CalibrateCamera(input, {.trusts_all = true});
  EXPECT_EQ(found.corners_left_out, 0);
  EXPECT_GT(found.views[0].residual_px[5].norm(), 5);
}

// A view with larger errors that says so moves the camera little.
TEST(CalibrateCamera, WeighsCornersByTheirOwnCovariance) {
  std::mt19937_64 generator = TestGenerator();
  BoardCalibrationInput input = InputOf(
      SeeBoard(generator, BoardCamera(LensModel::kBrownConrady), Points(), {.views = 16, .noise_px = 0.05}));
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < 8; ++i)
    for (BoardCorner& corner : input.views[i].corners) {
      corner.pixel += 0.5 * Eigen::Vector2d(normal(generator), normal(generator));
      corner.covariance_px2 *= 101;
    }
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged);
  EXPECT_NEAR(found.noise_factor, 0.05, 0.003);
  EXPECT_EQ(found.corners_left_out, 0);
}

TEST(CalibrateCamera, FindsTheBendOfABoard) {
  std::mt19937_64 generator = TestGenerator();
  BoardWarp bent = FlatOver(Points());
  bent.bend_m = {1e-3, 0.5e-3};
  std::vector<Eigen::Vector3d> bent_points;
  bent_points.reserve(Points().size());
  for (const Eigen::Vector3d& point : Points())
    bent_points.push_back(point + Eigen::Vector3d(0, 0, bent.ShapeAt(point).dot(bent.bend_m)));
  const BoardCalibrationInput input = InputOf(SeeBoard(generator, BoardCamera(LensModel::kBrownConrady),
                                                       bent_points, {.views = 15, .noise_px = 0.05}));
  const BoardCalibration flat = CalibrateCamera(input, {});
  const BoardCalibration found = CalibrateCamera(input, {.estimates_warp = true});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged);
  EXPECT_TRUE(AreNear(found.warp.bend_m, bent.bend_m, 1e-4));
  EXPECT_GT(flat.noise_factor, 1.3 * found.noise_factor);
}

// --- What cannot be calibrated. --------------------------------------------------------------------------

TEST(CalibrateCamera, RefusesFewerThanThreeViews) {
  const BoardCalibration one =
      CalibrateCamera(Seen(LensModel::kBrownConrady, {.views = 1, .noise_px = 0.1}), {});
  EXPECT_EQ(one.status, BoardCalibrationStatus::kTooFewViews);
  EXPECT_THAT(one.message, HasSubstr("1 view of the board"));
}

TEST(CalibrateCamera, RefusesTheSameViewTenTimes) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 1, .noise_px = 0.1});
  std::mt19937_64 generator = TestGenerator();
  std::normal_distribution<double> normal;
  for (int i = 0; i < 9; ++i) {
    input.views.push_back(input.views[0]);
    for (BoardCorner& corner : input.views.back().corners)
      corner.pixel += 0.1 * Eigen::Vector2d(normal(generator), normal(generator));
  }
  const BoardCalibration found = CalibrateCamera(input, {});
  EXPECT_EQ(found.status, BoardCalibrationStatus::kTooFewViews);
  EXPECT_THAT(found.message, HasSubstr("10 views show the board in the same place"));
}

TEST(CalibrateCamera, RefusesAViewThatNobodySees) {
  const BoardCalibration found = CalibrateCamera({Points(), {BoardView{}, BoardView{}}, 1280, 960}, {});
  EXPECT_EQ(found.status, BoardCalibrationStatus::kTooFewViews);
  EXPECT_THAT(found.message, HasSubstr("no view shows"));
}

TEST(CalibrateCamera, RefusesBoardsParallelToTheImage) {
  const BoardCalibration found = CalibrateCamera(
      Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1, .largest_tilt_rad = 0}), {});
  EXPECT_EQ(found.status, BoardCalibrationStatus::kUndetermined) << found.camera.fx_px;
  EXPECT_THAT(found.message, HasSubstr("tilt the board"));
}

TEST(CalibrateCamera, RefusesABoardThatIsLaidOutOtherwise) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1});
  for (size_t i = 0; i < input.points_in_board_m.size(); ++i) {
    const size_t column = i % 8, row = i / 8;  // as if it had 8 columns instead of 9
    input.points_in_board_m[i] = {0.03 * static_cast<double>(column), -0.03 * static_cast<double>(row), 0};
  }
  EXPECT_EQ(CalibrateCamera(input, {}).status, BoardCalibrationStatus::kNotFlat);
}

TEST(CalibrateCamera, RefusesAHopelessGuessAndSaysBothNumbers) {
  const BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1});
  Camera guess = BoardCamera(LensModel::kBrownConrady);
  guess.fx_px = guess.fy_px = 100;
  const BoardCalibration found = CalibrateCamera(input, {.guess = guess});
  EXPECT_EQ(found.status, BoardCalibrationStatus::kHopelessGuess);
  EXPECT_THAT(found.message, HasSubstr("focal length of 100 px"));
  guess.fx_px = guess.fy_px = 1400;
  EXPECT_EQ(CalibrateCamera(input, {.guess = guess}).status, BoardCalibrationStatus::kConverged);
}

TEST(CalibrateCamera, LeavesOutAViewWithAReason) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1});
  input.views[3].corners.resize(5);
  std::erase_if(input.views[7].corners, [](const BoardCorner& corner) { return corner.point >= 9; });
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged);
  EXPECT_THAT(found.views[3].left_out, HasSubstr("fewer than 6"));
  EXPECT_THAT(found.views[7].left_out, HasSubstr("one line"));
}

// A view that another board was taken for, or that moved while it was taken: the others decide.
TEST(CalibrateCamera, LeavesOutAViewThatContradictsTheOthers) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1});
  std::mt19937_64 generator = TestGenerator();
  for (BoardCorner& corner : input.views[5].corners)
    corner.pixel += UniformVector(generator, -9, 9).head<2>();
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  EXPECT_THAT(found.views[5].left_out, HasSubstr("contradicts the others"));
  EXPECT_NEAR(found.noise_factor, 0.1, 0.01);
  EXPECT_NEAR(found.camera.fx_px, BoardCamera(LensModel::kBrownConrady).fx_px,
              4 * std::sqrt(found.information.covariance(0, 0)));
}

TEST(CalibrateCamera, LeavesOutAViewThatNoPoseExplains) {
  BoardCalibrationInput input = Seen(LensModel::kBrownConrady, {.views = 12, .noise_px = 0.1});
  std::vector<BoardCorner>& corners = input.views[5].corners;
  for (size_t k = 0; k < corners.size() / 2; ++k)  // in each other's places
    std::swap(corners[k].pixel, corners[corners.size() - 1 - (7 * k) % (corners.size() / 2)].pixel);
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  EXPECT_NE(found.views[5].left_out, "");
  EXPECT_NEAR(found.noise_factor, 0.1, 0.01);
}

}  // namespace
}  // namespace legible
