#include "apps/servo_run.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "apps/program.h"
#include "core/rig/simulated_edges.h"
#include "core/rig/tracked_edges.h"
#include "core/robots/mechanism.h"
#include "core/stopwatch.h"
#include "core/vision/robot_finder.h"
#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"

namespace legible {
namespace {

constexpr double kFirstLookRange_px = 120;  // a tape measure's camera

std::filesystem::path CameraFileName(const ServoSettings& settings) {
  return settings.camera.value_or(settings.model);
}

ServoModel LoadModel(const ServoSettings& settings, std::vector<std::string>& warnings) {
  CalibratedModel model = ReadModel(settings.model);
  if (settings.camera) {
    const CameraFile camera = ReadCamera(*settings.camera);
    model.camera = camera.camera;
    model.camera_from_base = camera.camera_from_base;
    warnings.insert(warnings.end(), camera.warnings.begin(), camera.warnings.end());
  }
  const std::filesystem::path file = CameraFileName(settings);
  if (!model.camera)
    throw InputError(file, 0, "has no camera", "calibrate, or name a camera.yaml with --camera");
  if (!model.camera_from_base)
    throw InputError(file, 0, "does not say where the camera is", "add camera_from_base");
  return MakeServoModel(model.robot, *model.camera, *model.camera_from_base);
}

// Within what the servo's margin leaves of the joint ranges.
void DemandInRange(const ServoSettings& settings, GoughStewart robot, const Vector6d& readings_m) {
  const double margin_m = settings.options.step.limits.range_margin_m;
  for (Leg& leg : robot.legs)
    leg.joint_range_m = {leg.joint_range_m[0] + margin_m, leg.joint_range_m[1] - margin_m};
  const std::vector<int> out = JointsOutOfRange(robot, readings_m);
  if (out.empty()) return;
  const Leg& leg = robot.legs[static_cast<size_t>(out[0])];
  throw InputError(
      settings.model, 0,
      fmt::format("the goal is out of reach: leg {} would read {:.4f} m, beyond its range of {:.4g} "
                  "to {:.4g} m without the margin",
                  out[0] + 1, readings_m[out[0]], leg.joint_range_m[0], leg.joint_range_m[1]),
      "give a goal within the joint ranges");
}

Rigid3 PoseAtReadings(const ServoSettings& settings, const GoughStewart& robot, const Vector6d& readings_m) {
  const auto found = ForwardKinematics(robot, readings_m, robot.home);
  if (found.status != ForwardKinematicsStatus::kConverged)
    throw InputError(settings.model, 0,
                     fmt::format("the goal's joint readings lead to no pose: forward kinematics is {}",
                                 ToString(found.status)),
                     "give readings of a pose near the home pose");
  return found.base_from_platform;
}

EdgeTrackerOptions TrackerOptions() {
  EdgeTrackerOptions options;
  options.first_look.lock->range_px = kFirstLookRange_px;
  return options;
}

ServoGoal GoalFromImage(const ServoSettings& settings, const ServoModel& model) {
  const std::filesystem::path& file = *settings.goal.image;
  const auto image = ReadGrayImage(file);
  if (!image) throw InputError(file, 0, "is not an image, or damaged", "give an image that can be opened");
  if (image->width != model.camera.width_px || image->height != model.camera.height_px)
    throw InputError(file, 0,
                     fmt::format("is {} x {} px, and the model's camera {} x {}", image->width, image->height,
                                 model.camera.width_px, model.camera.height_px),
                     "give an image of this camera");
  if (settings.goal.joints_m) {  // then it is known where to look
    const Rigid3 guess = PoseAtReadings(settings, model.robot, *settings.goal.joints_m);
    EdgeTracker tracker(model.robot, model.camera, model.camera_from_base, TrackerOptions());
    const SeenEdges seen = tracker.Track(*image, 0, guess).seen;
    if (!seen.edges.empty()) return GoalFromEdges(model, seen, guess);
  }
  const FoundRobot found = FindRobot(*image, model.robot, model.camera, model.camera_from_base, {});
  if (found.status != RobotFinderStatus::kFound)
    throw InputError(file, 0, found.reason,
                     "give an image of the whole robot, and the model of this robot and camera");
  return GoalFromEdges(model, found.seen, found.base_from_platform);
}

ServoGoal GoalOf(const ServoSettings& settings, const ServoModel& model) {
  if (settings.goal.image) return GoalFromImage(settings, model);
  if (settings.goal.joints_m) {
    DemandInRange(settings, model.robot, *settings.goal.joints_m);
    return GoalAtPose(model, PoseAtReadings(settings, model.robot, *settings.goal.joints_m));
  }
  const Vector6d& pose = *settings.goal.pose;
  const Rigid3 base_from_platform{RotationFromVector(pose.tail<3>()), pose.head<3>()};
  DemandInRange(settings, model.robot, InverseKinematics(model.robot, base_from_platform));
  return GoalAtPose(model, base_from_platform);
}

// Where a simulated robot is at the goal, in the model's frames, as far as it follows from what was given.
std::optional<Rigid3> TrueGoal(const ServoSettings& settings, const ServoModel& model,
                               const std::optional<Simulation>& simulation) {
  if (!simulation) return std::nullopt;
  const GoughStewart& truth = simulation->rig->truth().robot;
  if (settings.goal.pose)
    return Rigid3{RotationFromVector(settings.goal.pose->tail<3>()), settings.goal.pose->head<3>()};
  if (!settings.goal.joints_m) return std::nullopt;
  const auto found = ForwardKinematics(truth, *settings.goal.joints_m, truth.home);
  if (found.status != ForwardKinematicsStatus::kConverged) return std::nullopt;
  return InFramesOf(model.robot, truth, found.base_from_platform);
}

// Writes the log, and keeps what a report shows of the run.
class Recorder {
 public:
  Recorder(const PreparedServo& prepared, const TrackedEdgeSource* images, FinishedServo& finished,
           const std::filesystem::path& folder)
      : simulation_(prepared.rig.simulation),
        model_(prepared.setup.model.robot),
        images_(images),
        finished_(finished),
        writer_(folder, prepared.setup) {
    if (!images || !prepared.settings.keeps_images) return;
    frame_folder_ = folder / kFrameFolder;
    std::filesystem::create_directory(*frame_folder_);
  }

