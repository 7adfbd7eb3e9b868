// How counts are put into sentences.
#pragma once

#include <fmt/format.h>

#include <string>

namespace legible {

// "1 image", "2 images".
inline std::string Plural(int count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace legible
