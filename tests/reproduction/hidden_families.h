// Table 1 and sections 4.1.2, 4.2 and 4.3 of Briot et al. (2016): the legs of the hidden robots, how many
// assembly modes they have, which robots cannot be controlled, and which can by lines.
#pragma once

#include <string>

namespace legible {

// Markdown.
std::string HiddenLegsTable();
std::string ModeCountsTable();
std::string ControllabilityTable();

}  // namespace legible