  void Take(ServoCycle cycle) {
    if (images_) cycle.look_s = images_->track_s();  // without the time that the picture took to come
    LoggedCycle logged{cycle, TruePose()};
    writer_.Add(logged);
    finished_.log.cycles.push_back(std::move(logged));
    if (finished_.log.cycles.size() == 1) Keep("start");
    if (images_ && frame_folder_ && images_->image().time_s != last_frame_s_) {
      last_frame_s_ = images_->image().time_s;
      WriteFileAtomically(*frame_folder_ / fmt::format("{:06}.png", finished_.log.cycles.size() - 1),
                          EncodePng(images_->image().image));
    }
  }

  void Keep(const std::string& label) {
    if (finished_.log.cycles.empty()) return;
    RunPicture picture{label, finished_.log.cycles.size() - 1, std::nullopt};
    if (images_) picture.image = images_->image().image;
    finished_.pictures.push_back(std::move(picture));
  }

  // Of a simulated robot, in the model's frames.
  std::optional<Rigid3> TruePose() const {
    if (!simulation_) return std::nullopt;
    const SimulatedRig& rig = *simulation_->rig;
    return InFramesOf(model_, rig.truth().robot, rig.true_motion().base_from_platform);
  }

 private:
  const std::optional<Simulation>& simulation_;
  const GoughStewart& model_;
  const TrackedEdgeSource* images_;
  FinishedServo& finished_;
  ServoLogWriter writer_;
  std::optional<std::filesystem::path> frame_folder_;
  double last_frame_s_ = -1;
};

std::string LiveText(const ServoCycle& cycle, double start_s, const ControlLawOptions& law) {
  const ServoStep& step = cycle.output.step;
  const std::string limits = DescribeLimits(step);
  std::string text = fmt::format(
      "{:6.2f} s  error {:.4g} {}  {} edges  fastest joint {:.2f} mm/s{}", cycle.input.time_s - start_s,
      step.law.error, UnitOf(law.mode), cycle.input.seen.edges.size(),
      1e3 * cycle.output.joint_speeds_m_per_s.cwiseAbs().maxCoeff(), limits.empty() ? "" : "  " + limits);
  if (cycle.output.verdict.is_waiting) text += "  waiting: " + WhyNoSpeeds(step, law);
  return text;
}

// Shows the newest cycle, no more often than anyone can read.
class LiveLine {
 public:
  LiveLine(ProgressLine& line, const ControlLawOptions& law) : line_(line), law_(law) {}

  void Show(const ServoCycle& cycle) {
    constexpr double kLeastPause_s = 0.1;
    if (!start_s_) start_s_ = cycle.input.time_s;
    if (shown_s_ && watch_.Seconds() - *shown_s_ < kLeastPause_s) return;
    shown_s_ = watch_.Seconds();
    line_.Show(LiveText(cycle, *start_s_, law_));
  }

