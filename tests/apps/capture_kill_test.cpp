// `legible capture` as a process, killed at random moments: no session is broken, no image lost.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

#include "core/stopwatch.h"
#include "core/vision/gray_image.h"
#include "datasets/session_file.h"
#include "tests/apps/process.h"
#include "tests/apps/simulated_rigs.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

namespace fs = std::filesystem;

constexpr int kKills = 200;
constexpr int kPoses = 10;

struct KnownImage {
  std::string bytes;
  Vector6d readings_m;
};

bool HasPart(const fs::path& folder) {
  if (!fs::is_directory(folder)) return false;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".part") return true;
  return false;
}

class CaptureKilled : public RigOnDisk {
 protected:
  explicit CaptureKilled(int width) : RigOnDisk(width) {}

  std::vector<std::string> Command(const std::vector<std::string>& what, bool resumes) const {
    std::vector<std::string> command = {
        LEGIBLE_PROGRAM, "capture",          "--rig",     "sim:" + truth().string(),
        "--out",         session().string(), "--threads", "2"};
    command.insert(command.end(), what.begin(), what.end());
    if (resumes) command.emplace_back("--resume");
    return command;
  }

  // In which stage the process was, by what it left.
  std::string Stage() const {
    if (!fs::exists(session())) return HasPart(folder_.path()) ? "before the first image" : "before anything";
    if (HasPart(session() / "images")) return "writing an image";
    if (HasPart(session())) return "writing the list";
    if (!ReadSession(session()).unlisted_images.empty()) return "between image and list";
    return "between images";
  }

  // Every listed image is whole, and those that were there before are what they were.
  void Check() {
    if (!fs::exists(session())) {
      EXPECT_TRUE(known_.empty()) << "the session is gone";
      return;
    }
    const Session read = ReadSession(session());
    std::map<std::string, KnownImage> now;
    for (const SessionImage& image : read.images) {
      const auto pixels = ReadGrayImage(image.file);
      ASSERT_TRUE(pixels) << image.file;
      EXPECT_EQ(pixels->width, read.camera.width_px);
      EXPECT_EQ(pixels->height, read.camera.height_px);
      now[image.name] = {Bytes(image.file), image.joint_readings_m};
    }
    for (const auto& [name, image] : known_) {
      ASSERT_TRUE(now.contains(name)) << name << " is lost";
      EXPECT_EQ(now[name].bytes, image.bytes) << name;
      EXPECT_EQ(now[name].readings_m, image.readings_m) << name;
    }
    known_ = std::move(now);
  }

  void BeginAnew() {
    fs::remove_all(session());
    known_.clear();
  }

  // Lets the last one end, and looks that nothing is left of the others.
  void ExpectANormalEnd(const std::vector<std::string>& what, size_t images) {
    EXPECT_EQ(Process(Command(what, true)).Wait(), kExitSuccess);
    Check();
    EXPECT_EQ(known_.size(), images);
    EXPECT_FALSE(HasPart(folder_.path()) || HasPart(session()) || HasPart(session() / "images"));
    EXPECT_TRUE(ReadSession(session()).unlisted_images.empty());
  }

  void KillRuns(const std::vector<std::string>& what, size_t images, int kills) {
    std::mt19937_64 generator = TestGenerator();
    double whole_s = INFINITY;  // the shorter of two: another process may have been in the way
    for (int i = 0; i < 2; ++i) {
      BeginAnew();
      const Stopwatch whole;
      ASSERT_EQ(Process(Command(what, false)).Wait(), kExitSuccess);
      whole_s = std::min(whole_s, whole.Seconds());
    }
    Check();
    EXPECT_EQ(known_.size(), images);
    BeginAnew();
    std::map<std::string, int> stages;
    for (int killed = 0; killed < kills && !HasFatalFailure();) {
      Process process(Command(what, fs::exists(session()) || Uniform(generator, 0, 1) < 0.5));
      if (process.KillAfter(Uniform(generator, 0, whole_s))) {
        ++killed;
        ++stages[Stage()];
        Check();
      } else {
        EXPECT_EQ(process.exit_code(), kExitSuccess);
        Check();
        EXPECT_EQ(known_.size(), images);
        BeginAnew();
      }
    }
    std::cout << "a whole run takes " << whole_s << " s; of " << kills << " kills";
    for (const auto& [stage, count] : stages) std::cout << "; " << count << " " << stage;
    std::cout << std::endl;
    ExpectANormalEnd(what, images);
  }

 private:
  std::map<std::string, KnownImage> known_;
};

class CaptureOfPosesKilled : public CaptureKilled {
 protected:
  CaptureOfPosesKilled() : CaptureKilled(96) {}
};
TEST_F(CaptureOfPosesKilled, LeavesASessionWithAllItsImages) {
  KillRuns({"--poses", WritePoses(kPoses)}, kPoses, kKills - 20);
}

class CaptureOfProposalsKilled : public CaptureKilled {
 protected:
  CaptureOfProposalsKilled() : CaptureKilled(640) {}
};
TEST_F(CaptureOfProposalsKilled, LeavesASessionWithAllItsImages) { KillRuns({"--count", "4"}, 4, 20); }

}  // namespace
}  // namespace legible
