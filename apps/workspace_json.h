// Statistics over a workspace as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/accuracy_run.h"

namespace legible {

// The member `workspace` of an accuracy document.
nlohmann::ordered_json WorkspaceJson(const Workspace& workspace, const AccuracySettings& settings);

}  // namespace legible
