// Folders in which results wait until they are whole, and what is left of them by runs that were killed.
#pragma once

#include <filesystem>
#include <string>

namespace legible {

// ".legible-HOST-PROCESS.part", of this process.
std::string StagingName();

// Removes the staging folders in `folder` of processes of this host that are no more.
void RemoveAbandonedStaging(const std::filesystem::path& folder);

// Removes the files that WriteFileAtomically did not come to rename in `folder`. Only for whoever alone
// writes there.
void RemoveUnfinishedFiles(const std::filesystem::path& folder);

}  // namespace legible
