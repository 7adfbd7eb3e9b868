#include "datasets/input_error.h"

#include "datasets/text.h"

namespace legible {
namespace {

std::string Place(const std::filesystem::path& file, int line) {
  return line > 0 ? file.string() + ":" + std::to_string(line) : file.string();
}

}  // namespace

InputError::InputError(const std::filesystem::path& file, int line, const std::string& what_is_wrong,
                       const std::string& what_to_do)
    : std::runtime_error(OneLine(Place(file, line) + ": " + what_is_wrong + "; " + what_to_do)) {}

}  // namespace legible
