// How much of what a board claims its halves bear out.
#include "calib/board/halves.h"

#include <gtest/gtest.h>

#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

constexpr ImageGrid kGrid{12, 9, 0.5};

// Every other view by a camera whose focal length is larger by that share: the halves have one camera each.
BoardCalibrationInput SeenWhileFocusMoves(double share) {
  std::mt19937_64 generator = TestGenerator();
  Camera camera = BoardCamera(LensModel::kBrownConrady), other = camera;
  other.fx_px *= 1 + share;
  other.fy_px *= 1 + share;
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  BoardCalibrationInput input{points, {}, camera.width_px, camera.height_px};
  for (int i = 0; i < 12; ++i)
    for (const Camera& one : {camera, other})
      input.views.push_back(SeeBoard(generator, one, points, {.views = 1, .noise_px = 0.1}).views[0]);
  return input;
}

double FocalSigma_px(const BoardCalibration& found) {
  return std::sqrt(found.information.CameraCovariance()(0, 0));
}

TEST(Widening, LeavesACameraWhoseLensModelFitsToTheBit) {
  const BoardCalibrationInput input = SeenWhileFocusMoves(0);
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  const HalvesComparison halves = CompareHalves(input, found, {}, kGrid);
  ASSERT_FALSE(halves.HasMisfit()) << halves.ratio;
  EXPECT_NEAR(halves.ratio_to_stated / halves.ratio, 1, 0.1);  // two measures of the same noise
  const BoardCalibration widened = Widened(found, halves.Widening());
  EXPECT_EQ(widened.information.information, found.information.information);
  EXPECT_EQ(widened.information.covariance, found.information.covariance);
}

// A hundredth of 1250 px: the whole is half of that from either.
TEST(Widening, CoversTwoFocalLengthsThatTheViewsHaveByTurns) {
  constexpr double kShare = 0.01;
  const BoardCalibrationInput input = SeenWhileFocusMoves(kShare);
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  const HalvesComparison halves = CompareHalves(input, found, {}, kGrid);
  ASSERT_TRUE(halves.HasMisfit());
  const double off_px = kShare / 2 * 1250;
  EXPECT_GT(off_px, 5 * FocalSigma_px(found)) << "nothing to cover";
  EXPECT_LT(off_px, 2 * FocalSigma_px(Widened(found, halves.Widening())));
}

TEST(Widening, CountsInWhatIsSolvedTogetherAsInTheInformation) {
  const BoardCalibrationInput input = SeenWhileFocusMoves(0);
  const BoardCalibration found = CalibrateCamera(input, {});
  for (const double factor : {1.0, 3.0}) {
    const BoardCalibration widened = Widened(found, factor);
    EXPECT_NEAR(FocalSigma_px(widened), factor * FocalSigma_px(found), 1e-9);
    const BoardProblem problem = SolvedProblem(input, widened, {});
    const Eigen::VectorXd scale = widened.information.information.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_TRUE(AreNear(scale.asDiagonal() * InformationOf(problem).information * scale.asDiagonal(),
                        scale.asDiagonal() * widened.information.information * scale.asDiagonal(), 1e-9));
    // What is left of the residuals is the noise: as many squares as freedoms, as far as they count.
    double squares = 0, freedom = -6.0 * static_cast<double>(problem.views.size()) - problem.CameraUnknowns();
    for (const ViewObservation& view : problem.views) {
      squares += ViewErrors(problem.camera, problem.warp, view, Vector6d::Zero())->squaredNorm();
      freedom += 2 * static_cast<double>(view.pixels.size());
    }
    EXPECT_NEAR(squares / freedom, problem.mean_square, 0.05 * problem.mean_square);
  }
}

}  // namespace
}  // namespace legible
