// The images of a folder.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace legible {

// Names of the files in a folder that end as images do, sorted. Throws InputError if it cannot be listed.
std::set<std::string> ImagesIn(const std::filesystem::path& folder);

}  // namespace legible
