// datasets/hexapod against what its renderer knew.
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/session_file.h"
#include "tests/datasets/files.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

using nlohmann::json;

const std::filesystem::path kFolder = std::filesystem::path(LEGIBLE_SOURCE_DIR) / "datasets" / "hexapod";

Eigen::Vector3d Vector3(const json& values) {
  return {values.at(0).get<double>(), values.at(1).get<double>(), values.at(2).get<double>()};
}

Rigid3 Rigid(const json& value) {
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 3; ++i) rotation.row(i) = Vector3(value.at("R").at(i));
  return {Eigen::Quaterniond(rotation).normalized(), Vector3(value.at("t"))};
}

json Truth() { return json::parse(std::ifstream(kFolder / "truth.json")); }

GoughStewart TrueRobot(const json& truth) {
  GoughStewart robot;
  for (int i = 0; i < kLegCount; ++i) {
    const json& leg = truth.at("legs").at(i);
    robot.legs[i].base_joint_m = Vector3(leg.at("A_base"));
    robot.legs[i].platform_joint_m = Vector3(leg.at("B_platform"));
    robot.legs[i].radius_m = leg.at("radius");
    robot.legs[i].joint_offset_m = leg.at("joint_offset");
  }
  return robot;
}

// Width and height, big-endian at byte 16 of a PNG file.
std::pair<int, int> PngSize(const std::filesystem::path& file) {
  const std::string bytes = Bytes(file);
  const auto integer = [&](size_t place) {
    int value = 0;
    for (size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes.at(place + i));
    return value;
  };
  return {integer(16), integer(20)};
}

TEST(ShippedSession, ReadsWithSixteenImagesOfTheCamerasSize) {
  const Session session = ReadSession(kFolder);
  ASSERT_EQ(session.images.size(), 16u);
  EXPECT_THAT(session.unlisted_images, testing::IsEmpty());
  for (const SessionImage& image : session.images) {
    EXPECT_EQ(PngSize(image.file), std::make_pair(session.camera.width_px, session.camera.height_px));
  }
  EXPECT_EQ(session.known.joint_reading_m, 2e-5);
  EXPECT_EQ(session.known.radius_m, 5e-4);
  EXPECT_TRUE(session.camera_from_base.has_value());
  ASSERT_TRUE(session.tags.has_value());
  EXPECT_EQ(session.tags->groups.size(), 2u);
}

TEST(ShippedSession, ReadingsAreThoseOfTheTruePosesWithinTheirNoise) {
  const Session session = ReadSession(kFolder);
  const json truth = Truth();
  const GoughStewart robot = TrueRobot(truth);
  ASSERT_EQ(truth.at("images").size(), session.images.size());
  for (size_t i = 0; i < session.images.size(); ++i) {
    const json& image = truth.at("images").at(i);
    EXPECT_EQ(image.at("name"), session.images[i].name);
    const Vector6d readings_m = InverseKinematics(robot, Rigid(image.at("base_from_platform")));
    EXPECT_TRUE(AreNear(session.images[i].joint_readings_m, readings_m, 5 * *session.known.joint_reading_m));
  }
}

TEST(ShippedSession, TheDrawingIsAsFarFromTheTruthAsTheReadmeSays) {
  const Session session = ReadSession(kFolder);
  const GoughStewart truth = TrueRobot(Truth());
  for (int i = 0; i < kLegCount; ++i) {
    const Leg &drawn = session.robot.legs[i], &real = truth.legs[i];
    EXPECT_TRUE(AreNear(drawn.base_joint_m, real.base_joint_m, 0.002));
    EXPECT_TRUE(AreNear(drawn.platform_joint_m, real.platform_joint_m, 0.002));
    EXPECT_NEAR(drawn.radius_m, real.radius_m, 0.0006);
    EXPECT_NEAR(drawn.joint_offset_m, real.joint_offset_m, 0.0015);
  }
}

}  // namespace
}  // namespace legible
