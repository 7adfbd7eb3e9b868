#include "calib/image_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib/image_information.h"
#include "calib/observability.h"
#include "calib/shared_information.h"
#include "tests/calib/truth_problem.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kReadingSigma_m = 2e-5;
constexpr EdgeNoise kNoise = {0.8, 0.6, 0.5};

Eigen::MatrixXd InformationOf(const EstimationProblem& problem, const SyntheticSession& session,
                              size_t image) {
  return ImageInformation(problem, session.observations[image], problem.units[image].camera_from_platform,
                          kReadingSigma_m, kNoise);
}

TEST(ImageInformation, IsWhatTheImageAddsToTheInformationOfAProblem) {
  const SyntheticSession session = SmallSession();
  EstimationProblem problem =
      ProblemAtTruth(session, session.observations, {.lasting_shading_px = 0.05, .noise = kNoise});
  problem.base_joint_sigma_m = 1e-3;
  const Eigen::MatrixXd with = SharedInformation(problem);
  const Eigen::MatrixXd of_image = InformationOf(problem, session, 1);
  problem.units.erase(problem.units.begin() + 1);
  const Eigen::MatrixXd difference = with - SharedInformation(problem);
  const Eigen::VectorXd scale =
      with.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 0.0; });
  EXPECT_TRUE(AreNear(scale.asDiagonal() * of_image * scale.asDiagonal(),
                      scale.asDiagonal() * difference * scale.asDiagonal(), 1e-9));
  EXPECT_GT(of_image.norm(), 0);
}

TEST(RootOf, GivesBackASemiDefiniteMatrixWithAsManyRowsAsItsRank) {
  std::mt19937_64 generator = TestGenerator();
  Eigen::MatrixXd root(5, 12);
  for (double& entry : root.reshaped()) entry = Uniform(generator, -1, 1);
  root.col(3).setZero();
  root.col(7) *= 1e6;  // another unit
  const Eigen::MatrixXd matrix = root.transpose() * root;
  const Eigen::MatrixXd found = RootOf(matrix);
  EXPECT_EQ(found.rows(), 5);
  EXPECT_TRUE(AreNear(found.transpose() * found, matrix, 1e-9 * matrix.norm()));
  EXPECT_EQ(RootOf(Eigen::MatrixXd::Zero(4, 4)).rows(), 0);
}

// Random images of random parameters, of few observations each.
class ImageChoices : public testing::Test {
 protected:
  ImageChoices() {
    std::mt19937_64 generator = TestGenerator();
    const auto draw = [&](Eigen::Index rows) {
      Eigen::MatrixXd matrix(rows, kParameters);
      for (double& entry : matrix.reshaped()) entry = Uniform(generator, -1, 1);
      return matrix;
    };
    roots_.reserve(15);
    for (int i = 0; i < 15; ++i) roots_.push_back(draw(3));
    q_ = draw(4);
    information_ = draw(2).transpose() * draw(2);
    information_ = (information_ * information_.transpose()).eval();
  }

  ImageChoice Choice() const {
    return {Eigen::MatrixXd::Identity(kParameters, kParameters), 2, q_, roots_, 2};
  }
  double UncertaintyWith(const std::vector<size_t>& images) const {
    Eigen::MatrixXd information = information_ + Eigen::MatrixXd::Identity(kParameters, kParameters) / 4;
    for (const size_t i : images) information += roots_[i].transpose() * roots_[i];
    return (q_ * information.inverse() * q_.transpose()).trace();
  }

  static constexpr Eigen::Index kParameters = 9;
  std::vector<Eigen::MatrixXd> roots_;
  Eigen::MatrixXd q_, information_;
  std::vector<bool> none_ = std::vector<bool>(15, false);
};

TEST_F(ImageChoices, GainIsWhatTheUncertaintyFallsBy) {
  const std::vector<double> gains = Choice().Gains(information_, none_);
  for (size_t i = 0; i < roots_.size(); ++i)
    EXPECT_NEAR(gains[i], UncertaintyWith({}) - UncertaintyWith({i}), 1e-9 * UncertaintyWith({}));
}

TEST_F(ImageChoices, BestIsTheOneOfLeastUncertaintyThatIsNotTaken) {
  std::vector<size_t> order(roots_.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return UncertaintyWith({a}) < UncertaintyWith({b}); });
  std::vector<bool> taken = none_;
  for (const size_t expected : order) {
    EXPECT_EQ(Choice().Best(information_, taken), expected);
    EXPECT_EQ(Choice().BestTogether(information_, taken, 1, 2), std::vector<size_t>{expected});
    taken[expected] = true;
  }
  EXPECT_EQ(Choice().Best(information_, taken), roots_.size());
  EXPECT_TRUE(Choice().BestTogether(information_, taken, 3, 2).empty());
}

TEST_F(ImageChoices, NoExchangeImprovesWhatIsBestTogether) {
  const std::vector<size_t> chosen = Choice().BestTogether(information_, none_, 3, 50);
  ASSERT_EQ(chosen.size(), 3);
  for (size_t place = 0; place < 3; ++place)
    for (size_t other = 0; other < roots_.size(); ++other) {
      std::vector<size_t> exchanged = chosen;
      if (std::find(chosen.begin(), chosen.end(), other) != chosen.end()) continue;
      exchanged[place] = other;
      EXPECT_GE(UncertaintyWith(exchanged), UncertaintyWith(chosen) * (1 - 1e-9));
    }
  EXPECT_LE(UncertaintyWith({chosen[0]}), UncertaintyWith({chosen[1]}));
  EXPECT_LE(UncertaintyWith({chosen[1]}), UncertaintyWith({chosen[2]}));
}

TEST_F(ImageChoices, TakesAllWhereFewerAreLeftThanAskedFor) {
  std::vector<bool> taken(15, true);
  taken[4] = taken[11] = false;
  std::vector<size_t> chosen = Choice().BestTogether(information_, taken, 6, 2);
  std::sort(chosen.begin(), chosen.end());
  EXPECT_EQ(chosen, (std::vector<size_t>{4, 11}));
}

}  // namespace
}  // namespace legible
