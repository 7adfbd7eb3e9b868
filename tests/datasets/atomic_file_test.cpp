#include "datasets/atomic_file.h"

#include "tests/datasets/files.h"

namespace legible {
namespace {

using testing::ElementsAre;

TEST(AtomicFile, ReplacesWhatWasThereAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.json", "old and longer than the new");
  const std::string text("new\0text\n", 9);
  WriteFileAtomically(file, text);
  EXPECT_EQ(Bytes(file), text);
  EXPECT_THAT(folder.Names(), ElementsAre("a.json"));
}

TEST(AtomicFile, WritesToTheWorkingFolderByABareName) {
  const TemporaryFolder folder;
  const auto previous = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  WriteFileAtomically("bare.txt", "x");
  std::filesystem::current_path(previous);
  EXPECT_EQ(Bytes(folder.path() / "bare.txt"), "x");
}

TEST(AtomicFile, RefusesAFolderThatIsMissing) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "missing" / "a.json";
  EXPECT_EQ(InputErrorOf([&] { WriteFileAtomically(file, "x"); }),
            Complaint(file, 0,
                      "cannot be written: No such file or directory; "
                      "name a place in a folder that exists and can be written"));
}

TEST(AtomicFile, LeavesNothingBehindWhereTheRenameFails) {
  const TemporaryFolder folder;
  const auto occupied = folder.path() / "occupied";
  folder.Write("occupied/file", "x");
  EXPECT_THAT(InputErrorOf([&] { WriteFileAtomically(occupied, "x"); }),
              testing::StartsWith(Complaint(occupied, 0, "cannot be written: ")));
  EXPECT_THAT(folder.Names(), ElementsAre("occupied"));
}

TEST(AtomicFile, FollowsALinkAndKeepsIt) {
  const TemporaryFolder folder;
  const auto target = folder.Write("target.txt", "old");
  const auto link = folder.path() / "link.txt";
  std::filesystem::create_symlink(target, link);
  WriteFileAtomically(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(Bytes(target), "new");
}

TEST(AtomicFile, WritesToADeviceAndLeavesItOne) {
  WriteFileAtomically("/dev/null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_THAT(InputErrorOf([] { WriteFileAtomically("/dev/full", "text"); }),
              testing::StartsWith("/dev/full: cannot be written: "));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace
}  // namespace legible
