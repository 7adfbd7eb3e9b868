// Whether joint readings and images answer what is commanded: drives that do not move, readings and images
// that are frozen.
#pragma once

#include <optional>

#include "servo/commanded_way.h"
#include "servo/cycle_input.h"
#include "servo/joint_following.h"
#include "servo/servo_end.h"
#include "servo/supervisor_options.h"

namespace legible {

class CommandAnswers {
 public:
  CommandAnswers(const ControlLawOptions& law, const SupervisorOptions& options);

  // To be told of each cycle: what came, and the speeds commanded since the last one.
  void Note(const CycleInput& input, const Vector6d& commanded_m_per_s);

  // The rest speaks of the newest cycle, and demands one.

  // How far each joint was commanded since its reading last changed, m, and in all.
  const Vector6d& WaySinceReadings() const { return way_since_readings_m_; }
  const Vector6d& CommandedInAll() const { return commanded_.InAll(); }

  // What a commanded way of unanswered_m, or the images' noise, proves. None: nothing is wrong.
  std::optional<Verdict> Judge() const;
  // What is proof enough where the error no longer falls: shorter ways.
  std::optional<Verdict> JudgeStalled() const;

 private:
  // Of the readings, or of the images, since they last changed.
  struct Unchanged {
    double since_s = 0;
    // Commanded before the first of those that are the same was taken, and from there to the newest.
    Vector6d answered_m = Vector6d::Zero(), unanswered_m = Vector6d::Zero();
  };

  void NoteReadings(const CycleInput& input, const Vector6d& commanded_m_per_s);
  void NoteImage(const CycleInput& input);
  bool DoReadingsStand() const;
  bool DoImagesStand() const;
  bool HaveImagesMovedSinceReadings() const;
  bool HaveJointsMovedSinceImages() const;
  std::optional<Verdict> JudgeDrives() const;
  std::optional<Verdict> JudgeReadings() const;
  std::optional<Verdict> JudgeImages() const;
  std::optional<Verdict> JudgeFollowing() const;

  bool looks_at_images_;
  SupervisorOptions options_;
  std::optional<CycleInput> newest_;
  CommandedWay commanded_;
  Vector6d way_since_readings_m_ = Vector6d::Zero();
  Unchanged readings_, images_;
  SeenEdges seen_at_readings_;  // when these last changed, and the readings when the images did
  Vector6d readings_at_images_m_ = Vector6d::Zero();
  JointFollowing following_;
};

}  // namespace legible
