// How much of what a board claims its halves bear out.
#include "calib/board/halves.h"

#include <gtest/gtest.h>

#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

constexpr ImageGrid kGrid{12, 9, 0.5};

BoardCalibrationInput SeenByABrownConradyCamera() {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = BoardCamera(LensModel::kBrownConrady);
  const std::vector<Eigen::Vector3d> points = PointsOf(DeskChessboard());
  return {points, SeeBoard(generator, camera, points, {.views = 24, .noise_px = 0.1}).views, camera.width_px,
          camera.height_px};
}

BoardCalibrationOptions With(LensModel lens) {
  BoardCalibrationOptions options;
  options.lens = lens;
  return options;
}

double FocalSigma_px(const BoardCalibration& found) {
  return std::sqrt(found.information.CameraCovariance()(0, 0));
}

TEST(Widening, LeavesACameraWhoseLensModelFitsToTheBit) {
  const BoardCalibrationInput input = SeenByABrownConradyCamera();
  const BoardCalibration found = CalibrateCamera(input, {});
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  const HalvesComparison halves = CompareHalves(input, found, {}, kGrid);
  ASSERT_FALSE(halves.HasMisfit()) << halves.ratio;
  EXPECT_LT(halves.ratio_to_stated, 1.76);  // a chi-square of nine, 999 times in 1000
  const BoardCalibration widened = Widened(found, halves.Widening());
  EXPECT_EQ(widened.information.information, found.information.information);
  EXPECT_EQ(widened.information.covariance, found.information.covariance);
}

// Of a lens with distortion, described by one without.
TEST(Widening, MakesTheHalvesDifferByNoMoreThanTheyClaim) {
  const BoardCalibrationInput input = SeenByABrownConradyCamera();
  const BoardCalibrationOptions options = With(LensModel::kPinhole);
  const BoardCalibration found = CalibrateCamera(input, options);
  ASSERT_EQ(found.status, BoardCalibrationStatus::kConverged) << found.message;
  const HalvesComparison halves = CompareHalves(input, found, options, kGrid);
  ASSERT_TRUE(halves.HasMisfit()) << halves.ratio;
  EXPECT_GE(halves.Widening(), 1);
  const BoardCalibration widened = Widened(found, halves.Widening());
  EXPECT_NEAR(FocalSigma_px(widened), halves.ratio_to_stated * FocalSigma_px(found),
              1e-9 * FocalSigma_px(widened));
}

TEST(Widening, CountsInWhatIsSolvedTogetherAsInTheInformation) {
  const BoardCalibrationInput input = SeenByABrownConradyCamera();
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
