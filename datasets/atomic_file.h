// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace legible {

// Writes `text` to a new file beside `given_path`, then renames that to it, replacing what was there; where
// that is a symbolic link, what it points to. A device or a pipe is written to as it is. Throws InputError,
// and leaves nothing behind, if the folder is missing or cannot be written.
void WriteFileAtomically(const std::filesystem::path& given_path, std::string_view text);

}  // namespace legible
