// What `legible accuracy` does over a box of poses: statistics, the comparison of indices with errors, maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/accuracy_run.h"

namespace legible {

// All three lie about the first pose of the run that the robot can take, and throw InputError where the box
// cannot be laid or sampled as asked.
Workspace SampleBox(const AccuracyRun& run, const BoxSetting& setting, ProgressLine& progress);
std::optional<Comparison> CompareInBox(const AccuracyRun& run, const BoxSetting& setting,
                                       ProgressLine& progress);
std::optional<ErrorMap> MapOf(const AccuracyRun& run, const BoxSetting& setting);

// Of poses with errors; nothing for less than three.
std::optional<Comparison> ComparisonOver(const std::string& over, const std::vector<std::string>& names,
                                         const std::vector<const PoseAccuracy*>& poses);

}  // namespace legible
