#include "accuracy/index_ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace legible {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(KendallTau, IsOneForTheSameOrderAndMinusOneForTheReverse) {
  EXPECT_EQ(KendallTau({1, 2, 3, 4}, {10, 20, 30, kInfinity}), 1);
  EXPECT_EQ(KendallTau({1, 2, 3, 4}, {4, 3, 2, 1}), -1);
  EXPECT_EQ(KendallTau({1, 1, 1}, {1, 2, 3}), 0);
}

TEST(KendallTau, IsOneLessTwiceTheShareOfInversions) {
  EXPECT_NEAR(KendallTau({1, 2, 3, 4, 5}, {3, 1, 2, 5, 4}), 1 - 2 * 3.0 / 10, 1e-15);
}

TEST(KendallTau, CountsTiesByTheSquareRootOfBothUntied) {
  // 5 of 6 pairs untied in each, one tie each in different pairs: 4 concordant.
  EXPECT_NEAR(KendallTau({1, 1, 2, 3}, {1, 2, 3, 3}), 4 / 5.0, 1e-15);
}

TEST(KendallTau, RefusesListsThatDoNotFit) {
  EXPECT_THROW(KendallTau({1, 2}, {1}), std::invalid_argument);
  EXPECT_THROW(KendallTau({1, std::nan("")}, {1, 2}), std::invalid_argument);
}

TEST(RankAgainstErrors, NamesTheWorstInversionsAndCountsOnlyPairsThatDifferClearly) {
  // Errors 1, 1.05 differ by less than a tenth: their inversion is named but not counted.
  const Ranking ranking = RankAgainstErrors({2, 1, 3, 0}, {1, 1.05, 2, 3}, 5);
  EXPECT_EQ(ranking.clear_pairs, 5u);
  EXPECT_NEAR(ranking.misranked, 3 / 5.0, 1e-15);  // item 3 against 0, 1, 2
  ASSERT_FALSE(ranking.worst.empty());
  EXPECT_EQ(ranking.worst[0].preferred, 3u);
  EXPECT_EQ(ranking.worst[0].rejected, 0u);
}

TEST(RankAgainstErrors, AnIndexThatCannotTellPosesApartMisranksThem) {
  EXPECT_EQ(RankAgainstErrors({1, 1, 1}, {1, 2, 4}, 3).misranked, 1);
  EXPECT_EQ(RankAgainstErrors({1, 2, 4}, {1, 2, 4}, 3).misranked, 0);
}

}  // namespace
}  // namespace legible
