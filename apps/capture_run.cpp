#include "apps/capture_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/interruption.h"
#include "apps/wording.h"
#include "core/rig/image_at_rest.h"
#include "core/stopwatch.h"
#include "datasets/input_error.h"
#include "servo/drive_joints.h"

namespace legible {
namespace {

constexpr int kMostFailures = 5;          // in a row
constexpr double kUsualReading_m = 2e-5;  // noise, where nothing is known of it
constexpr double kSameReadings_m = 1e-3;  // within which two images may look alike

struct Target {
  std::string name;  // of the image
  Rigid3 base_from_platform;
  Vector6d joint_readings_m = Vector6d::Zero();
};

class Capturer {
 public:
  Capturer(PreparedCapture& prepared, const CaptureListener& listener)
      : settings_(prepared.settings),
        poses_(prepared.poses),
        rig_(*prepared.rig.rig),
        growing_(*prepared.session),
        listener_(listener),
        outlook_(growing_.session(),
                 {!settings_.poses, static_cast<std::uint64_t>(settings_.seed), settings_.threads}) {
    run_.images_before = static_cast<int>(growing_.session().images.size());
    run_.expected = outlook_.Expected();
    drive_.limits.speed_limit_m_per_s = settings_.speed_limit_m_per_s;
    drive_.is_stopped = [this] { return interruption_.HasCome(); };
    rest_.is_stopped = drive_.is_stopped;
    rest_.reading_sigma_m = growing_.session().known.joint_reading_m.value_or(kUsualReading_m);
  }

  CaptureRun Run() {
    try {
      while (run_.reason.empty()) Step();
    } catch (const RigError& error) {
      run_.reason = std::string("the rig does not answer: ") + error.what();
    } catch (const InputError& error) {
      run_.reason = error.what();
    }
    rig_.Stop();
    return std::move(run_);
  }

 private:
  void Step() {
    if (IsDone()) return;
    const Stopwatch proposing;
    const std::optional<Target> target = settings_.poses ? NextOfFile() : NextProposed();
    CaptureTimes times;
    times.propose_s = proposing.Seconds();
    if (!target) {
      Finish();
      return;
    }
    if (TakeAt(*target, times)) {
      failures_ = 0;
      return;
    }
    if (++failures_ >= kMostFailures && run_.reason.empty()) run_.reason = WhyGivenUp();
  }

  std::string WhyGivenUp() const {
    return fmt::format(
        "{} poses in a row gave no image of use; the last one: {}; {}, then go on with --resume", failures_,
        run_.rejected.back().reason,
        last_was_looked_at_ ? "see that the legs are lit and in the picture, and that robot and camera are, "
                              "and stand, as the drawing and the first guess of the camera say"
                            : "see what keeps the robot from going there or from standing still");
  }

  int Count() const { return static_cast<int>(growing_.session().images.size()); }
  int Limit() const { return settings_.count.value_or(kUsualImages); }

  bool IsDone() {
    const auto& sigma_m = run_.expected.position_m;
    if (settings_.until_m && sigma_m && *sigma_m <= *settings_.until_m)
      End(true, fmt::format("σ of predicted positions is expected to be {:.4g} mm, {:.4g} mm were asked for",
                            1e3 * *sigma_m, 1e3 * *settings_.until_m));
    else if (!settings_.poses && Count() >= Limit())
      EndByCount();
    return !run_.reason.empty();
  }

  // Where a sigma alone was asked for, the usual number of images is only how long that is tried.
  void EndByCount() {
    const bool is_complete = settings_.count || !settings_.until_m;
    const std::string images = fmt::format("the session has {}", Plural(Count(), "image"));
    End(is_complete, is_complete ? images : images + ", and " + SigmaText());
  }

  std::string SigmaText() const {
    const auto& sigma_m = run_.expected.position_m;
    return sigma_m ? fmt::format("σ of predicted positions is still {:.4g} mm", 1e3 * *sigma_m)
                   : std::string("σ of predicted positions is still open");
  }

  void End(bool is_complete, const std::string& reason) {
    run_.is_complete = is_complete;
    run_.reason = reason;
  }

  // No pose is left.
  void Finish() {
    if (!settings_.poses) return End(false, "no pose is left to propose: " + CandidatesText());
    if (missing_.empty())
      return End(!settings_.until_m, settings_.until_m ? "all poses are taken, and " + SigmaText()
                                                       : std::string("all poses are taken"));
    std::string names;
    for (const std::string& name : missing_) names += (names.empty() ? "" : ", ") + name;
    End(false,
        fmt::format("{} could not be taken: {}", Plural(static_cast<int>(missing_.size()), "pose"), names));
  }

  std::string CandidatesText() const {
    const PoseCandidates& candidates = outlook_.candidates();
    return fmt::format("of {} drawn ones {} are out of reach and {} show too little of the legs",
                       candidates.drawn, candidates.out_of_reach, candidates.out_of_sight);
  }

  bool Has(const std::string& name) const {
    const auto& images = growing_.session().images;
    return std::any_of(images.begin(), images.end(),
                       [&](const SessionImage& image) { return image.name == name; });
  }

