// The folder of a command's results, whose files appear together or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace legible {

// Throws InputError, and leaves everything as it was, unless the folder can be written, or made where it is
// missing, and files of these names can come into it. The option is the one that names the folder.
void DemandWritable(const std::filesystem::path& folder, const std::vector<std::string>& names,
                    const std::string& option = "--out");

// Calls `write` with an empty folder beside the results; then moves what it wrote there into `folder`,
// replacing what was there, folders too. Those of `names` that `write` did not write are removed: they would
// be an earlier run's, and so is what a run on this host that was killed left half-written. Throws InputError
// if that fails, and whatever `write` throws; the files are then as they were.
void WriteTogether(const std::filesystem::path& folder, const std::vector<std::string>& names,
                   const std::function<void(const std::filesystem::path&)>& write);

// Makes FOLDER/PREFIXN, N the first number from 1 that is free there, for results that grow: they stay if the
// program is killed. Throws InputError if it cannot.
std::filesystem::path MakeNumberedFolder(const std::filesystem::path& folder, const std::string& prefix);

// Moves such results into `folder` once they are whole, as WriteTogether does, and removes theirs. Throws
// InputError if that fails.
void MoveTogether(const std::filesystem::path& from, const std::filesystem::path& folder,
                  const std::vector<std::string>& names);

}  // namespace legible
