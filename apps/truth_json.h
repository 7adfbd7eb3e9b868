// truth.json: what the renderer of a session knew.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/simulated_session.h"

namespace legible {

// As datasets/hexapod/truth.json has it; see docs/files.md.
nlohmann::ordered_json TruthJson(const SimulatedSession& session);

}  // namespace legible
