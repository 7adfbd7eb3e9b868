#include "apps/progress.h"

#include <gmock/gmock.h>

#include <sstream>

namespace legible {
namespace {

TEST(Progress, IsSilentWhereThereIsNoTerminal) {
  std::ostringstream out, err;
  {
    ProgressLine line({out, err, false});
    line.Show("finding edges 1 of 2");
  }
  EXPECT_EQ(err.str(), "");
}

TEST(Progress, RewritesItsLineOnATerminalAndLeavesItEmpty) {
  std::ostringstream out, err;
  {
    ProgressLine line({out, err, true});
    line.Show("one");
    line.Show("two");
  }
  EXPECT_EQ(err.str(), "\r\x1b[Kone\r\x1b[Ktwo\r\x1b[K");
  EXPECT_EQ(out.str(), "");
}

TEST(Progress, NamesStageAndNumbers) {
  EXPECT_EQ(StageText("finding edges", 12, 40), "finding edges 12 of 40");
  EXPECT_EQ(StageText("checking", 0, 1), "checking");
  EXPECT_EQ(IterationText(7, 0.0521), "solving, iteration 7: 0.052 px");
}

}  // namespace
}  // namespace legible
