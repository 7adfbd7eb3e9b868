#include "datasets/input_error.h"

#include <algorithm>
#include <cctype>

namespace legible {
namespace {

std::string Place(const std::filesystem::path& file, int line) {
  return line > 0 ? file.string() + ":" + std::to_string(line) : file.string();
}

// What a file holds is quoted in messages, and may hold anything.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

}  // namespace

InputError::InputError(const std::filesystem::path& file, int line, const std::string& what_is_wrong,
                       const std::string& what_to_do)
    : std::runtime_error(OneLine(Place(file, line) + ": " + what_is_wrong + "; " + what_to_do)) {}

}  // namespace legible
