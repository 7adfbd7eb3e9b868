#include "apps/output_folder.h"

#include "datasets/input_error.h"
#include "datasets/staging.h"

namespace legible {
namespace {

namespace fs = std::filesystem;

// The folders that would have to be made for `folder` to be there, the innermost first.
std::vector<fs::path> MissingFolders(fs::path folder) {
  std::vector<fs::path> missing;
  for (; !folder.empty() && !fs::exists(folder); folder = folder.parent_path()) missing.push_back(folder);
  return missing;
}

// Where files wait, in the folder that they are for so that moving them is one step each. Gone afterwards,
// and so are the folders that were made for this and stayed empty.
class Staging {
 public:
  explicit Staging(const fs::path& folder) : made_(MissingFolders(folder)), path_(folder / StagingName()) {
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

void MoveResults(const fs::path& from, const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool is_written = fs::exists(from / name);
    if (!is_written || fs::is_directory(folder / name)) fs::remove_all(folder / name);
    if (is_written) fs::rename(from / name, folder / name);
  }
}

template <typename Action>
void OrInputError(const fs::path& folder, const std::string& option, Action action) {
  try {
    action();
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder, 0, "cannot be written: " + error.code().message(),
                     "name another folder with " + option);
  }
}

}  // namespace

void DemandWritable(const fs::path& folder, const std::vector<std::string>& names,
                    const std::string& option) {
  OrInputError(folder, option, [&] { const Staging trial(folder); });
  for (const std::string& name : names)
    if (fs::is_directory(folder / name))
      throw InputError(folder / name, 0, "is a folder where a file is to be written",
                       "remove it, or name another folder with " + option);
}

void WriteTogether(const fs::path& folder, const std::vector<std::string>& names,
                   const std::function<void(const fs::path&)>& write) {
  OrInputError(folder, "enough room", [&] {
    RemoveAbandonedStaging(folder);
    const Staging staging(folder);
    write(staging.path());
    MoveResults(staging.path(), folder, names);
  });
}

fs::path MakeNumberedFolder(const fs::path& folder, const std::string& prefix) {
  fs::path made;
  OrInputError(folder, "enough room", [&] {
    fs::create_directories(folder);
    for (int number = 1; made.empty(); ++number) {
      const fs::path wanted = folder / (prefix + std::to_string(number));
      if (!fs::exists(wanted) && fs::create_directory(wanted)) made = wanted;
    }
  });
  return made;
}

void MoveTogether(const fs::path& from, const fs::path& folder, const std::vector<std::string>& names) {
  OrInputError(folder, "enough room", [&] {
    RemoveAbandonedStaging(folder);
    fs::remove_all(folder / names.back());
    MoveResults(from, folder, names);
    fs::remove_all(from);
  });
}

}  // namespace legible
