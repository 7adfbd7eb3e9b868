// A session that is being held: image by image on the disk, and valid whenever the process ends.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/session/session.h"

namespace legible {

// The folder appears with its first image, complete: it is prepared beside and renamed. A further image is
// written beside, renamed, and then listed in a joints.csv that replaces the earlier one. So wherever the
// process is killed, what the folder holds is a session with every image that was listed.
//
// One process at a time: the folder is locked while this lives.
class GrowingSession {
 public:
  // A new session, with the robot, camera and knowledge of `description`. Throws InputError if there is
  // already something in the folder, or it cannot be made.
  GrowingSession(const std::filesystem::path& folder, const Session& description);
  // Goes on with the one there is; what a killed process left behind is removed. Throws InputError as
  // ReadSession, and if another process is at it.
  explicit GrowingSession(const std::filesystem::path& folder);
  ~GrowingSession();
  GrowingSession(const GrowingSession&) = delete;
  GrowingSession& operator=(const GrowingSession&) = delete;

  // png: the bytes of the file `name`, which the session does not have yet. Throws InputError where something
  // cannot be written; the session is then as it was.
  void Add(const std::string& name, std::string_view png, const Vector6d& joint_readings_m);

  // As it is on the disk; without images, the description.
  const Session& session() const { return session_; }

 private:
  void Lock(const std::filesystem::path& folder);
  void Begin(const std::string& name, std::string_view png);

  std::filesystem::path folder_, staging_;  // staging: empty once the session has appeared
  std::filesystem::path images_, joints_;
  Session session_;
  int lock_ = -1;
};

}  // namespace legible
