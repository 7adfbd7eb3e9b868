// Whether two results came from the same files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace legible {

// SHA-256, 64 hexadecimal digits, of the lines that `sha256sum` prints for each of these files in its folder,
// in this order. Throws InputError if one cannot be read. (Of a session: see session_file.h.)
std::string ContentHash(const std::vector<std::filesystem::path>& files);

}  // namespace legible
