#include "datasets/session_file.h"
#include "tests/datasets/session_fixture.h"

namespace legible {
namespace {

using ContentHashOnDisk = SessionOnDisk;

// `sha256sum FILE… | sha256sum`, run in the session's folder.
std::string CoreutilsHash(const std::filesystem::path& folder, const std::string& files) {
  const std::string command = "cd '" + folder.string() + "' && { sha256sum " + files + "; } | sha256sum";
  FILE* pipe = popen(command.c_str(), "r");
  char digits[65] = {};
  if (fread(digits, 1, 64, pipe) != 64) digits[0] = '\0';
  pclose(pipe);
  return digits;
}

TEST_F(ContentHashOnDisk, IsThatOfSha256sum) {
  EXPECT_EQ(ContentHash(ReadSession(folder_.path())),
            CoreutilsHash(folder_.path(),
                          "session.yaml robot.yaml camera.yaml joints.csv images/b.png images/a.png"));
}

TEST_F(ContentHashOnDisk, GoesOnWithWhatIsSolvedTogetherWithTheSession) {
  folder_.Write("elsewhere/board.yaml", "board: tags");
  const auto board = folder_.path() / "elsewhere/board.yaml";
  EXPECT_EQ(ContentHash(ReadSession(folder_.path()), {board}),
            CoreutilsHash(folder_.path(),
                          "session.yaml robot.yaml camera.yaml joints.csv images/b.png images/a.png; "
                          "cd elsewhere; sha256sum board.yaml"));
}

TEST_F(ContentHashOnDisk, ChangesWithEveryFileThatIsUsedAndNoOther) {
  const std::string hash = ContentHash(ReadSession(folder_.path()));
  for (const std::string name : {"session.yaml", "robot.yaml", "camera.yaml", "joints.csv", "images/a.png"}) {
    const std::string bytes = Bytes(folder_.path() / name);
    folder_.Write(name, bytes + "\n");
    EXPECT_NE(ContentHash(ReadSession(folder_.path())), hash) << name;
    folder_.Write(name, bytes);
    EXPECT_EQ(ContentHash(ReadSession(folder_.path())), hash) << name;
  }
  folder_.Write("images/unlisted.png", "x");
  folder_.Write("truth.json", "{}");
  EXPECT_EQ(ContentHash(ReadSession(folder_.path())), hash);
}

TEST_F(ContentHashOnDisk, DoesNotDependOnWhereTheSessionLies) {
  const std::string hash = ContentHash(ReadSession(folder_.path()));
  const std::filesystem::path copy = folder_.path() / "copy";
  std::filesystem::create_directory(copy);
  for (const char* name : {"session.yaml", "robot.yaml", "camera.yaml", "joints.csv", "images"}) {
    std::filesystem::copy(folder_.path() / name, copy / name, std::filesystem::copy_options::recursive);
  }
  EXPECT_EQ(ContentHash(ReadSession(copy)), hash);
  EXPECT_EQ(ContentHash(ReadSession(copy / ".")), hash);
  EXPECT_EQ(ContentHash(ReadSession(copy.string() + "/")), hash);
}

TEST_F(ContentHashOnDisk, NeedsTheImagesToBeReadable) {
  const Session session = ReadSession(folder_.path());
  std::filesystem::remove(folder_.path() / "images/a.png");
  EXPECT_THAT(InputErrorOf([&] { ContentHash(session); }),
              testing::StartsWith(Complaint(folder_.path() / "images/a.png", 0, "cannot be read: ")));
}

TEST(ContentHash, NeedsASessionFromFiles) { EXPECT_THROW(ContentHash(Session()), std::invalid_argument); }

}  // namespace
}  // namespace legible
