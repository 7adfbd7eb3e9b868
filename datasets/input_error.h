// The one exception of bad input: it says where, what is wrong and what to do.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace legible {

// what() is "FILE:LINE: what is wrong; what to do", without LINE where `line` (from 1) is 0; always one line
// of text, with blanks for line ends and other control characters of what was read.
class InputError : public std::runtime_error {
 public:
  InputError(const std::filesystem::path& file, int line, const std::string& what_is_wrong,
             const std::string& what_to_do);
};

}  // namespace legible
