#include "datasets/growing_session.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "datasets/atomic_file.h"
#include "datasets/input_error.h"
#include "datasets/joint_file.h"
#include "datasets/session_file.h"
#include "datasets/staging.h"

namespace legible {
namespace {

namespace fs = std::filesystem;

constexpr char kImages[] = "images";

// Without a slash at its end, so that its parent is the folder it stands in.
fs::path Plain(const fs::path& folder) {
  const fs::path plain = fs::weakly_canonical(fs::absolute(folder));
  return plain.has_filename() ? plain : plain.parent_path();
}

void DemandNothingThere(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (fs::exists(folder / "session.yaml"))
    throw InputError(folder, 0, "holds a session already",
                     "go on with it by --resume, or name another folder");
  if (!fs::is_directory(folder) || !fs::is_empty(folder))
    throw InputError(folder, 0, "is there already, and is no session", "name another folder");
}

template <typename Action>
void OrInputError(const fs::path& folder, Action action) {
  try {
    action();
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder, 0, "cannot be written: " + error.code().message(), "name another folder");
  }
}

std::vector<JointRow> RowsOf(const Session& session) {
  std::vector<JointRow> rows;
  rows.reserve(session.images.size() + 1);
  for (const SessionImage& image : session.images) rows.push_back({image.name, image.joint_readings_m});
  return rows;
}

}  // namespace

GrowingSession::GrowingSession(const fs::path& folder, const Session& description) : session_(description) {
  OrInputError(folder, [&] {
    folder_ = Plain(folder);
    DemandNothingThere(folder_);
    const fs::path beside = folder_.parent_path();
    fs::create_directories(beside);
    RemoveAbandonedStaging(beside);
    staging_ = beside / StagingName();
    fs::create_directory(staging_);
  });
  session_.folder = folder_;
  session_.images.clear();
  images_ = folder_ / kImages;
  joints_ = folder_ / "joints.csv";
}

GrowingSession::GrowingSession(const fs::path& folder) {
  OrInputError(folder, [&] { folder_ = Plain(folder); });
  session_ = ReadSession(folder_);
  Lock(folder_);
  try {
    session_ = ReadSession(folder_);  // now that nobody else changes it
  } catch (...) {
    close(lock_);
    throw;
  }
  joints_ = session_.files.at(3);
  images_ = session_.images.front().file.parent_path();
  RemoveUnfinishedFiles(folder_);
  RemoveUnfinishedFiles(images_);
  RemoveAbandonedStaging(folder_.parent_path());
}

GrowingSession::~GrowingSession() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (lock_ >= 0) close(lock_);
}

// Held until this ends, or the process does.
void GrowingSession::Lock(const fs::path& folder) {
  if (lock_ >= 0) close(lock_);
  lock_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0)
    throw InputError(folder_, 0, std::string("cannot be opened: ") + std::strerror(errno),
                     "name another folder");
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const bool is_taken = errno == EWOULDBLOCK;
  close(std::exchange(lock_, -1));
  if (is_taken)
    throw InputError(folder_, 0, "is being captured into by another process", "wait for it, or stop it");
}

void GrowingSession::Add(const std::string& name, std::string_view png, const Vector6d& joint_readings_m) {
  session_.images.push_back({name, images_ / name, joint_readings_m});
  try {
    if (!staging_.empty()) {
      Begin(name, png);
    } else {
      WriteFileAtomically(images_ / name, png);
      WriteJoints(joints_, RowsOf(session_));
    }
  } catch (...) {
    session_.images.pop_back();
    throw;
  }
}

void GrowingSession::Begin(const std::string& name, std::string_view png) {
  OrInputError(folder_, [&] {
    fs::create_directories(staging_ / kImages);
    WriteFileAtomically(staging_ / kImages / name, png);
    WriteSession(staging_, session_);
    Lock(staging_);
    fs::rename(staging_, folder_);
    staging_.clear();
  });
}

}  // namespace legible
