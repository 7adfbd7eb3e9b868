#include "datasets/linuxcnc_file.h"

#include <fmt/format.h>

#include <sstream>

#include "datasets/synthetic_session.h"
#include "tests/datasets/files.h"
#include "tests/datasets/other_program.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

GoughStewart RandomHexapod() {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod();
  for (Leg& leg : robot.legs) {
    leg.base_joint_m += UniformVector(generator, -0.002, 0.002);
    leg.platform_joint_m += UniformVector(generator, -0.002, 0.002);
    leg.joint_offset_m = Uniform(generator, -0.001, 0.3);
  }
  return robot;
}

// HAL commands, without comments.
std::vector<std::string> Commands(const std::string& text) {
  std::vector<std::string> commands;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line[0] != '#') commands.push_back(line);
  return commands;
}

TEST(LinuxCnc, EachJointStandsOnItsPinInTheMachinesUnit) {
  const GoughStewart robot = RandomHexapod();
  for (const auto& [unit, per_metre] :
       {std::pair{LengthUnit::kMillimetre, 1000.0}, std::pair{LengthUnit::kInch, 1 / 0.0254}}) {
    const std::vector<std::string> commands = Commands(LinuxCncText(robot, unit));
    ASSERT_EQ(commands.size(), 36u);
    for (size_t i = 0; i < commands.size(); ++i) {
      const size_t leg = i / 6;
      const bool is_platform = i % 6 >= 3;
      const auto axis = static_cast<Eigen::Index>(i % 3);
      std::istringstream words(commands[i]);
      std::string setp, pin;
      double value = 0;
      words >> setp >> pin >> value;
      EXPECT_EQ(setp, "setp");
      EXPECT_EQ(pin, fmt::format("genhexkins.{}.{}.{}", is_platform ? "platform" : "base", leg, "xyz"[axis]));
      EXPECT_NEAR(
          value,
          per_metre * (is_platform ? robot.legs[leg].platform_joint_m : robot.legs[leg].base_joint_m)[axis],
          1e-12);
    }
  }
}

// A joint that reads q where it was homed to h reads q + offset, its strut's length, once h is raised by the
// offset.
TEST(LinuxCnc, HomeOffsetsAreTheJointOffsets) {
  const GoughStewart robot = RandomHexapod();
  const std::string text = LinuxCncText(robot, LengthUnit::kMillimetre);
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const std::string section = fmt::format("# [JOINT_{}]\n# HOME_OFFSET = ", leg);
    const size_t at = text.find(section);
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(text.substr(at + section.size())), 1000 * robot.legs[leg].joint_offset_m, 1e-12);
  }
}

TEST(LinuxCnc, ANameOfTheRobotCannotBecomeACommand) {
  GoughStewart robot = RandomHexapod();
  robot.name = "x\nsetp genhexkins.screw-lead 1\n";
  EXPECT_EQ(Commands(LinuxCncText(robot, LengthUnit::kMillimetre)).size(), 36u);
}

// By halrun, which needs no real time for this; root has to name another user for LinuxCNC's own process.
TEST(LinuxCnc, HalTakesEveryLine) {
  if (RunShell("command -v halrun").exit_code != 0)
    GTEST_SKIP() << "halrun of Debian's linuxcnc-uspace is not installed";
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const GoughStewart robot = RandomHexapod();
  const std::string lines = LinuxCncText(robot, LengthUnit::kMillimetre);
  std::string questions;
  for (const std::string& command : Commands(lines)) {
    std::istringstream words(command);
    std::string setp, pin;
    words >> setp >> pin;
    questions += fmt::format("getp {}\n", pin);
  }
  const auto file = folder.Write("try.hal", "loadrt genhexkins\n" + lines + questions);
  const ProgramOutput run = RunShell(
      fmt::format("cd {0}; export RTAPI_FIFO_PATH={0}/fifo; [ $(id -u) = 0 ] && export RTAPI_UID=65534; "
                  "timeout 60 halrun -f {1} 2>messages; code=$?; cat messages >&2; exit $code",
                  folder.path().string(), file.string()));
  if (run.out.find("loadrt") != std::string::npos || run.out.find("insmod") != std::string::npos)
    GTEST_SKIP() << "halrun cannot load modules here: " << run.out;
  EXPECT_EQ(run.exit_code, 0) << run.out;
  std::istringstream answers(run.out);
  for (const std::string& command : Commands(lines)) {
    const double expected = std::stod(command.substr(command.rfind(' ')));
    double answer = NAN;
    ASSERT_TRUE(answers >> answer) << run.out;
    EXPECT_NEAR(answer, expected, 1e-6 * std::abs(expected)) << command;  // halcmd prints seven digits
  }
}

}  // namespace
}  // namespace legible
