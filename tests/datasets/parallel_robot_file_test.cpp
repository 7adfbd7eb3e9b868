#include "datasets/parallel_robot_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/hidden/assembly_modes.h"
#include "core/hidden/controllability.h"
#include "core/robots/parallel_kinematics.h"
#include "core/robots/platform_motion.h"
#include "datasets/model_file.h"
#include "datasets/robot_file.h"
#include "tests/datasets/files.h"

namespace legible {
namespace {

const std::filesystem::path kDatasets = LEGIBLE_SOURCE_DIR "/datasets";

ParallelRobot Shipped(const std::string& name) { return ReadParallelRobot(kDatasets / "robots" / name); }

std::vector<int> AllLegs(const ParallelRobot& robot) {
  std::vector<int> legs(robot.legs.size());
  std::iota(legs.begin(), legs.end(), 0);
  return legs;
}

Rigid3 Translated(double x, double y, double z) { return {Eigen::Quaterniond::Identity(), {x, y, z}}; }

class ShippedRobot : public testing::TestWithParam<const char*> {
 protected:
  ParallelRobot robot_ = Shipped(GetParam());
};

INSTANTIATE_TEST_SUITE_P(OfEveryFamily, ShippedRobot,
                         testing::Values("five-bar.yaml", "prrrp-parallel.yaml", "planar-3rrr.yaml",
                                         "planar-3prr.yaml", "planar-3rpr.yaml", "delta.yaml",
                                         "linear-delta-parallel.yaml", "orthoglide.yaml", "3-rps.yaml",
                                         "quattro.yaml"),
                         [](const auto& test) {
                           std::string name = std::filesystem::path(test.param).stem();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(ShippedRobot, ReachesItsHomeWithinItsJointRanges) {
  EXPECT_FALSE(robot_.name.empty());
  const auto readings = InverseKinematics(robot_, robot_.home);
  ASSERT_TRUE(readings);
  for (size_t i = 0; i < robot_.legs.size(); ++i) {
    if (!robot_.legs[i].joint_range) continue;
    EXPECT_GT((*readings)[static_cast<Eigen::Index>(i)], (*robot_.legs[i].joint_range)[0]);
    EXPECT_LT((*readings)[static_cast<Eigen::Index>(i)], (*robot_.legs[i].joint_range)[1]);
  }
}

TEST_P(ShippedRobot, ForwardKinematicsLeadsFromNearbyToTheHomeOfItsReadings) {
  const auto readings = InverseKinematics(robot_, robot_.home);
  ASSERT_TRUE(readings);
  const auto basis = MotionBasis(robot_, robot_.home);
  const Vector6d twist = 0.01 * basis * Eigen::VectorXd::Ones(basis.cols());
  const ForwardResult found =
      ForwardKinematics(robot_, *readings, BackToMotion(robot_, Displaced(robot_.home, twist)));
  EXPECT_EQ(found.status, ForwardKinematicsStatus::kConverged);
  EXPECT_LT(Displacement(robot_.home, found.base_from_platform).norm(), 1e-9);
}

TEST_P(ShippedRobot, IsControllableByDirectionsUnlessItsRailsAreParallel) {
  const Controllability found =
      ControllabilityOf(robot_, AllLegs(robot_), robot_.home, SeenFeature::kDirections);
  if (std::string(GetParam()).find("parallel") == std::string::npos) {
    EXPECT_EQ(found.status, ControllabilityStatus::kControllable) << found.why;
    return;
  }
  EXPECT_EQ(found.status, ControllabilityStatus::kUncontrollable);
  EXPECT_THAT(found.why, testing::HasSubstr("the rails of the P joints are parallel"));
  ASSERT_EQ(found.unseen_twists.cols(), 1);
  Vector6d along_rails = Vector6d::Zero();
  along_rails.head<3>() = robot_.legs[0].first_axis;
  EXPECT_NEAR(std::abs(along_rails.dot(found.unseen_twists.col(0))), 1, 1e-9);
}

// Williams, "The Delta Parallel Robot: Kinematics Solutions": the angles of his two examples, in degrees.
TEST(ParallelRobotFile, TheDeltaHasThePublishedAngles) {
  const ParallelRobot delta = Shipped("delta.yaml");
  const auto angles_deg = [&](const Rigid3& pose) -> Eigen::Vector3d {
    return *InverseKinematics(delta, pose) * 180 / std::numbers::pi;
  };
  EXPECT_LT((angles_deg(Translated(0, 0, -0.9)) - Eigen::Vector3d(-20.5, -20.5, -20.5)).cwiseAbs().maxCoeff(),
            0.05);
  EXPECT_LT(
      (angles_deg(Translated(0.3, 0.5, -1.1)) - Eigen::Vector3d(47.5, -11.6, 21.4)).cwiseAbs().maxCoeff(),
      0.05);
}

// Distance in m of the assembly mode of the pose (-0.2, 0, -0.56) nearest to a position.
double NearestMode_m(const std::vector<int>& legs, const Eigen::Vector3d& position_m) {
  double nearest_m = 1;
  for (const AssemblyMode& mode :
       AssemblyModesOf(Shipped("quattro.yaml"), legs, Translated(-0.2, 0, -0.56)).modes)
    nearest_m = std::min(nearest_m, (mode.base_from_platform.translation - position_m).norm());
  return nearest_m;
}

// Briot et al. 2016, section 5.1.3: what the servo of these legs may converge to instead.
TEST(ParallelRobotFile, TheQuattroHasThePublishedAssemblyModes) {
  EXPECT_LT(NearestMode_m({0, 3}, {-0.2, 0, -0.909}), 0.003);
  EXPECT_LT(NearestMode_m({0, 3}, {-0.138, 0.062, -1.019}), 0.003);
  EXPECT_LT(NearestMode_m({0, 3}, {-0.138, 0.062, -0.45}), 0.003);
  EXPECT_LT(NearestMode_m({1, 2}, {-0.2, 0, -0.296}), 0.003);
  EXPECT_LT(NearestMode_m({1, 2}, {-0.262, 0.062, -0.694}), 0.003);
  EXPECT_LT(NearestMode_m({1, 2}, {-0.262, 0.062, -0.161}), 0.003);
}

TEST(ParallelRobotFile, AHexapodIsReadAsWhatItIs) {
  const GoughStewart hexapod = ReadRobot(kDatasets / "hexapod/robot.yaml");
  const ParallelRobot read = ReadParallelRobot(kDatasets / "hexapod/robot.yaml");
  EXPECT_EQ(read.name, hexapod.name);
  EXPECT_EQ(read.motion, PlatformMotion::kSpatial);
  ASSERT_EQ(read.legs.size(), static_cast<size_t>(kLegCount));
  EXPECT_EQ(ToText(read.legs[0].chain), "U_PS");
  for (size_t i = 0; i < kLegCount; ++i) EXPECT_EQ(read.legs[i].joint_range, hexapod.legs[i].joint_range_m);
  const auto readings_m = InverseKinematics(read, hexapod.home);
  ASSERT_TRUE(readings_m);
  EXPECT_LT((*readings_m - InverseKinematics(hexapod, hexapod.home)).norm(), 1e-14);
}

TEST(ParallelRobotFile, AModelIsReadAsItsRobot) {
  const TemporaryFolder folder;
  CalibratedModel model;
  model.robot = ReadRobot(kDatasets / "merlet-gough/robot.yaml");
  model.robot.legs[2].joint_offset_m = 0.001;
  WriteModel(folder.path() / "model.yaml", model);
  const ParallelRobot read = ReadParallelRobot(folder.path() / "model.yaml");
  EXPECT_EQ(read.name, model.robot.name);
  EXPECT_EQ(read.legs[2].joint_offset, 0.001);
}

TEST(ParallelRobotFile, AThreeUpuIsReadAsWhatItIs) {
  const ParallelRobot read = ReadParallelRobot(kDatasets / "seoul-3upu/robot.yaml");
  EXPECT_EQ(read.motion, PlatformMotion::kTranslation);
  ASSERT_EQ(read.legs.size(), 3U);
  EXPECT_EQ(ToText(read.legs[1].chain), "U_PU");
}

// Line 6 is the first leg, 8 the second.
constexpr char kFiveBar[] =
    "robot: parallel\n"
    "name: bench\n"
    "platform: planar-point\n"
    "home: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0.3, 0]}\n"
    "legs:\n"
    "  - {chain: \"_RRR\", base_joint_m: [-0.15, 0, 0], zero_direction: [1, 0, 0], arm_m: 0.2,\n"
    "     rod_m: 0.25}\n"
    "  - {chain: \"_PRR\", base_joint_m: [0.2, 0, 0], first_axis: [0, 3, 0], rod_m: 0.26, radius_m: 0.01,\n"
    "     working_mode: -1, joint_offset_m: 0.02, joint_range_m: [0, 0.4]}\n";

TEST(ParallelRobotFile, WhatIsLeftOutIsAsDocumented) {
  const TemporaryFolder folder;
  const ParallelRobot robot = ReadParallelRobot(folder.Write("robot.yaml", kFiveBar));
  EXPECT_EQ(robot.name, "bench");
  EXPECT_EQ(robot.motion, PlatformMotion::kPlanarPoint);
  EXPECT_EQ(robot.home.translation, Eigen::Vector3d(0, 0.3, 0));
  const RobotLeg &first = robot.legs[0], &second = robot.legs[1];
  EXPECT_EQ(first.working_mode, 1);
  EXPECT_EQ(first.platform_joint_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(first.carried_offset_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(first.joint_offset, 0);
  EXPECT_EQ(first.radius_m, 0);
  EXPECT_FALSE(first.joint_range);
  EXPECT_EQ(second.first_axis, Eigen::Vector3d::UnitY()) << "given with another length";
  EXPECT_EQ(second.working_mode, -1);
  EXPECT_EQ(second.joint_offset, 0.02);
  EXPECT_EQ(second.joint_range, (std::array<double, 2>{0, 0.4}));
  EXPECT_EQ(second.radius_m, 0.01);
}

TEST(ParallelRobotFile, AnglesAreGivenInRadians) {
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "robot.yaml", Replaced(kFiveBar, "0.25}", "0.25, joint_offset_rad: 0.1, joint_range_rad: [-1, 4]}"));
  const RobotLeg leg = ReadParallelRobot(file).legs[0];
  EXPECT_EQ(leg.joint_offset, 0.1);
  EXPECT_EQ(leg.joint_range, (std::array<double, 2>{-1, 4}));
}

class Refusal : public testing::Test {
 protected:
  std::string Of(const std::string& text) const {
    const auto file = folder_.Write("robot.yaml", text);
    return InputErrorOf([&] { ReadParallelRobot(file); });
  }
  std::string Of(const std::string& old_part, const std::string& new_part) const {
    return Of(Replaced(kFiveBar, old_part, new_part));
  }
  std::string At(int line, const std::string& message) const {
    return Complaint(folder_.path() / "robot.yaml", line, message);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Refusal, NamesMechanismsAndMotionsThatAreNotKnown) {
  EXPECT_EQ(Of("robot: parallel", "robot: serial"),
            At(1, "robot is \"serial\", a mechanism not known here; give parallel, gough-stewart or 3-upu"));
  EXPECT_EQ(Of("planar-point", "flat"),
            At(3,
               "platform is \"flat\", no motion of a platform; give planar-point, "
               "planar, translation, schoenflies or spatial"));
}

TEST_F(Refusal, NamesWhatAChainNeedsAndWhatItDoesNotHave) {
  EXPECT_EQ(Of(", arm_m: 0.2", ""), At(6, "legs[1] has no \"arm_m\"; add it"));
  EXPECT_EQ(Of("zero_direction: [1, 0, 0], ", ""), At(6, "legs[1] has no \"zero_direction\"; add it"));
  EXPECT_EQ(Of("first_axis: [0, 3, 0], ", ""), At(8, "legs[2] has no \"first_axis\"; add it"));
  EXPECT_EQ(Of("rod_m: 0.26, ", "rod_m: 0.26, arm_m: 0.1, "),
            At(8,
               "legs[2].arm_m is nothing that a leg _PRR has; take it out, or give one of first_axis, "
               "rod_m, working_mode, joint_offset_m, joint_range_m"));
  EXPECT_EQ(Of("0.25}", "0.25, joint_offset_m: 0.1}"),
            At(7,
               "legs[1].joint_offset_m is nothing that a leg _RRR has; take it out, or give one of "
               "zero_direction, arm_m, rod_m, working_mode, joint_offset_rad, joint_range_rad"));
  EXPECT_EQ(Of("radius_m", "raduis_m"),
            At(8,
               "legs[2] has the unknown key \"raduis_m\"; the nearest known key is \"radius_m\": rename it "
               "or take it out"));
}

TEST_F(Refusal, NamesChainsThatCannotBe) {
  EXPECT_EQ(Of("_RRR", "_RXR"),
            At(6,
               "legs[1].chain cannot be: \"XR\" in the leg \"_RXR\" begins with no joint: R, P, U, S, Π, "
               "{2-US} and {2-UU} are known; write it as \"R_PR\" or \"_R-{2-US}\""));
  EXPECT_THAT(Of("_RRR", "RRR"), testing::HasSubstr("robot.yaml:6: legs[1].chain cannot be: the leg RRR "
                                                    "needs exactly one actuated joint: mark it"));
  EXPECT_EQ(Of("platform: planar-point", "platform: translation"),
            At(6,
               "legs[1] is no leg of this robot: chain: a leg _RRR belongs to a planar robot; mend that "
               "field, or the robot's platform and home"));
}

TEST_F(Refusal, NamesWhatCoreFindsWrongWithALeg) {
  const std::string mend = "; mend that field, or the robot's platform and home";
  EXPECT_EQ(Of("working_mode: -1", "working_mode: 2"),
            At(8, "legs[2] is no leg of this robot: working_mode has to be 1 or -1" + mend));
  EXPECT_EQ(Of("[0, 3, 0]", "[0, 3, 1]"),
            At(8, "legs[2] is no leg of this robot: first_axis leaves the plane that the platform moves in" +
                      mend));
  EXPECT_EQ(Of("[0.2, 0, 0]", "[0.2, 0, 0.1]"),
            At(8,
               "legs[2] is no leg of this robot: base_joint_m is not in the plane of the platform's joint, "
               "which has z = 0.000000 m" +
                   mend));
  const std::string delta = Bytes(kDatasets / "robots/delta.yaml");
  EXPECT_EQ(Of(Replaced(delta, "zero_direction: [0, -1, 0]", "zero_direction: [1, -1, 0]")),
            At(9, "legs[1] is no leg of this robot: zero_direction does not lie across first_axis" + mend));
}

TEST_F(Refusal, NamesImpossibleNumbers) {
  EXPECT_EQ(Of("[0, 3, 0]", "[0, 0, 0]"),
            At(8, "legs[2].first_axis has no direction; give the axis as [x, y, z]"));
  EXPECT_EQ(Of("arm_m: 0.2", "arm_m: 0"), At(6, "legs[1].arm_m is 0; give a number greater than 0"));
  EXPECT_EQ(Of("radius_m: 0.01", "radius_m: 10"),
            At(8,
               "legs[2].radius_m is 10, not less than rod_m; give lengths in metres, with the rod longer "
               "than it is thick"));
  EXPECT_EQ(Of("[-0.15, 0, 0]", "[-150, 0, 0]"),
            At(6,
               "legs[1].base_joint_m is 150 m from the origin of its frame; give lengths in metres, not in "
               "millimetres"));
  EXPECT_EQ(Of("[0, 0.4]", "[0.4, 0]"),
            At(9, "legs[2].joint_range_m is [0.4, 0], reversed or empty; give [least, largest]"));
}

TEST_F(Refusal, NamesHomesThatLegsDoNotAllow) {
  EXPECT_EQ(Of("[0, 0.3, 0]", "[0, 0.6, 0]"),
            At(4,
               "home is a pose that legs[1] does not reach; give one that every leg reaches, or mend that "
               "leg"));
  EXPECT_EQ(Of("rotation_xyzw: [0, 0, 0, 1]", "rotation_xyzw: [1, 0, 0, 0]"),
            At(4,
               "home cannot be: home is tilted: this platform turns about z alone; give a rotation_xyzw "
               "whose x and y are 0"));
  const std::string rps = Bytes(kDatasets / "robots/3-rps.yaml");
  EXPECT_EQ(Of(Replaced(rps, "translation_m: [0, 0, 0.5]", "translation_m: [0.01, 0, 0.5]")),
            At(6,
               "home is a pose that the R joints of its legs do not allow; give one with every platform "
               "joint in the plane through its base joint across first_axis"));
}

TEST_F(Refusal, NamesLegsTooFewForThePlatform) {
  EXPECT_EQ(Of("planar-point", "planar"),
            At(6, "legs has 2 values for the 3 freedoms of the platform; give at least one leg a freedom"));
}

// Three R joints about vertical axes hold what the other three leave free; a fourth holds it twice.
TEST_F(Refusal, NamesRpsLegsThatHoldThePlatform) {
  std::string text = Bytes(kDatasets / "robots/3-rps.yaml");
  for (const auto& [base, platform] : {std::pair("[0.3, 0, 0.5]", "[0.2, 0, 0]"),
                                       {"[0, 0.3, 0.5]", "[0, 0.2, 0]"},
                                       {"[-0.3, 0, 0.5]", "[-0.2, 0, 0]"},
                                       {"[0, -0.3, 0.5]", "[0, -0.2, 0]"}})
    text +=
        fmt::format("  - {{chain: R_PS, base_joint_m: {}, first_axis: [0, 0, 1], platform_joint_m: {}}}\n",
                    base, platform);
  EXPECT_EQ(Of(text),
            At(8, "legs leave the platform no freedom: every RPS leg takes one of six; give fewer RPS legs"));
}

}  // namespace
}  // namespace legible
