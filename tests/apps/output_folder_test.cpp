#include "apps/output_folder.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/datasets/files.h"

namespace legible {
namespace {

using testing::IsEmpty;
using testing::UnorderedElementsAre;

namespace fs = std::filesystem;

void WriteText(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

class OutputFolder : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(OutputFolder, IsMadeWithAllFilesAndNothingElse) {
  const fs::path out = folder_.path() / "a" / "b";
  WriteTogether(out, {"x", "y"}, [](const fs::path& staging) {
    WriteText(staging / "x", "1");
    WriteText(staging / "y", "2");
  });
  EXPECT_EQ(Bytes(out / "x"), "1");
  EXPECT_EQ(Bytes(out / "y"), "2");
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 2);
}

TEST_F(OutputFolder, ReplacesEarlierResultsAndKeepsOtherFiles) {
  for (const char* name : {"x", "y", "other"}) folder_.Write(name, "old");
  WriteTogether(folder_.path(), {"x", "y"}, [](const fs::path& staging) { WriteText(staging / "x", "new"); });
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("x", "other"));
  EXPECT_EQ(Bytes(folder_.path() / "x"), "new");
}

TEST_F(OutputFolder, IsAsItWasWhenWritingFails) {
  folder_.Write("x", "old");
  const auto fail = [](const fs::path& staging) {
    WriteText(staging / "x", "new");
    throw std::runtime_error("no more space");
  };
  EXPECT_THROW(WriteTogether(folder_.path(), {"x"}, fail), std::runtime_error);
  EXPECT_THROW(WriteTogether(folder_.path() / "a" / "b", {"x"}, fail), std::runtime_error);
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("x"));
  EXPECT_EQ(Bytes(folder_.path() / "x"), "old");
}

TEST_F(OutputFolder, GetsResultsThatGrewInANumberedFolderWhenTheyAreWhole) {
  folder_.Write("out/x", "old");
  folder_.Write("out/y", "old");
  const fs::path out = folder_.path() / "out";
  EXPECT_EQ(MakeNumberedFolder(out, "growing-"), out / "growing-1");
  const fs::path growing = MakeNumberedFolder(out, "growing-");
  EXPECT_EQ(growing, out / "growing-2");
  WriteText(growing / "x", "new");
  EXPECT_EQ(Bytes(out / "x"), "old");
  MoveTogether(growing, out, {"x", "y"});
  EXPECT_EQ(Bytes(out / "x"), "new");
  EXPECT_FALSE(fs::exists(out / "y"));
  EXPECT_FALSE(fs::exists(growing));
  EXPECT_EQ(MakeNumberedFolder(folder_.path() / "a" / "b", "growing-"), folder_.path() / "a/b/growing-1");
}

TEST_F(OutputFolder, TrialOfWritingLeavesNothing) {
  DemandWritable(folder_.path(), {"x"});
  DemandWritable(folder_.path() / "a" / "b" / "", {"x"});
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(OutputFolder, LosesWhatAKilledRunLeftAndNothingElse) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  std::string own;  // the name that a staging folder of this process has
  WriteTogether(folder_.path(), {"x"}, [&](const fs::path& staging) { own = staging.filename(); });
  const auto of_process = [&](auto process) {
    return Replaced(own, fmt::format("-{}.", getpid()), fmt::format("-{}.", process));
  };
  const std::vector<std::string> kept = {of_process(getppid()), of_process(-99999), "." + own,
                                         fmt::format(".{}.part", child)};
  for (const std::string& name : kept) folder_.Write(name + "/model.yaml", "half");
  folder_.Write(of_process(child) + "/model.yaml", "half");
  DemandWritable(folder_.path(), {"x"});
  EXPECT_EQ(folder_.Names().size(), kept.size() + 1);
  WriteTogether(folder_.path(), {"x"}, [](const fs::path&) {});
  EXPECT_THAT(folder_.Names(), testing::UnorderedElementsAreArray(kept));
}

TEST_F(OutputFolder, CannotTakeAFileWhereAFolderHasItsName) {
  folder_.Write("report.html/x", "");
  EXPECT_THAT(InputErrorOf([&] {
                DemandWritable(folder_.path(), {"model.yaml", "report.html"});
              }),
              testing::HasSubstr("report.html: is a folder where a file is to be written; "));
}

TEST_F(OutputFolder, BelowAFileCannotBeWritten) {
  const fs::path file = folder_.Write("file", "");
  EXPECT_THAT(InputErrorOf([&] { DemandWritable(file / "out", {"x"}); }),
              testing::HasSubstr("cannot be written"));
  EXPECT_THAT(InputErrorOf([&] { DemandWritable(file, {"x"}); }), testing::HasSubstr("cannot be written"));
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("file"));
}

}  // namespace
}  // namespace legible
