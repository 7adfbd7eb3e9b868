#include "datasets/linuxcnc_file.h"

#include <fmt/format.h>

#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

constexpr char kHead[] =
    R"(# {robot} for LinuxCNC's genhexkins, lengths in {unit}. From the machine's HAL file, after
# `loadrt genhexkins`:  source THIS_FILE
#
# Leg 1 of legible is strut 0 here. base.N is where the strut's axis starts in the base frame, the machine's
# world; platform.N is where it ends in the platform frame, that of the drawing. X Y Z are then the platform
# frame's origin in the base frame, and A B C its roll, pitch and yaw: R = Rz(C) Ry(B) Rx(A).
)";

constexpr char kOffsets[] =
    R"(
# For the machine's ini file. genhexkins takes a joint's position for the length of its strut. What legible
# calibrated are the joint readings: strut length = reading + offset. A reading is a position since the joint
# was homed, where it was set to HOME_OFFSET at the switch or index; HOME_OFFSET raised by the offset raises
# every later position by it, and makes it the strut's length:
#
#   new HOME_OFFSET = HOME_OFFSET with which the readings of the calibration were taken + offset
#
# The numbers below are the offsets, right as they stand where that HOME_OFFSET was 0. HOME, MIN_LIMIT and
# MAX_LIMIT count like HOME_OFFSET: add the same to them. Home again before moving.
)";

constexpr char kLeftBehind[] =
    R"(
# genhexkins has no place for: the radii of the legs, their joint ranges, the home pose, the covariance, the
# camera and where it stands. Keep the calibration for them. spindle-offset and tool-offset move the joints
# along Z; screw-lead corrects struts whose screws turn with them: legible knows neither.
)";

const char* NameOf(LengthUnit unit) { return unit == LengthUnit::kInch ? "inch" : "mm"; }

std::string PointLines(const char* part, size_t leg, const Eigen::Vector3d& point) {
  std::string lines;
  for (int i = 0; i < 3; ++i)
    lines += fmt::format("setp genhexkins.{}.{}.{} {}\n", part, leg, "xyz"[i], NumberText(point[i]));
  return lines;
}

}  // namespace

std::string LinuxCncText(const GoughStewart& robot, LengthUnit unit) {
  const double per_metre = unit == LengthUnit::kInch ? 1 / 0.0254 : 1000;
  const std::string name = robot.name.empty() ? "A hexapod" : fmt::format("{:.80}", robot.name);
  std::string text = fmt::format(kHead, fmt::arg("robot", OneLine(name)), fmt::arg("unit", NameOf(unit)));
  for (size_t i = 0; i < kLegCount; ++i) {
    text += fmt::format("\n# leg {}\n", i + 1);
    text += PointLines("base", i, per_metre * robot.legs[i].base_joint_m);
    text += PointLines("platform", i, per_metre * robot.legs[i].platform_joint_m);
  }
  text += kOffsets;
  for (size_t i = 0; i < kLegCount; ++i)
    text += fmt::format("#\n# [JOINT_{}]\n# HOME_OFFSET = {}\n", i,
                        NumberText(per_metre * robot.legs[i].joint_offset_m));
  return text + kLeftBehind;
}

}  // namespace legible