 private:
  ProgressLine& line_;
  const ControlLawOptions& law_;
  Stopwatch watch_;
  std::optional<double> start_s_, shown_s_;
};

// Whatever goes wrong, the log has what there was: the rig is at rest then.
ServoRun RunToItsEnd(Rig& rig, EdgeSource& source, ServoController& controller, const ServoLoopOptions& loop,
                     const std::function<void(const ServoCycle&)>& record, const ServoLog& log) {
  try {
    return RunServo(rig, source, controller, loop, record);
  } catch (const std::exception& error) {
    ServoRun run;
    run.end = ServoEnd::kFailed;
    run.reason = std::string("the program failed: ") + error.what();
    run.cycles = static_cast<int>(log.cycles.size());
    if (!log.cycles.empty())
      run.time_s = log.cycles.back().cycle.input.time_s - log.cycles.front().cycle.input.time_s;
    return run;
  }
}

// Without a link a command lapses first.
void WaitForRest(Rig& rig) {
  constexpr double kRest_s = Rig::kCommandHolds_s + 0.3;
  try {
    rig.WaitUntil(rig.Now() + kRest_s);
  } catch (const RigError&) {  // said already, or of no more interest
  }
}

std::string NumbersText(const Vector6d& numbers) {
  return fmt::format("{} {} {} {} {} {}", numbers[0], numbers[1], numbers[2], numbers[3], numbers[4],
                     numbers[5]);
}

// As it was asked for.
std::string GoalText(const GoalSetting& goal) {
  if (goal.pose) return "pose " + NumbersText(*goal.pose);
  std::string joints = goal.joints_m ? "joints " + NumbersText(*goal.joints_m) : "";
  if (!goal.image) return joints;
  return "image " + goal.image->string() + (joints.empty() ? "" : ", " + joints);
}

// Commands that are held too long lead beyond ranges and goals.
void DemandShortPeriod(const ServoSettings& settings) {
  ServoLoopOptions loop;
  loop.period_s = settings.period_s;
  loop.Check();
  if (settings.options.step.gain.at_zero_per_s * settings.period_s >= 1)
    throw std::invalid_argument("the gain times the period must stay below 1");
}

void DemandEdgeSource(const ServoSettings& settings, const OpenedRig& rig) {
  if (settings.is_image_free && !rig.simulation)
    throw InputError(settings.rig, 0, "is no simulated rig: it has no edges but those of its images",
                     "leave --image-free out");
}

}  // namespace

PreparedServo PrepareServo(const ServoSettings& settings, OpenedRig rig) {
  PreparedServo prepared;
  prepared.settings = settings;
  prepared.rig = std::move(rig);
  ServoSetup& setup = prepared.setup;
  setup.model = LoadModel(settings, prepared.warnings);
  DemandEdgeSource(settings, prepared.rig);
  DemandSameImageSize(CameraFileName(settings), setup.model.camera, prepared.rig);
  setup.goal = GoalOf(settings, setup.model);
  setup.options = settings.options;
  setup.period_s = settings.period_s;
  setup.provenance = {{"model", settings.model.string()},
                      {"rig", settings.rig},
                      {"edges_from", settings.is_image_free ? "simulation without images" : "images"},
                      {"goal", GoalText(settings.goal)},
                      {"program_version", ProgramVersion()}};
  prepared.true_goal = TrueGoal(settings, setup.model, prepared.rig.simulation);
  try {
    DemandGoal(setup.goal, setup.options.step.law);
    setup.options.Check();
    DemandShortPeriod(settings);
  } catch (const std::invalid_argument& error) {
    throw InputError(settings.goal.image.value_or(settings.model), 0, "cannot be servoed to like this",
                     error.what());
  }
  return prepared;
}

FinishedServo DriveServo(PreparedServo& prepared, const std::filesystem::path& folder,
                         const Interruption& interruption, ProgressLine& progress) {
  FinishedServo finished;
  finished.log.setup = prepared.setup;
  const ServoModel& model = prepared.setup.model;
  Rig& rig = *prepared.rig.rig;
  std::optional<TrackedEdgeSource> images;
  std::optional<SimulatedEdges> lines;
  if (prepared.settings.is_image_free)
    lines.emplace(*prepared.rig.simulation->rig, model.camera);
  else
    images.emplace(rig, model.robot, model.camera, model.camera_from_base, TrackerOptions());
  EdgeSource& source = images ? static_cast<EdgeSource&>(*images) : *lines;

  ServoController controller(model, prepared.setup.goal, prepared.setup.options);
  Recorder recorder(prepared, images ? &*images : nullptr, finished, folder);
  LiveLine live(progress, prepared.setup.options.step.law);
  ServoLoopOptions loop;
  loop.period_s = prepared.setup.period_s;
  loop.is_stopped = [&interruption] { return interruption.HasCome(); };
  const auto record = [&](const ServoCycle& cycle) {
    recorder.Take(cycle);
    live.Show(cycle);
  };
  finished.run = RunToItsEnd(rig, source, controller, loop, record, finished.log);
  recorder.Keep("end");
  if (images && images->newest()) finished.missing = images->newest()->missing;
  if (prepared.rig.simulation) WaitForRest(rig);
  finished.true_end = recorder.TruePose();
  return finished;
}

}  // namespace legible
