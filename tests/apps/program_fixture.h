// The program run on copies of the shipped session, in process.
#pragma once

#include <map>
#include <sstream>

#include "apps/program.h"
#include "tests/datasets/files.h"

namespace legible {

struct ProgramRun {
  int exit_code = 0;
  std::string out, err;
};

inline ProgramRun RunLegible(const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  const int exit_code = RunProgram(arguments, {out, err, false});
  return {exit_code, out.str(), err.str()};
}

// A folder with datasets/hexapod in `session`, its images as links, for a test to break.
class HexapodSession : public testing::Test {
 protected:
  HexapodSession() {
    namespace fs = std::filesystem;
    const fs::path shipped = fs::path(LEGIBLE_SOURCE_DIR) / "datasets" / "hexapod";
    fs::create_directories(images());
    for (const auto& file : fs::directory_iterator(shipped))
      if (file.is_regular_file()) fs::copy(file, session());
    for (const auto& image : fs::directory_iterator(shipped / "images"))
      fs::create_symlink(image, images() / image.path().filename());
  }

  std::filesystem::path session() const { return folder_.path() / "session"; }
  std::filesystem::path images() const { return session() / "images"; }
  std::filesystem::path out() const { return folder_.path() / "out"; }

  void Edit(const std::string& file, const std::string& old_part, const std::string& new_part) const {
    folder_.Write("session/" + file, Replaced(Bytes(session() / file), old_part, new_part));
  }

  // The session's first images only: rows of joints.csv, and their files.
  void KeepImages(int count) const {
    std::istringstream lines(Bytes(session() / "joints.csv"));
    std::string kept, line;
    for (int i = 0; std::getline(lines, line); ++i) {
      if (i <= count)
        kept += line + "\n";
      else
        std::filesystem::remove(images() / line.substr(0, line.find(',')));
    }
    folder_.Write("session/joints.csv", kept);
  }

  // Cuts the image's file off in the middle.
  void Truncate(const std::string& image) const {
    const std::string bytes = Bytes(images() / image);
    std::filesystem::remove(images() / image);
    folder_.Write("session/images/" + image, bytes.substr(0, bytes.size() / 2));
  }

  ProgramRun RunOnIt(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"calibrate", session().string(), "--out", out().string()});
    return RunLegible(options);
  }

  // Bad input or usage: exit code 2, the one line "legible: …" that `line` matches, and nothing written
  // anywhere.
  void ExpectRefusal(const ProgramRun& run, const testing::Matcher<const std::string&>& line) const {
    EXPECT_EQ(run.exit_code, kExitBadInput);
    EXPECT_THAT(run.err, line);
    EXPECT_THAT(run.err, testing::StartsWith("legible: "));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(folder_.Names(), testing::ElementsAre("session"));
  }

  TemporaryFolder folder_;
};

}  // namespace legible
