// Files for tests of readers and writers, in a folder that is gone afterwards.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "datasets/input_error.h"

namespace legible {

// An empty folder for the running test, removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("legible-") + test->test_suite_name() +
                                                      "-" + test->name() + "-" + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes a file below the folder, making folders on the way.
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  // The names of what is directly in the folder.
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string Bytes(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// `text` with its one occurrence of `old_part` replaced.
inline std::string Replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  const size_t place = text.find(old_part);
  if (place == std::string::npos || text.find(old_part, place + 1) != std::string::npos) {
    throw std::logic_error("not there exactly once: " + old_part);
  }
  return text.replace(place, old_part.size(), new_part);
}

// The message of the InputError that `action` throws.
template <typename Action>
std::string InputErrorOf(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

// "FILE:LINE: message", or "FILE: message" for line 0.
inline std::string Complaint(const std::filesystem::path& file, int line, const std::string& message) {
  std::string place = file.string();
  if (line > 0) place.append(":").append(std::to_string(line));
  return place + ": " + message;
}

}  // namespace legible
