// What `legible intrinsics` prints for people.
#pragma once

#include <string>

#include "apps/intrinsics_run.h"

namespace legible {

std::string SummaryText(const IntrinsicsRun& run);

}  // namespace legible
