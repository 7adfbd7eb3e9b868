#include "datasets/robot_file.h"

#include <limits>

#include "datasets/synthetic_session.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr char kLegs[] =
    "legs:\n"
    "  - {base_joint_m: [0.26, 0.02, 0], platform_joint_m: [0.19, -0.02, 0], radius_m: 0.011, joint_range_m: "
    "[0.3, 0.5]}\n"
    "  - {base_joint_m: [0.27, -0.02, 0], platform_joint_m: [-0.08, -0.18, 0], radius_m: 0.012,\n"
    "     joint_offset_m: -0.001, joint_range_m: [0.31, 0.5]}\n"
    "  - {base_joint_m: [-0.15, 0.22, 0], platform_joint_m: [-0.08, 0.18, 0], radius_m: 0.01, joint_range_m: "
    "[0.32, 0.5]}\n"
    "  - {base_joint_m: [-0.12, 0.24, 0], platform_joint_m: [0.19, 0.02, 0], radius_m: 0.01, joint_range_m: "
    "[0.33, 0.5]}\n"
    "  - {base_joint_m: [-0.12, -0.24, 0], platform_joint_m: [-0.11, -0.16, 0], radius_m: 0.01, "
    "joint_range_m: [0.3, 0.5]}\n"
    "  - {base_joint_m: [-0.15, -0.22, 0], platform_joint_m: [-0.11, 0.16, 0], radius_m: 0.01, "
    "joint_range_m: [0.3, 0.5]}\n";

std::string RobotText() {
  return std::string(
             "robot: gough-stewart\nhome: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0.31]}\n") +
         kLegs;
}

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& old_part,
                          const std::string& new_part) {
  const auto file = folder.Write("robot.yaml", Replaced(RobotText(), old_part, new_part));
  return InputErrorOf([&] { ReadRobot(file); });
}

TEST(RobotFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 20; ++i) {
    GoughStewart robot = DesktopHexapod(generator, 0.002);
    robot.name = "a \"name\" with \\ and: # an ü\n\ttab";
    robot.home = {UniformRotation(generator), UniformVector(generator, -1, 1)};
    robot.legs[2].joint_offset_m = Uniform(generator, -1e-3, 1e-3);
    robot.legs[3].radius_m = Uniform(generator, 1e-9, 1e-2);
    WriteRobot(folder.path() / "robot.yaml", robot);
    ExpectSame(ReadRobot(folder.path() / "robot.yaml"), robot);
  }
}

TEST(RobotFile, NameAndOffsetMayBeLeftOut) {
  const TemporaryFolder folder;
  const GoughStewart robot = ReadRobot(folder.Write("robot.yaml", RobotText()));
  EXPECT_EQ(robot.name, "");
  EXPECT_EQ(robot.home.translation, Eigen::Vector3d(0, 0, 0.31));
  EXPECT_EQ(robot.legs[0].joint_offset_m, 0);
  EXPECT_EQ(robot.legs[1].joint_offset_m, -0.001);
  EXPECT_EQ(robot.legs[1].base_joint_m, Eigen::Vector3d(0.27, -0.02, 0));
  EXPECT_EQ(robot.legs[1].platform_joint_m, Eigen::Vector3d(-0.08, -0.18, 0));
  EXPECT_EQ(robot.legs[1].radius_m, 0.012);
  EXPECT_EQ(robot.legs[1].joint_range_m, (std::array<double, 2>{0.31, 0.5}));
}

TEST(RobotFile, OtherMechanismsAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadComplaint(folder, "gough-stewart", "delta"),
            Complaint(folder.path() / "robot.yaml", 1,
                      "robot is \"delta\", a mechanism not known here; give gough-stewart"));
}

TEST(RobotFile, LegsAreSix) {
  const TemporaryFolder folder;
  const std::string text = RobotText();
  const std::string five = text.substr(0, text.rfind("  - "));
  const auto file = folder.Write("robot.yaml", five);
  EXPECT_EQ(InputErrorOf([&] { ReadRobot(file); }), Complaint(file, 4, "legs has 5 values; give 6"));
}

TEST(RobotFile, ImpossibleLegsAreRefusedWhereTheyStand) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  EXPECT_EQ(ReadComplaint(folder, "radius_m: 0.012", "radius_m: 0"),
            Complaint(file, 5, "legs[2].radius_m is 0; give a number greater than 0"));
  EXPECT_EQ(
      ReadComplaint(folder, "radius_m: 0.012", "radius_m: 12"),
      Complaint(
          file, 5,
          "legs[2] has a shortest length (joint_range_m[1] + joint_offset_m) of 0.309 m and a radius of 12 "
          "m; give lengths in metres, with the leg longer than it is thick"));
  EXPECT_EQ(
      ReadComplaint(folder, "[0.27, -0.02, 0]", "[130, -20, 0]"),
      Complaint(file, 5,
                "legs[2].base_joint_m is 131.5 m from the origin of its frame; give lengths in metres, not "
                "in millimetres"));
  EXPECT_EQ(
      ReadComplaint(folder, "[0.31, 0.5]", "[0.5, 0.31]"),
      Complaint(file, 6, "legs[2].joint_range_m is [0.5, 0.31], reversed or empty; give [least, largest]"));
  EXPECT_EQ(ReadComplaint(folder, "radius_m: 0.012", "raduis_m: 0.012"),
            Complaint(file, 5,
                      "legs[2] has the unknown key \"raduis_m\"; "
                      "the nearest known key is \"radius_m\": rename it or take it out"));
  EXPECT_EQ(ReadComplaint(folder, "radius_m: 0.012,", ""),
            Complaint(file, 5, "legs[2] has no \"radius_m\"; add it"));
}

TEST(RobotFile, ALegGivenTwiceIsRefused) {
  const TemporaryFolder folder;
  const std::string text = Replaced(RobotText(), "[-0.12, -0.24, 0]", "[-0.15, -0.22, 0]");
  const auto file = folder.Write("robot.yaml", Replaced(text, "[-0.11, -0.16, 0]", "[-0.11, 0.16, 0]"));
  EXPECT_EQ(InputErrorOf([&] { ReadRobot(file); }),
            Complaint(file, 10, "legs[6] has the same joints as legs[5]; give each leg its own"));
}

TEST(RobotFile, JointsMayBeShared) {
  const TemporaryFolder folder;
  const auto file =
      folder.Write("robot.yaml", Replaced(RobotText(), "[-0.12, -0.24, 0]", "[-0.15, -0.22, 0]"));
  EXPECT_NO_THROW(ReadRobot(file));
}

TEST(RobotFile, NumbersThatAreNotFiniteAreNotWritten) {
  const TemporaryFolder folder;
  GoughStewart robot = legible::DesktopHexapod();
  robot.legs[0].radius_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(WriteRobot(folder.path() / "robot.yaml", robot), std::invalid_argument);
  EXPECT_THAT(folder.Names(), testing::IsEmpty());
}

}  // namespace
}  // namespace legible
