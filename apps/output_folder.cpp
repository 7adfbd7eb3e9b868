#include "apps/output_folder.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>

#include "datasets/input_error.h"

namespace legible {
namespace {

namespace fs = std::filesystem;

constexpr char kStagingEnd[] = ".part";

// The folders that would have to be made for `folder` to be there, the innermost first.
std::vector<fs::path> MissingFolders(fs::path folder) {
  std::vector<fs::path> missing;
  for (; !folder.empty() && !fs::exists(folder); folder = folder.parent_path()) missing.push_back(folder);
  return missing;
}

// "legible-HOST-": folders of other hosts' processes, and anything else, are not ours to judge.
std::string StagingStart() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format(".legible-{}-", host);
}

// The process whose staging folder has this name; nothing for other names.
std::optional<pid_t> StagedBy(const std::string& name) {
  const std::string start = StagingStart();
  if (!name.starts_with(start) || !name.ends_with(kStagingEnd)) return std::nullopt;
  pid_t process = 0;
  const char* const end = name.data() + name.size() - std::strlen(kStagingEnd);
  const auto [stop, error] = std::from_chars(name.data() + start.size(), end, process);
  return error == std::errc() && stop == end && process > 0 ? std::optional(process) : std::nullopt;
}

// Staging folders of processes that were killed while they wrote.
void RemoveAbandoned(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto process = StagedBy(entry.path().filename());
    const bool is_ours = process && entry.symlink_status().type() == fs::file_type::directory;
    if (is_ours && kill(*process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
  }
}

// Where files wait, in the folder that they are for so that moving them is one step each. Gone afterwards,
// and so are the folders that were made for this and stayed empty.
class Staging {
 public:
  explicit Staging(const fs::path& folder)
      : made_(MissingFolders(folder)),
        path_(folder / fmt::format("{}{}{}", StagingStart(), getpid(), kStagingEnd)) {
    try {
      fs::create_directories(path_);
    } catch (const fs::filesystem_error&) {
      Remove();
      throw;
    }
  }
  ~Staging() { Remove(); }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const fs::path& path() const { return path_; }

 private:
  void Remove() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    for (const fs::path& folder : made_) fs::remove(folder, ignored);
  }

  std::vector<fs::path> made_;
  fs::path path_;
};

template <typename Action>
void OrInputError(const fs::path& folder, Action action) {
  try {
    action();
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder, 0, "cannot be written: " + error.code().message(),
                     "name another folder with --out");
  }
}

}  // namespace

void DemandWritable(const fs::path& folder, const std::vector<std::string>& names) {
  OrInputError(folder, [&] { const Staging trial(folder); });
  for (const std::string& name : names)
    if (fs::is_directory(folder / name))
      throw InputError(folder / name, 0, "is a folder where a file is to be written",
                       "remove it, or name another folder with --out");
}

void WriteTogether(const fs::path& folder, const std::vector<std::string>& names,
                   const std::function<void(const fs::path&)>& write) {
  OrInputError(folder, [&] {
    RemoveAbandoned(folder);
    const Staging staging(folder);
    write(staging.path());
    for (const std::string& name : names) {
      const bool is_written = fs::exists(staging.path() / name);
      if (!is_written || fs::is_directory(folder / name)) fs::remove_all(folder / name);
      if (is_written) fs::rename(staging.path() / name, folder / name);
    }
  });
}

}  // namespace legible
