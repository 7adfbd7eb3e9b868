// Whether a camera scatters as its covariance says, and no more than the corners force it to.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <atomic>
#include <boost/math/distributions/chi_squared.hpp>
#include <iostream>
#include <thread>

#include "calib/board/board_calibration.h"
#include "calib/board/halves.h"
#include "calib/board/neighbour_scatter.h"
#include "calib/board/pixel_uncertainty.h"
#include "tests/testing/random.h"
#include "tests/testing/synthetic_board.h"

namespace legible {
namespace {

constexpr int kRuns = 400;
constexpr double kNoise_px = 0.2;

struct Estimate {
  bool converged = false;
  Eigen::VectorXd error, sigma;
  double squared_error = 0;  // error^T covariance^-1 error
};

// Views of a board whose noise is drawn again and again.
class Experiment {
 public:
  explicit Experiment(LensModel lens, double outlier_share = 0)
      : truth_(BoardCamera(lens)), points_(PointsOf(DeskChessboard())), outlier_share_(outlier_share) {
    std::mt19937_64 generator = TestGenerator();
    exact_ = SeeBoard(generator, truth_, points_, {.views = 16});
    seed_ = generator();
    // The Cramér-Rao bound: the information at the truth for exactly this noise.
    BoardProblem problem{truth_, {}, FlatOver(points_), false};
    for (size_t i = 0; i < exact_.views.size(); ++i) {
      ViewObservation view{exact_.camera_from_board[i], {}, {}, {}};
      for (const BoardCorner& corner : exact_.views[i].corners) {
        view.points_in_board_m.push_back(points_[static_cast<size_t>(corner.point)]);
        view.pixels.push_back(corner.pixel);
        view.whitening_per_px.push_back(Eigen::Matrix2d::Identity() / kNoise_px);
      }
      problem.views.push_back(view);
    }
    bound_ = InformationOf(problem).CameraCovariance().diagonal().cwiseSqrt();
  }

  const Eigen::VectorXd& bound() const { return bound_; }
  const Camera& truth() const { return truth_; }

  BoardCalibrationInput Drawn(int run, double noise_px) const {
    std::mt19937_64 generator(seed_ + static_cast<std::uint64_t>(run));
    std::normal_distribution<double> normal;
    BoardCalibrationInput input{points_, exact_.views, truth_.width_px, truth_.height_px};
    for (BoardView& view : input.views)
      for (BoardCorner& corner : view.corners) {
        corner.pixel += noise_px * Eigen::Vector2d(normal(generator), normal(generator));
        if (Uniform(generator, 0, 1) < outlier_share_)
          corner.pixel += UniformVector(generator, -50, 50).head<2>();
      }
    return input;
  }
  BoardCalibration Calibrate(const BoardCalibrationInput& input) const {
    return CalibrateCamera(input, {.lens = truth_.lens});
  }

  std::vector<Estimate> Run() const {
    std::vector<Estimate> estimates(kRuns);
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int i = next++; i < kRuns; i = next++) {
        const BoardCalibration found = Calibrate(Drawn(i + 1, kNoise_px));
        Estimate& estimate = estimates[static_cast<size_t>(i)];
        estimate.converged = found.status == BoardCalibrationStatus::kConverged;
        if (!estimate.converged) continue;
        const Eigen::MatrixXd covariance = found.information.CameraCovariance();
        estimate.error = UnknownsOf(found.camera) - UnknownsOf(truth_);
        estimate.sigma = covariance.diagonal().cwiseSqrt();
        estimate.squared_error = estimate.error.dot(covariance.ldlt().solve(estimate.error));
      }
    };
    std::thread other(work);
    work();
    other.join();
    return estimates;
  }

 private:
  Camera truth_;
  std::vector<Eigen::Vector3d> points_;
  double outlier_share_;
  SyntheticBoardViews exact_;
  std::uint64_t seed_ = 0;
  Eigen::VectorXd bound_;
};

// Root mean square over runs and parameters of errors in units of the bound.
double PooledRatio(const std::vector<Estimate>& estimates, const Eigen::VectorXd& bound) {
  double squares = 0;
  for (const Estimate& estimate : estimates) squares += estimate.error.cwiseQuotient(bound).squaredNorm();
  return std::sqrt(squares / static_cast<double>(estimates.size()) / static_cast<double>(bound.size()));
}

// The largest gap between the errors' distribution and that of chi-square.
double KolmogorovSmirnov(const std::vector<Estimate>& estimates, double freedom) {
  const boost::math::chi_squared expected(freedom);
  std::vector<double> values;
  values.reserve(estimates.size());
  for (const Estimate& estimate : estimates) values.push_back(cdf(expected, estimate.squared_error));
  std::sort(values.begin(), values.end());
  double gap = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double n = static_cast<double>(values.size());
    gap = std::max({gap, std::abs(values[i] - static_cast<double>(i) / n),
                    std::abs(values[i] - static_cast<double>(i + 1) / n)});
  }
  return gap;
}

class CameraStatistics : public testing::TestWithParam<LensModel> {};

