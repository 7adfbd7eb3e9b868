#include "datasets/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "datasets/input_error.h"

namespace legible {
namespace {

[[noreturn]] void FailToWrite(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(path, 0, fmt::format("cannot be written: {}", reason),
                   "name a place in a folder that exists and can be written");
}

bool Write(const std::filesystem::path& path, std::string_view text) {
  std::ofstream file(path, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  return !file.fail();
}

// A device or a pipe: a file renamed onto it would take its place.
bool IsNoFile(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto type = std::filesystem::status(path, ignored).type();
  return type != std::filesystem::file_type::regular && type != std::filesystem::file_type::directory;
}

}  // namespace

void WriteFileAtomically(const std::filesystem::path& given_path, std::string_view text) {
  std::error_code unresolved;
  const std::filesystem::path target = std::filesystem::weakly_canonical(given_path, unresolved);
  const std::filesystem::path& path = unresolved ? given_path : target;
  if (std::filesystem::exists(path, unresolved) && IsNoFile(path)) {
    errno = 0;
    if (!Write(path, text)) FailToWrite(given_path, std::strerror(errno));
    return;
  }
  const std::filesystem::path part =
      path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(), getpid());
  std::error_code ignored;
  errno = 0;
  if (!Write(part, text)) {
    const std::string reason = std::strerror(errno);
    std::filesystem::remove(part, ignored);
    FailToWrite(given_path, reason);
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) {
    std::filesystem::remove(part, ignored);
    FailToWrite(given_path, error.message());
  }
}

}  // namespace legible