  std::optional<Target> NextOfFile() {
    for (; next_pose_ < poses_.size(); ++next_pose_) {
      const NamedPose& pose = poses_[next_pose_];
      if (Has(pose.name)) continue;
      ++next_pose_;
      return Target{pose.name, pose.base_from_platform,
                    InverseKinematics(growing_.session().robot, pose.base_from_platform)};
    }
    return std::nullopt;
  }

  std::optional<Target> NextProposed() const {
    const auto proposal = outlook_.Next();
    if (!proposal) return std::nullopt;
    int number = Count();
    while (Has(fmt::format("{:03}.png", number))) ++number;
    return Target{fmt::format("{:03}.png", number), proposal->base_from_platform, proposal->joint_readings_m};
  }

  // Whether it is in the session.
  bool TakeAt(const Target& target, CaptureTimes times) {
    Stopwatch watch;
    listener_.doing(fmt::format("driving to the pose of {}", target.name));
    if (!DriveTo(target)) return false;
    times.drive_s = watch.Lap();
    listener_.doing(fmt::format("taking {}", target.name));
    const ImageAtRest shot = TakeImageAtRest(rig_, rest_);
    run_.rig_time_s = rig_.Now();
    times.image_s = watch.Lap();
    if (interruption_.HasCome()) return Fail(target, shot.missing, true);
    if (!shot.missing.empty()) return Fail(target, shot.missing, !shot.readings.joint_readings_m.allFinite());
    if (IsOldContent(shot))
      return Fail(target, "the camera gives the same image again though the robot has moved: it is frozen",
                  true);
    const Sighting sighting = outlook_.Look(target.name, shot.image.image, shot.readings.joint_readings_m);
    times.look_s = watch.Lap();
    if (!sighting.unusable.empty() && !settings_.poses) return Fail(target, sighting.unusable, false, true);
    growing_.Add(target.name, EncodePng(shot.image.image), shot.readings.joint_readings_m);
    times.store_s = watch.Lap();
    last_ = shot;
    outlook_.Add(growing_.session(), sighting);
    Warn(outlook_.trouble());
    run_.expected = outlook_.Expected();
    times.outlook_s = watch.Lap();
    run_.images.push_back({target.name, target.base_from_platform, shot.readings.joint_readings_m,
                           sighting.edges, sighting.unusable, run_.expected, times});
    listener_.captured(run_.images.back());
    return true;
  }

  // Once.
  void Warn(const std::string& sentence) {
    if (sentence.empty() || sentence == last_warning_) return;
    last_warning_ = sentence;
    run_.warnings.push_back(sentence);
    listener_.warned(sentence);
  }

  bool DriveTo(const Target& target) {
    const GoughStewart& robot = growing_.session().robot;
    JointDrive drive = DriveJoints(rig_, robot, target.joint_readings_m, drive_);
    if (!drive.has_arrived && !drive.is_hopeless) {
      // The way there may be the trouble: from home it is known to be free.
      DriveJoints(rig_, robot, InverseKinematics(robot, robot.home), drive_);
      drive = DriveJoints(rig_, robot, target.joint_readings_m, drive_);
    }
    return drive.has_arrived || Fail(target, drive.reason, drive.is_hopeless);
  }

  // Returns false, for whoever failed.
  bool Fail(const Target& target, const std::string& reason, bool is_hopeless, bool is_looked_at = false) {
    if (interruption_.HasCome()) {
      End(false, "stopped by the user");
      return false;
    }
    if (is_hopeless) {
      End(false, reason);
      return false;
    }
    last_was_looked_at_ = is_looked_at;
    outlook_.Reject(target.base_from_platform, !is_looked_at);
    missing_.push_back(target.name);
    run_.rejected.push_back({target.name, target.base_from_platform, reason});
    listener_.rejected(run_.rejected.back());
    return false;
  }

  bool IsOldContent(const ImageAtRest& shot) const {
    if (!last_) return false;
    const Vector6d moved_m = shot.readings.joint_readings_m - last_->readings.joint_readings_m;
    return moved_m.cwiseAbs().maxCoeff() > kSameReadings_m &&
           shot.image.image.pixels == last_->image.image.pixels;
  }

  const CaptureSettings& settings_;
  const std::vector<NamedPose>& poses_;
  Rig& rig_;
  GrowingSession& growing_;
  const CaptureListener& listener_;
  const Interruption interruption_;
  SessionOutlook outlook_;
  JointDriveOptions drive_;
  RestOptions rest_;
  size_t next_pose_ = 0;
  int failures_ = 0;                 // in a row
  bool last_was_looked_at_ = false;  // of these: the robot stood there, but its image shows too little
  std::vector<std::string> missing_;
  std::string last_warning_;
  std::optional<ImageAtRest> last_;
  CaptureRun run_;
};

}  // namespace

CaptureRun Capture(PreparedCapture& prepared, const CaptureListener& listener) {
  return Capturer(prepared, listener).Run();
}

}  // namespace legible
