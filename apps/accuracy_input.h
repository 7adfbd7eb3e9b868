// What `legible accuracy` reads: the robot, and the poses to judge.
#pragma once

#include "apps/accuracy_run.h"

namespace legible {

// MODEL, with options checked against it. Throws InputError.
JudgedRobot ReadJudgedRobot(const AccuracySettings& settings);
PoseAccuracyOptions PoseOptionsOf(const AccuracySettings& settings, const JudgedRobot& robot);

// The poses asked for, in the order --pose, --poses, --session; home if there is none. Those that the
// mechanism cannot take or reach have their status already. Throws InputError for files that cannot be read.
std::vector<JudgedPose> PosesToJudge(const AccuracySettings& settings, const JudgedRobot& robot);

}  // namespace legible
