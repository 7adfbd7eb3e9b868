#include "datasets/staging.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>

namespace legible {
namespace {

namespace fs = std::filesystem;

constexpr char kStagingEnd[] = ".part";

// "legible-HOST-": folders of other hosts' processes, and anything else, are not ours to judge.
std::string StagingStart() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format(".legible-{}-", host);
}

std::optional<pid_t> ProcessIn(const char* begin, const char* end) {
  pid_t process = 0;
  const auto [stop, error] = std::from_chars(begin, end, process);
  return error == std::errc() && stop == end && process > 0 ? std::optional(process) : std::nullopt;
}

// The process whose staging folder has this name; nothing for other names.
std::optional<pid_t> StagedBy(const std::string& name) {
  const std::string start = StagingStart();
  if (!name.starts_with(start) || !name.ends_with(kStagingEnd)) return std::nullopt;
  return ProcessIn(name.data() + start.size(), name.data() + name.size() - std::strlen(kStagingEnd));
}

// ".NAME.PROCESS.part"
bool IsUnfinishedFile(const std::string& name) {
  if (!name.starts_with('.') || !name.ends_with(kStagingEnd)) return false;
  const std::string rest = name.substr(0, name.size() - std::strlen(kStagingEnd));
  const size_t dot = rest.rfind('.');
  return dot != std::string::npos && dot > 0 &&
         ProcessIn(rest.data() + dot + 1, rest.data() + rest.size()).has_value();
}

}  // namespace

std::string StagingName() { return fmt::format("{}{}{}", StagingStart(), getpid(), kStagingEnd); }

void RemoveAbandonedStaging(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto process = StagedBy(entry.path().filename());
    const bool is_ours = process && entry.symlink_status().type() == fs::file_type::directory;
    if (is_ours && kill(*process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
  }
}

void RemoveUnfinishedFiles(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.symlink_status().type() == fs::file_type::regular && IsUnfinishedFile(entry.path().filename()))
      fs::remove(entry.path(), ignored);
}

}  // namespace legible
