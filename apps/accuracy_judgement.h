// What a user should know before accuracy's numbers are trusted, in sentences without full stop.
#pragma once

#include <string>
#include <vector>

#include "apps/accuracy_run.h"

namespace legible {

// Of everything; standard error, the document and the page show the same.
std::vector<std::string> AccuracyWarnings(const AccuracyRun& run);

// Of the statistics over a box.
std::vector<std::string> WorkspaceWarnings(const Workspace& workspace);

// Which indices may be trusted to order poses of this robot by their errors; the first sentence says it in
// short.
std::vector<std::string> VerdictOn(const IndexComparison& comparison);

}  // namespace legible
