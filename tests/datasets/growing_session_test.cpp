#include "datasets/growing_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include "datasets/session_file.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"

namespace legible {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

// A process that is no more: numbers beyond Linux' largest are never given.
constexpr int kNoProcess = 2000000000;

class AGrowingSession : public testing::Test {
 protected:
  static Session Description() {
    Session session;
    session.robot = DesktopHexapod();
    session.camera = DesktopCamera(false);
    session.camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
    session.known.joint_reading_m = 2e-5;
    return session;
  }
  static Vector6d Readings(int image) { return Vector6d::Constant(0.4 + 0.001 * image); }

  fs::path session() const { return folder_.path() / "session"; }
  static std::string Host() {
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    return host;
  }

  TemporaryFolder folder_;
};

std::vector<std::string> ImageNames(const Session& session) {
  std::vector<std::string> names;
  for (const SessionImage& image : session.images) names.push_back(image.name);
  return names;
}

TEST_F(AGrowingSession, AppearsWithItsFirstImageAndIsWholeFromThenOn) {
  GrowingSession growing(session(), Description());
  EXPECT_FALSE(fs::exists(session()));
  for (int i = 0; i < 3; ++i) {
    growing.Add(fmt::format("{:03}.png", i), fmt::format("image {}", i), Readings(i));
    const Session read = ReadSession(session());
    ASSERT_EQ(read.images.size(), static_cast<size_t>(i + 1));
    EXPECT_EQ(Bytes(read.images.back().file), fmt::format("image {}", i));
    EXPECT_EQ(read.images.back().joint_readings_m, Readings(i));
    EXPECT_THAT(read.unlisted_images, IsEmpty());
    ExpectSame(read.robot, Description().robot);
    ExpectSame(read.camera, Description().camera);
    ExpectSame(read.camera_from_base.value(), *Description().camera_from_base);
    EXPECT_EQ(read.known.joint_reading_m, 2e-5);
  }
  EXPECT_THAT(folder_.Names(), ElementsAre("session"));
}

TEST_F(AGrowingSession, LeavesNothingWhereNoImageCame) {
  { const GrowingSession growing(session(), Description()); }
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(AGrowingSession, MakesTheFoldersAboveItAndTakesAnEmptyOne) {
  GrowingSession deep(folder_.path() / "a" / "b" / "", Description());
  deep.Add("000.png", "image", Readings(0));
  EXPECT_EQ(ReadSession(folder_.path() / "a" / "b").images.size(), 1u);
  fs::create_directory(session());
  GrowingSession empty(session(), Description());
  empty.Add("000.png", "image", Readings(0));
  EXPECT_EQ(ReadSession(session()).images.size(), 1u);
}

TEST_F(AGrowingSession, GoesOnWhereItEnded) {
  { GrowingSession(session(), Description()).Add("000.png", "first", Readings(0)); }
  GrowingSession growing(session());
  EXPECT_THAT(ImageNames(growing.session()), ElementsAre("000.png"));
  growing.Add("001.png", "second", Readings(1));
  const Session read = ReadSession(session());
  EXPECT_THAT(ImageNames(read), ElementsAre("000.png", "001.png"));
  EXPECT_EQ(Bytes(read.images[0].file), "first");
  EXPECT_EQ(read.images[0].joint_readings_m, Readings(0));
}

TEST_F(AGrowingSession, RemovesWhatKilledProcessesLeftAndNothingElse) {
  { GrowingSession(session(), Description()).Add("000.png", "first", Readings(0)); }
  const std::string dead = fmt::format(".legible-{}-{}.part", Host(), kNoProcess);
  const std::string alive = fmt::format(".legible-{}-{}.part", Host(), getppid());
  const std::string elsewhere = fmt::format(".legible-another{}-{}.part", Host(), kNoProcess);
  for (const std::string& name : {dead, alive, elsewhere}) folder_.Write(name + "/images/000.png", "half");
  folder_.Write("session/.joints.csv.4711.part", "image,q1");
  folder_.Write("session/images/.001.png.4711.part", "half");
  folder_.Write("session/images/.hidden.part", "a user's");
  folder_.Write("session/images/001.png", "without a row");
  GrowingSession growing(session());
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("session", alive, elsewhere));
  EXPECT_FALSE(fs::exists(session() / ".joints.csv.4711.part"));
  EXPECT_FALSE(fs::exists(session() / "images" / ".001.png.4711.part"));
  EXPECT_TRUE(fs::exists(session() / "images" / ".hidden.part"));
  growing.Add("001.png", "again", Readings(1));
  EXPECT_EQ(Bytes(session() / "images" / "001.png"), "again");
  EXPECT_THAT(ReadSession(session()).unlisted_images, IsEmpty());
}

TEST_F(AGrowingSession, RefusesWhatIsThereAlready) {
  { GrowingSession(session(), Description()).Add("000.png", "first", Readings(0)); }
  EXPECT_THAT(InputErrorOf([&] { GrowingSession(session(), Description()); }),
              HasSubstr("holds a session already; go on with it by --resume"));
  const fs::path other = folder_.Write("other/notes.txt", "").parent_path();
  EXPECT_THAT(InputErrorOf([&] { GrowingSession(other, Description()); }),
              HasSubstr("is there already, and is no session"));
  EXPECT_THAT(InputErrorOf([&] { GrowingSession(other / "notes.txt", Description()); }),
              HasSubstr("is there already"));
  EXPECT_THAT(InputErrorOf([&] { GrowingSession(other / "notes.txt" / "s", Description()); }),
              HasSubstr("cannot be written"));
  EXPECT_THAT(InputErrorOf([&] { GrowingSession growing(other); }), HasSubstr("holds no session.yaml"));
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("session", "other"));
}

TEST_F(AGrowingSession, BelongsToOneAtATime) {
  GrowingSession one(session(), Description());
  one.Add("000.png", "first", Readings(0));
  EXPECT_THAT(InputErrorOf([&] { GrowingSession other(session()); }),
              HasSubstr("captured into by another process"));
  one.Add("001.png", "second", Readings(1));
}

TEST_F(AGrowingSession, OfTwoThatBeginTogetherTheSecondFails) {
  GrowingSession one(session(), Description());
  one.Add("000.png", "first", Readings(0));
  // The first one's staging folder was renamed; a later one's has the same name, for it is one process.
  fs::rename(session(), folder_.path() / "moved");
  GrowingSession two(session(), Description());
  fs::rename(folder_.path() / "moved", session());
  EXPECT_THAT(InputErrorOf([&] { two.Add("000.png", "late", Readings(1)); }), HasSubstr("cannot be written"));
  EXPECT_EQ(Bytes(session() / "images" / "000.png"), "first");
  EXPECT_THAT(two.session().images, IsEmpty());
}

TEST_F(AGrowingSession, IsAsItWasWhereAnImageCannotBeStored) {
  GrowingSession growing(session(), Description());
  growing.Add("000.png", "first", Readings(0));
  EXPECT_THAT(InputErrorOf([&] { growing.Add("no-such-folder/001.png", "x", Readings(1)); }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(growing.session().images.size(), 1u);
  EXPECT_EQ(ReadSession(session()).images.size(), 1u);
}

}  // namespace
}  // namespace legible
