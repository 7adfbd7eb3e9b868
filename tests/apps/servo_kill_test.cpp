// `legible servo` as a process, killed in the middle: its cycles up to then can be replayed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "apps/servo_log.h"
#include "tests/apps/process.h"
#include "tests/apps/simulated_rigs.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kKills = 20;

class ServoKilled : public RigOnDisk {
 protected:
  ServoKilled() : RigOnDisk(640) {}

  fs::path log() const { return folder_.path() / "log"; }

  std::vector<std::string> Command(const std::vector<std::string>& options) const {
    std::vector<std::string> command = {"servo",
                                        truth(),
                                        "--rig",
                                        "sim:" + truth().string(),
                                        "--image-free",
                                        "--goal-pose",
                                        "0.01 -0.005 0.335 0.03 -0.04 0.05",
                                        "--log",
                                        log()};
    command.insert(command.end(), options.begin(), options.end());
    return command;
  }

  // A servo of thousands of cycles, killed when it has written about that many; false: it has ended before.
  bool KillAfterCycles(std::ptrdiff_t cycles, const fs::path& growing) const {
    std::vector<std::string> command = Command({"--gain", "0.1", "--timeout", "1000"});
    command.insert(command.begin(), LEGIBLE_PROGRAM);
    Process process(command);
    const auto lines = [&] {
      std::ifstream file(growing / "cycles.csv");
      return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    };
    while (lines() < cycles && process.IsRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return process.Kill();
  }

  std::map<std::string, std::string> FilesOfLog() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(log()))
      if (entry.is_regular_file()) files[entry.path().filename()] = Bytes(entry.path());
    return files;
  }
};

TEST_F(ServoKilled, LeavesALogThatReplaysBitForBitAndTheEarlierOneAlone) {
  ASSERT_EQ(RunLegible(Command({})).exit_code, kExitSuccess);
  const auto earlier = FilesOfLog();
  std::mt19937_64 generator = TestGenerator();
  for (int killed = 0; killed < kKills;) {
    const fs::path growing = log() / fmt::format("unfinished-{}", killed + 1);
    const auto cycles = static_cast<std::ptrdiff_t>(Uniform(generator, 20, 1500));
    ASSERT_TRUE(KillAfterCycles(cycles, growing));
    ++killed;
    const RecordedServo recorded = ReadServoLog(growing);
    EXPECT_TRUE(recorded.is_cut_off);
    EXPECT_GE(static_cast<std::ptrdiff_t>(recorded.cycles.size()) + 20, cycles);
    const ProgramRun replay = RunLegible({"replay", growing});
    EXPECT_EQ(replay.exit_code, kExitSuccess) << replay.out << replay.err;
    EXPECT_THAT(replay.out, AllOf(HasSubstr("the same commands, bit for bit"),
                                  HasSubstr(fmt::format("cut off: no result.json; {} cycles were replayed",
                                                        recorded.cycles.size()))));
    EXPECT_EQ(FilesOfLog(), earlier);
  }
  // The next one takes the earlier one's place, and says what it leaves there.
  const ProgramRun next = RunLegible(Command({}));
  EXPECT_EQ(next.exit_code, kExitSuccess);
  EXPECT_THAT(next.err, HasSubstr("unfinished-1 holds the log of a servo that has not come to its end"));
  const std::vector<fs::path> unfinished = UnfinishedLogs(log());
  ASSERT_EQ(unfinished.size(), static_cast<size_t>(kKills));
  EXPECT_EQ(unfinished.back(), log() / fmt::format("unfinished-{}", kKills));
  EXPECT_NE(FilesOfLog(), earlier);
}

TEST_F(ServoKilled, IsNamedByReplayWhereNoServoHasComeToItsEnd) {
  ASSERT_TRUE(KillAfterCycles(50, log() / "unfinished-1"));
  const ProgramRun replay = RunLegible({"replay", log()});
  EXPECT_EQ(replay.exit_code, kExitBadInput);
  EXPECT_THAT(replay.err, AllOf(HasSubstr("holds no log of a servo that came to its end; replay "),
                                HasSubstr("unfinished-1, which was cut off")));
}

}  // namespace
}  // namespace legible
