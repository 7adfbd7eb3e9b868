// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace legible {

// Writes `text` to a new file beside `path`, then renames that to `path`, replacing what was there.
// Throws InputError, and leaves nothing behind, if the folder is missing or cannot be written.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view text);

}  // namespace legible
