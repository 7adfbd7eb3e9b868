#include "datasets/three_upu_file.h"

#include <gmock/gmock.h>

#include "tests/accuracy/upu_robots.h"
#include "tests/datasets/files.h"

namespace legible {
namespace {

const std::filesystem::path kShipped = LEGIBLE_SOURCE_DIR "/datasets/seoul-3upu/robot.yaml";

TEST(ThreeUpuFile, TheShippedRobotIsSeouls) {
  EXPECT_TRUE(HoldsThreeUpu(kShipped));
  const ThreeUpu read = ReadThreeUpu(kShipped), expected = SeoulUpu();
  EXPECT_EQ(read.name, "Seoul 3-UPU");
  EXPECT_EQ(read.home.translation, expected.home.translation);
  for (size_t i = 0; i < kUpuLegCount; ++i) {
    EXPECT_LT((read.legs[i].base_joint_m - expected.legs[i].base_joint_m).norm(), 1e-8);
    EXPECT_LT((read.legs[i].platform_joint_m - expected.legs[i].platform_joint_m).norm(), 1e-8);
    EXPECT_LT((read.legs[i].outer_axis - expected.legs[i].outer_axis).norm(), 1e-8);
    EXPECT_EQ(read.legs[i].joint_range_m, expected.legs[i].joint_range_m);
  }
}

TEST(ThreeUpuFile, AHexapodIsNone) {
  EXPECT_FALSE(HoldsThreeUpu(LEGIBLE_SOURCE_DIR "/datasets/merlet-gough/robot.yaml"));
}

TEST(ThreeUpuFile, ComplaintsNameWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string text = Bytes(kShipped);
  const auto complaint = [&](const std::string& old_part, const std::string& new_part) {
    return InputErrorOf(
        [&] { ReadThreeUpu(folder.Write("robot.yaml", Replaced(text, old_part, new_part))); });
  };
  EXPECT_THAT(complaint("outer_axis: [1, 0, 0]", "outer_axis: [0, 0, 0]"),
              testing::HasSubstr("legs[1].outer_axis has no direction"));
  EXPECT_THAT(complaint("rotation_xyzw: [0, 0, 0, 1]", "rotation_xyzw: [0, 0, 1, 0]"),
              testing::HasSubstr("home is turned"));
  EXPECT_THAT(complaint("outer_axis: [1, 0, 0], radius_m: 0.01, joint_range_m: [0.3, 0.6]",
                        "outer_axis: [1, 0, 0], radius_m: 0.01, joint_range_m: [0.6, 0.3]"),
              testing::HasSubstr("legs[1].joint_range_m is [0.6, 0.3], reversed or empty"));
  EXPECT_THAT(complaint("outer_axis: [1, 0, 0], radius_m: 0.01", "outer_axis: [1, 0, 0], radius_m: 0.4"),
              testing::HasSubstr("with the leg longer than it is thick"));
  EXPECT_THAT(complaint("outer_axis: [1, 0, 0], ", "outer_axes: [1, 0, 0], "),
              testing::HasSubstr("outer_axis"));
}

}  // namespace
}  // namespace legible
