// All there is to say about one judgement of accuracy: what went in, what came out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/index_comparison.h"
#include "accuracy/pose_accuracy.h"
#include "accuracy/workspace.h"
#include "accuracy/workspace_errors.h"
#include "apps/accuracy_settings.h"
#include "apps/progress.h"

namespace legible {

// A pose that was asked for.
struct JudgedPose {
  std::string name;
  Vector6d coordinates;  // as asked for: m, rad in the settings' convention
  Rigid3 base_from_platform;
  // "regular", "near_singular", "singular"; "out_of_reach": beyond the joint ranges; "impossible": the
  // mechanism cannot be oriented so, or joint readings lead to no pose. The last two have no accuracy.
  std::string status;
  std::string message;  // why it is not regular, in a sentence without full stop
  std::optional<PoseAccuracy> accuracy;

  bool HasErrors() const { return accuracy && accuracy->max_error; }
};

// Indices against errors: of which poses, and their names.
struct Comparison {
  std::string over;
  std::vector<std::string> names;
  IndexComparison indices;
};

// A box as it lies about the first pose that the robot can take.
struct LaidBox {
  BoxSetting setting;
  Box box;
  Vector6d about;                      // that pose's coordinates
  std::string over;                    // in words
  double characteristic_length_m = 1;  // one for all its poses
};

// Statistics of a box.
struct Workspace {
  LaidBox laid;
  bool crosses_singularity = false;  // samples of either sign of the determinant, or near a singularity
  WorkspaceStatistics statistics;    // quantities: the rows of ErrorEvaluator
};

// Maximal errors over two coordinates, for pictures.
struct ErrorMap {
  std::array<int, 2> axes = {0, 1};
  Eigen::VectorXd first, second;  // values of both coordinates
  Eigen::VectorXd held;           // the point whose other coordinates are kept
  BatchValues values;  // second.size() rows of first.size() points; states as if nothing were outside
  std::vector<bool> is_within_joint_ranges;
};

struct AccuracyRun {
  AccuracySettings settings;
  JudgedRobot robot;
  PoseAccuracyOptions options;
  std::vector<JudgedPose> poses;
  std::optional<Comparison> comparison;
  std::optional<Workspace> workspace;
  std::optional<ErrorMap> map;  // only for pages

  bool HasErrors() const;  // of a pose or of the workspace
};

// Reads what the settings name and evaluates it. Throws InputError on bad input: a file, options that this
// robot does not have, a list of poses of which the robot can reach none.
AccuracyRun JudgeAccuracy(const AccuracySettings& settings, ProgressLine& progress);

}  // namespace legible