TEST_P(CameraStatistics, ScatterMeetsTheBoundAndTheCovarianceIsHonest) {
  const Experiment experiment(GetParam());
  const std::vector<Estimate> estimates = experiment.Run();
  for (const Estimate& estimate : estimates) ASSERT_TRUE(estimate.converged);
  const double ratio = PooledRatio(estimates, experiment.bound());
  std::cout << "scatter over bound " << ratio << "\n";
  EXPECT_GT(ratio, 0.95);
  EXPECT_LT(ratio, 1.05);
  double mean = 0;
  for (const Estimate& estimate : estimates) mean += estimate.squared_error / kRuns;
  const double freedom = static_cast<double>(experiment.bound().size());
  std::cout << "normalised squared error " << mean / freedom << "\n";
  EXPECT_NEAR(mean / freedom, 1, 4 * std::sqrt(2 / freedom / kRuns) + 0.02);
  // 1 in 1000 right samples have a larger gap.
  const double gap = KolmogorovSmirnov(estimates, freedom);
  std::cout << "Kolmogorov-Smirnov gap " << gap << "\n";
  EXPECT_LT(gap, 1.95 / std::sqrt(kRuns));
}

std::string NameOf(const testing::TestParamInfo<LensModel>& lens) {
  if (lens.param == LensModel::kPinhole) return "Pinhole";
  return lens.param == LensModel::kFisheye ? "Fisheye" : "BrownConrady";
}

INSTANTIATE_TEST_SUITE_P(Lenses, CameraStatistics,
                         testing::Values(LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady),
                         NameOf);

TEST(CameraStatistics, TwoPercentGrossOutliersCostLessThanTenPercent) {
  const Experiment clean(LensModel::kBrownConrady), spoilt(LensModel::kBrownConrady, 0.02);
  const std::vector<Estimate> with = spoilt.Run();
  for (const Estimate& estimate : with) ASSERT_TRUE(estimate.converged);
  const double without = PooledRatio(clean.Run(), clean.bound());
  const double ratio = PooledRatio(with, clean.bound());
  std::cout << "scatter over bound " << without << ", with outliers " << ratio << "\n";
  EXPECT_LT(ratio, 1.1 * without);
}

// What is drawn as the uncertainty over the image is how points before the boards scatter in it.
TEST(CameraStatistics, PointsBeforeTheBoardsScatterInTheImageAsTheMapSays) {
  const Experiment experiment(LensModel::kBrownConrady);
  const ImageGrid grid{4, 3, 0.5};
  const BoardCalibration reference = experiment.Calibrate(experiment.Drawn(0, 0));
  const std::vector<GridPoint> points = PointsOver(experiment.truth(), grid);
  std::vector<double> squares(points.size()), expected(points.size());
  for (int run = 1; run <= kRuns; ++run) {
    const BoardCalibration found = experiment.Calibrate(experiment.Drawn(run, kNoise_px));
    for (size_t i = 0; i < points.size(); ++i) {
      // The point as it stands before each board, seen by the camera that was found, on average.
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (size_t view = 0; view < found.views.size(); ++view) {
        const Eigen::Vector3d in_board =
            Inverse(reference.views[view].camera_from_board) * points[i].x_in_camera;
        mean += Project(found.camera, found.views[view].camera_from_board * in_board);
      }
      mean /= static_cast<double>(found.views.size());
      squares[i] += (mean - points[i].pixel).squaredNorm() / kRuns;
      Eigen::MatrixXd by_all(2, found.information.covariance.cols());
      by_all << points[i].d_unknowns, points[i].d_motion;
      expected[i] += (by_all * found.information.covariance * by_all.transpose()).trace() / kRuns;
    }
  }
  double ratio = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    ratio += squares[i] / expected[i] / static_cast<double>(points.size());
    EXPECT_NEAR(squares[i] / expected[i], 1, 0.3) << points[i].pixel.transpose();
  }
  std::cout << "mean square over expected " << ratio << "\n";
  EXPECT_NEAR(ratio, 1, 0.12);
}

// A right model is called wrong once in a thousand times; a lens that lacks what the camera has always.
TEST(CameraStatistics, HalvesAgreeForTheRightLensAndNotForAPoorerOne) {
  const Experiment experiment(LensModel::kBrownConrady);
  int alarms = 0, poorer_alarms = 0, poorer_smooth = 0;
  double squares = 0;
  constexpr int kComparisons = 100;
  for (int run = 1; run <= kComparisons; ++run) {
    const BoardCalibrationInput input = experiment.Drawn(run, kNoise_px);
    const BoardCalibration found = experiment.Calibrate(input);
    const HalvesComparison right = CompareHalves(input, found, {}, {12, 9, 0.5});
    ASSERT_EQ(right.why_not, "");
    alarms += right.HasMisfit();
    squares += right.ratio * right.ratio / kComparisons;
    const BoardCalibrationOptions pinhole{.lens = LensModel::kPinhole};
    const BoardCalibration poorer = CalibrateCamera(input, pinhole);
    poorer_alarms += CompareHalves(input, poorer, pinhole, {12, 9, 0.5}).HasMisfit();
    poorer_smooth += poorer.noise_factor > 2 * NeighbourScatter(input, poorer, false).value();
    EXPECT_NEAR(NeighbourScatter(input, found, false).value() / found.noise_factor, 1, 0.1);
  }
  std::cout << "mean squared ratio " << squares << ", alarms " << alarms << ", of the poorer lens "
            << poorer_alarms << " by its halves and " << poorer_smooth << " by its neighbours\n";
  EXPECT_NEAR(squares, 1, 0.25);
  EXPECT_LE(alarms, 2);
  // Two halves that err alike are told by their corners against their neighbours.
  EXPECT_GT(poorer_alarms, kComparisons / 2);
  EXPECT_EQ(poorer_smooth, kComparisons);
}

}  // namespace
}  // namespace legible
