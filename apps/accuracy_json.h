// What `legible accuracy` found, as a document for programs; tables and pages are made from it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/accuracy_run.h"

namespace legible {

// {poses, units, …} in the units of the settings; docs/files.md lists its members. What has no value is null.
nlohmann::ordered_json AccuracyJson(const AccuracyRun& run);

}  // namespace legible
