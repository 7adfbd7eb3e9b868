// What each number of an accuracy document means, and in which unit it is.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/accuracy_run.h"

namespace legible {

// How messages, tables and plots call an index ("condition.two": "condition number, 2-norm").
std::string IndexLabel(const std::string& key);

// The members `units`, `conventions`, `definitions` of the document.
nlohmann::ordered_json UnitsJson(const AccuracyRun& run);
nlohmann::ordered_json ConventionsJson(const AccuracyRun& run);
nlohmann::ordered_json DefinitionsJson(const AccuracyRun& run);

}  // namespace legible
