// What every YAML reader does alike, seen through ReadRobot.
#include "datasets/robot_file.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/files.h"

namespace legible {
namespace {

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& text) {
  return InputErrorOf([&] { ReadRobot(folder.Write("robot.yaml", text)); });
}

std::string RobotText(const TemporaryFolder& folder) {
  WriteRobot(folder.path() / "robot.yaml", DesktopHexapod());
  return Bytes(folder.path() / "robot.yaml");
}

TEST(YamlFile, BrokenSyntaxNamesItsLine) {
  const TemporaryFolder folder;
  EXPECT_THAT(ReadComplaint(folder, "robot: gough-stewart\nlegs: [1, 2\nhome: {\n"),
              testing::MatchesRegex(".*/robot.yaml:[34]: is no YAML: .*; mend the syntax at this line"));
}

TEST(YamlFile, HoldsOneDocument) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  EXPECT_EQ(ReadComplaint(folder, "a: 1\n---\nb: 2\n"),
            Complaint(file, 0, "holds 2 YAML documents; keep one"));
  EXPECT_EQ(ReadComplaint(folder, ""), Complaint(file, 0, "is empty; fill it in, or name another file"));
  EXPECT_EQ(ReadComplaint(folder, "# nothing\n"),
            Complaint(file, 0, "is empty; fill it in, or name another file"));
}

TEST(YamlFile, IsAMapOfNamedKeys) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  EXPECT_EQ(ReadComplaint(folder, "- 1\n"),
            Complaint(file, 1, "the file is a list, not a map; write \"key: value\" lines"));
  EXPECT_EQ(ReadComplaint(folder, "\nplain\n"),
            Complaint(file, 2, "the file is \"plain\", not a map; write \"key: value\" lines"));
  EXPECT_EQ(ReadComplaint(folder, "robot: gough-stewart\n[1, 2]: 3\n"),
            Complaint(file, 2, "the file is a list, not a text; write one value"));
}

TEST(YamlFile, UnknownAndRepeatedKeysNameTheirLine) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  EXPECT_EQ(ReadComplaint(folder, "robot: gough-stewart\nnmae: x\n"),
            Complaint(file, 2,
                      "the file has the unknown key \"nmae\"; "
                      "the nearest known key is \"name\": rename it or take it out"));
  EXPECT_EQ(ReadComplaint(folder, "robot: gough-stewart\nname: x\nname: y\n"),
            Complaint(file, 3, "the file has the key \"name\" twice; keep one"));
}

TEST(YamlFile, MissingAndEmptyValuesNameTheirKey) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  EXPECT_EQ(ReadComplaint(folder, "robot: gough-stewart\n"),
            Complaint(file, 1, "the file has no \"home\"; add it"));
  EXPECT_EQ(ReadComplaint(folder, "robot: gough-stewart\nhome:\nlegs:\n"),
            Complaint(file, 2, "home is empty, not a map; write \"key: value\" lines"));
}

TEST(YamlFile, NumbersAreFinite) {
  const TemporaryFolder folder;
  const std::string good = RobotText(folder);
  const auto file = folder.path() / "robot.yaml";
  for (const std::string text : {"nan", ".inf", "1e400", "a"}) {
    const std::string home =
        good.substr(good.find("translation_m"), good.find('}') - good.find("translation_m"));
    EXPECT_EQ(ReadComplaint(folder, Replaced(good, home, "translation_m: [0, " + text + ", 1]")),
              Complaint(file, 3,
                        "home.translation_m[2] is \"" + text +
                            "\", not a finite number; give a number in m, rad or px"));
  }
}

TEST(YamlFile, QuaternionsOfThreeDigitsAreNormalisedAndOthersRefused) {
  const TemporaryFolder folder;
  const std::string good = RobotText(folder);
  const auto file = folder.path() / "robot.yaml";
  const auto with = [&](const std::string& xyzw) { return Replaced(good, "[0, 0, 0, 1]", xyzw); };
  const GoughStewart robot = ReadRobot(folder.Write("robot.yaml", with("[0, 0, 0.5, 0.866]")));
  EXPECT_NEAR(robot.home.rotation.norm(), 1, 1e-15);
  EXPECT_NEAR(robot.home.rotation.z(), 0.5, 1e-4);
  EXPECT_EQ(ReadComplaint(folder, with("[0, 0, 0.5, 0.9]")),
            Complaint(file, 3,
                      "home.rotation_xyzw is a quaternion of norm 1.02956; give a unit quaternion, x y z w"));
  EXPECT_EQ(ReadComplaint(folder, with("[0, 0, 1]")),
            Complaint(file, 3, "home.rotation_xyzw has 3 values; give 4"));
}

TEST(YamlFile, WindowsLineEndsAndByteOrderMarksChangeNothing) {
  const TemporaryFolder folder;
  const std::string good = RobotText(folder);
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : good) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  WriteRobot(folder.path() / "again.yaml", ReadRobot(folder.Write("windows.yaml", windows)));
  EXPECT_EQ(Bytes(folder.path() / "again.yaml"), good);
}

}  // namespace
}  // namespace legible
