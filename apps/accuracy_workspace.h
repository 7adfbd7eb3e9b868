// What `legible accuracy` does over a box of poses: statistics, the comparison of indices with errors, maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/accuracy_run.h"

namespace legible {

// Throws InputError where the box cannot be laid as asked.
LaidBox LayBox(const AccuracyRun& run, const BoxSetting& setting);

// Throws InputError where the box cannot be sampled as asked.
Workspace SampleBox(const AccuracyRun& run, const LaidBox& laid, ProgressLine& progress);
std::optional<Comparison> CompareInBox(const AccuracyRun& run, const LaidBox& laid, ProgressLine& progress);

// Over the first two coordinates that the box leaves free, the others as in the pose it lies about or, where
// that is outside, at the end of the box next to it. Nothing where less than two are free.
std::optional<ErrorMap> MapOf(const AccuracyRun& run, const LaidBox& laid);

// Of poses with errors; nothing for less than three.
std::optional<Comparison> ComparisonOver(const std::string& over, const std::vector<std::string>& names,
                                         const std::vector<const PoseAccuracy*>& poses);

}  // namespace legible
