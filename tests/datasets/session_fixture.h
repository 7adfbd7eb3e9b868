// A small session on disk, whose image files are not images: readers of sessions do not open them.
#pragma once

#include "datasets/camera_file.h"
#include "datasets/joint_file.h"
#include "datasets/robot_file.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/files.h"

namespace legible {

constexpr char kSessionYaml[] =
    "robot: robot.yaml\n"
    "camera: camera.yaml\n"
    "joints: joints.csv\n"
    "images: images\n"
    "known:\n"
    "  joint_reading_m: 2.0e-5\n";

constexpr char kJointsCsv[] =
    "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m\n"
    "b.png,0.40,0.41,0.42,0.43,0.44,0.45\n"
    "a.png,0.41,0.42,0.43,0.44,0.45,0.46\n";

class SessionOnDisk : public testing::Test {
 protected:
  SessionOnDisk() {
    WriteRobot(folder_.path() / "robot.yaml", DesktopHexapod());
    WriteCamera(folder_.path() / "camera.yaml", DesktopCamera(false));
    folder_.Write("session.yaml", kSessionYaml);
    folder_.Write("joints.csv", kJointsCsv);
    folder_.Write("images/a.png", "image a");
    folder_.Write("images/b.png", "image b");
  }

  TemporaryFolder folder_;
};

}  // namespace legible
