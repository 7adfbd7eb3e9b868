#include "servo/command_answers.h"

#include <fmt/format.h>

#include <algorithm>

#include "servo/duration.h"
#include "servo/edge_motion.h"

namespace legible {
namespace {

constexpr double kSureWay_m = 2e-4;  // that is more than the noise of readings

std::string WayText(const FarthestLeg& farthest) {
  return fmt::format("leg {} was commanded by {:.1f} mm", farthest.leg + 1, 1e3 * farthest.way_m);
}

}  // namespace

CommandAnswers::CommandAnswers(const ControlLawOptions& law, const SupervisorOptions& options)
    : looks_at_images_(LooksAtImages(law)), options_(options) {}

void CommandAnswers::Note(const CycleInput& input, const Vector6d& commanded_m_per_s) {
  if (newest_) {
    // No command holds longer.
    const double held_s = std::min(input.time_s - newest_->time_s, Rig::kCommandHolds_s);
    const Vector6d way_m = held_s * commanded_m_per_s;
    commanded_.Add(input.time_s, way_m);
    way_since_readings_m_ += way_m;
    NoteReadings(input, commanded_m_per_s);
    NoteImage(input);
  } else {
    commanded_.Add(input.time_s, Vector6d::Zero());
    readings_.since_s = images_.since_s = input.time_s;
    seen_at_readings_ = input.seen;
    readings_at_images_m_ = input.readings.joint_readings_m;
  }
  newest_ = input;
}

// What was commanded after they were taken is not unanswered; it is still ahead of a reading.
void CommandAnswers::NoteReadings(const CycleInput& input, const Vector6d& commanded_m_per_s) {
  const StampedReadings &now = input.readings, &before = newest_->readings;
  const Vector6d way_at_readings_m = commanded_.At(now.time_s);
  if (now.joint_readings_m != before.joint_readings_m) {
    readings_.since_s = now.time_s;
    readings_.answered_m = way_at_readings_m;
    seen_at_readings_ = input.seen;
  }
  for (int i = 0; i < kLegCount; ++i)
    if (now.joint_readings_m[i] != before.joint_readings_m[i])
      way_since_readings_m_[i] = (input.time_s - now.time_s) * commanded_m_per_s[i];
  if (now.time_s != before.time_s) following_.Note(now.time_s, way_at_readings_m, now.joint_readings_m);
  readings_.unanswered_m = way_at_readings_m - readings_.answered_m;
}

void CommandAnswers::NoteImage(const CycleInput& input) {
  const Vector6d way_at_image_m = commanded_.At(input.seen.time_s);
  if (!SameEdges(input.seen, newest_->seen)) {
    images_.since_s = input.seen.time_s;
    images_.answered_m = way_at_image_m;
    readings_at_images_m_ = input.readings.joint_readings_m;
  }
  images_.unanswered_m = way_at_image_m - images_.answered_m;
}

bool CommandAnswers::DoReadingsStand() const {
  return Farthest(readings_.unanswered_m).way_m > options_.unanswered_m;
}

bool CommandAnswers::DoImagesStand() const {
  return looks_at_images_ && Farthest(images_.unanswered_m).way_m > options_.unanswered_m;
}

bool CommandAnswers::HaveImagesMovedSinceReadings() const {
  return looks_at_images_ && HaveMoved(seen_at_readings_, newest_->seen);
}

bool CommandAnswers::HaveJointsMovedSinceImages() const {
  return (newest_->readings.joint_readings_m - readings_at_images_m_).cwiseAbs().maxCoeff() > kSureWay_m;
}

std::optional<Verdict> CommandAnswers::Judge() const {
  std::optional<Verdict> verdict = JudgeDrives();
  if (!verdict) verdict = JudgeReadings();
  if (!verdict) verdict = JudgeImages();
  if (!verdict) verdict = JudgeFollowing();
  return verdict;
}

// Readings and images both stand.
std::optional<Verdict> CommandAnswers::JudgeDrives() const {
  const bool by_readings = DoReadingsStand() && looks_at_images_ && !HaveImagesMovedSinceReadings();
  const bool by_images = DoImagesStand() && !HaveJointsMovedSinceImages();
  if (!by_readings && !by_images) return std::nullopt;
  const Unchanged& standing = DoReadingsStand() ? readings_ : images_;
  return Ended(ServoEnd::kDrivesDoNotMove,
               fmt::format("neither joint readings nor images show any motion though {}: the drives do not "
                           "move{}",
                           WayText(Farthest(standing.unanswered_m)),
                           DoReadingsStand() && HasNoise(newest_->seen)
                               ? ", or the joint readings are frozen and the images too noisy to tell"
                               : ""));
}

std::optional<Verdict> CommandAnswers::JudgeReadings() const {
  if (!DoReadingsStand()) return std::nullopt;
  return Ended(
      ServoEnd::kFrozenReadings,
      fmt::format("the joint readings have not changed for {:.2f} s though {}: they are frozen{}",
                  newest_->time_s - readings_.since_s, WayText(Farthest(readings_.unanswered_m)),
                  looks_at_images_ ? ", for the images show motion" : ", or the drives do not move"));
}

std::optional<Verdict> CommandAnswers::JudgeImages() const {
  const double for_s = newest_->time_s - images_.since_s;
  const bool repeats = looks_at_images_ && HasNoise(newest_->seen) && IsLongerThan(for_s, options_.stale_s);
  if (!DoImagesStand() && !repeats) return std::nullopt;
  return Ended(ServoEnd::kFrozenImages,
               fmt::format("the images have not changed for {:.2f} s{}: they are frozen", for_s,
                           DoImagesStand() ? " though " + WayText(Farthest(images_.unanswered_m))
                                           : ", not even by their noise"));
}

// Joint by joint: one frozen reading among others, or drives that stand while their readings are noisy.
std::optional<Verdict> CommandAnswers::JudgeFollowing() const {
  const bool all_stand = !readings_.unanswered_m.isZero(0);  // judged with the images
  const auto behind = all_stand ? std::nullopt : following_.Farthest(options_.unanswered_m);
  if (!behind) return std::nullopt;
  const std::string way = fmt::format("leg {} was commanded by {:.1f} mm in {:.2f} s", behind->joint + 1,
                                      1e3 * behind->commanded_m, behind->for_s);
  if (behind->has_not_changed)
    return Ended(
        ServoEnd::kFrozenReadings,
        fmt::format("{} and its joint reading has not changed: it is frozen, or the drives do not move",
                    way));
  return Ended(ServoEnd::kDrivesDoNotMove,
               fmt::format("{} and moved by {:.1f} mm: the drives do not move, or its joint reading is wrong",
                           way, 1e3 * behind->made_m));
}

std::optional<Verdict> CommandAnswers::JudgeStalled() const {
  const double images_for_s = newest_->time_s - images_.since_s;
  if (looks_at_images_ && IsLongerThan(images_for_s, options_.stale_s) && HaveJointsMovedSinceImages())
    return Ended(
        ServoEnd::kFrozenImages,
        fmt::format("the images have not changed for {:.2f} s though the joints moved: they are frozen",
                    images_for_s));
  if (Farthest(readings_.unanswered_m).way_m > kLeastWay_m && HaveImagesMovedSinceReadings())
    return Ended(
        ServoEnd::kFrozenReadings,
        fmt::format("the joint readings have not changed for {:.2f} s: they are frozen, for the images "
                    "show motion",
                    newest_->time_s - readings_.since_s));
  return std::nullopt;
}

}  // namespace legible
