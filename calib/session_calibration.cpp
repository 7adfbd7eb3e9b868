#include "calib/session_calibration.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "calib/first_look.h"
#include "calib/held_out.h"
#include "core/geometry/nearest_camera.h"
#include "core/stopwatch.h"
#include "core/vision/layout_tags.h"

namespace legible {
namespace {

constexpr double kLargestTagMisfit = 0.2;  // of a tag's side: the guessed lens may be far off
constexpr double kSearchAtLast_px = 3;
constexpr double kGrossMisfit = 8;       // drawn joints held 2 mm off leave 11, radii held 0.3 mm off 9
constexpr double kMisfitOfFew = 2;       // where most edges in sight were not even found near the model
constexpr double kTagPoseRange_px = 30;  // how far off the legs may be where tags gave the camera's pose

// The camera through another lens model. Focal lengths and principal point stay, for what is held or known of
// them refers to these; the coefficients are those that come nearest. They are 0 where no such lens covers
// the image, and where a camera without distortion says only that nothing is known of it.
Camera WithLens(const Camera& camera, LensModel lens) {
  std::bitset<kCameraParameterCount> coefficients = AllParametersOf(lens);
  for (size_t i = 0; i < 4; ++i) coefficients.reset(i);
  const bool is_unknown = camera.lens != LensModel::kFisheye && camera.distortion.isZero();
  Camera with_lens = camera;
  with_lens.lens = lens;
  with_lens.distortion.setZero();
  if (is_unknown) return with_lens;
  const NearestCamera nearest = FindNearestCamera(camera, lens, coefficients);
  return std::isfinite(nearest.max_px) ? nearest.camera : with_lens;
}

// What the next search for edges starts from.
struct Prediction {
  Camera camera;
  GoughStewart robot;
  Rigid3 camera_from_base;
  std::vector<std::optional<Rigid3>>
      base_from_platform;  // of each image; none where the readings lead to none
};

// Of the tags whose corners a sighting holds, four by four.
double MeanSide_px(const GroupSighting& sighting) {
  double sum = 0;
  for (size_t i = 0; i + 1 < sighting.corners_px.size(); i += 4)
    sum += (sighting.corners_px[i + 1] - sighting.corners_px[i]).norm();
  return sum / (static_cast<double>(sighting.corners_px.size()) / 4);
}

bool IsMeasuredEdge(const LegEdge& edge) { return edge.left_out.empty(); }

class SessionCalibrator {
 public:
  SessionCalibrator(const Session& session, const SessionCalibrationOptions& options)
      : session_(session), options_(options), count_(session.images.size()) {
    prediction_.camera = session.camera;
    if (options.lens) prediction_.camera = WithLens(prediction_.camera, *options.lens);
    result_.guessed_camera = prediction_.camera;
    prediction_.robot = session.robot;
    result_.images.resize(count_);
    for (size_t i = 0; i < count_; ++i) result_.images[i].name = session.images[i].name;
  }

  SessionCalibration Run() {
    Stopwatch total, lap;
    ReadImages();
    result_.times.read_s = lap.Lap();
    FindTags();
    DemandSeenTags();
    PlaceCamera();
    RefineFirstPose();
    FindEdges(kSearchAfterFirstLook_px);
    result_.times.detect_s = lap.Lap();
    Solve();
    result_.times.solve_s = lap.Lap();
    if (Usable()) {
      AdoptPoses(result_.calibration);
      FindEdges(kSearchAtLast_px);
      result_.times.detect_s += lap.Lap();
      Solve();
      result_.times.solve_s += lap.Lap();
    }
    RefuseContradicted();
    for (size_t i = 0; i < count_; ++i)
      if (IsReadable(i)) FinishImage(result_.images[i]);
    if (Usable()) CheckResult();
    result_.times.held_out_s = lap.Lap();
    result_.times.covariance_s = result_.calibration.covariance_s;
    result_.times.solve_s -= result_.times.covariance_s;
    result_.times.total_s = total.Seconds();
    return std::move(result_);
  }

 private:
  bool Usable() const { return result_.calibration.status == CalibrationStatus::kConverged; }

  template <typename F>
  void ForEachImage(const std::string& stage, const std::vector<size_t>& which, F work) {
    std::atomic<int> done = 0;
    tbb::task_arena arena(options_.threads);
    arena.execute([&] {
      tbb::parallel_for(size_t{0}, which.size(), [&](size_t i) {
        work(which[i]);
        if (options_.progress) options_.progress(stage, ++done, static_cast<int>(which.size()));
      });
    });
  }

  std::vector<size_t> All() const {
    std::vector<size_t> all(count_);
    for (size_t i = 0; i < count_; ++i) all[i] = i;
    return all;
  }

  void ReadImages() {
    images_.resize(count_);
    ForEachImage("reading", All(), [&](size_t i) {
      auto image = ReadGrayImage(session_.images[i].file);
      if (!image)
        result_.images[i].left_out = "not an image, or damaged";
      else if (image->width != session_.camera.width_px || image->height != session_.camera.height_px)
        result_.images[i].left_out =
            fmt::format("{} x {} px where the camera has {} x {}", image->width, image->height,
                        session_.camera.width_px, session_.camera.height_px);
      else
        images_[i] = std::move(*image);
    });
  }

  bool IsReadable(size_t i) const { return !images_[i].pixels.empty(); }
  bool CanBeMeasured(size_t i) const {
    return IsReadable(i) && prediction_.base_from_platform[i].has_value();
  }
  bool IsMeasured(size_t i) const { return !result_.images[i].edges.edges.empty(); }

  void FindTags() {
    if (!session_.tags) return;
    tbb::enumerable_thread_specific<LayoutTagDetector> detectors(*session_.tags);
    ForEachImage("finding tags", All(), [&](size_t i) {
      if (IsReadable(i)) result_.images[i].tags = detectors.local().Detect(images_[i]);
    });
  }

  void DemandSeenTags() const {
    const std::vector<TagGroup> groups = session_.tags ? session_.tags->groups : std::vector<TagGroup>();
    for (const std::string& name : options_.tag_groups) {
      const auto group =
          std::find_if(groups.begin(), groups.end(), [&](const TagGroup& one) { return one.name == name; });
      if (group == groups.end())
        throw std::invalid_argument(fmt::format("the session has no tag group \"{}\"", name));
      if (!IsSeen(*group, result_.images))
        throw std::invalid_argument(
            fmt::format("the tags {} are to be observations, but no image shows one of them", name));
    }
  }

  // The base's tags stand still: their corners from all images count together.
  void PlaceCamera() {
    if (session_.tags) {
      for (const TagGroup& group : session_.tags->groups) {
        if (group.carrier != TagCarrier::kBase) continue;
        GroupSighting sighting;
        for (const ImageOutcome& image : result_.images) {
          const GroupSighting one = Match(group, image.tags);
          sighting.corners_in_group_m.insert(sighting.corners_in_group_m.end(),
                                             one.corners_in_group_m.begin(), one.corners_in_group_m.end());
          sighting.corners_px.insert(sighting.corners_px.end(), one.corners_px.begin(), one.corners_px.end());
        }
        const auto pose = LocateGroup(prediction_.camera, sighting);
        if (!pose) continue;
        if (pose->rms_px > kLargestTagMisfit * MeanSide_px(sighting)) {
          misfit_groups_.insert(group.name);
          result_.misfit_tags.push_back(
              fmt::format("the tags {} lie {:.0f} px from where tags.yaml has them to each other: check its "
                          "ids and corners",
                          group.name, pose->rms_px));
          continue;
        }
        prediction_.camera_from_base = pose->camera_from_group * Inverse(group.carrier_from_group);
        result_.first_pose_from = "tags " + group.name;
        return;
      }
    }
    if (!session_.camera_from_base && !result_.misfit_tags.empty())
      throw std::invalid_argument(result_.misfit_tags.front());
    if (!session_.camera_from_base)
      throw std::invalid_argument(
          "the session does not say where the camera is; give camera_from_base in camera.yaml (a tape "
          "measure will do), or tags on the base");
    prediction_.camera_from_base = *session_.camera_from_base;
    result_.first_pose_from = "camera.yaml";
  }

  // A few images, the drawing trusted, the camera's pose free: brings predictions within reach of the fine
  // search.
  void RefineFirstPose() {
    PredictPoses();
    std::vector<size_t> seen, scouts;
    for (size_t i = 0; i < count_; ++i)
      if (CanBeMeasured(i)) seen.push_back(i);
    const size_t scout_count = std::min(seen.size(), static_cast<size_t>(options_.scouts));
    for (size_t i = 0; i < scout_count; ++i) scouts.push_back(seen[i * seen.size() / scout_count]);
    const double range_px =
        result_.first_pose_from == "camera.yaml" ? TapePoseRange_px(session_.camera) : kTagPoseRange_px;
    Measure("looking for the legs", scouts, FirstLookEdges(options_.edges, range_px));
    const LegCalibration scouted = FirstLook(Input(scouts), options_.estimation.hold, options_.threads);
    if (scouted.status == CalibrationStatus::kConverged)
      Adopt(scouted);
    else
      result_.first_look = scouted.message;
  }

  void Adopt(const LegCalibration& calibration) {
    prediction_.camera = calibration.camera;
    prediction_.robot = calibration.robot;
    prediction_.camera_from_base = calibration.camera_from_base;
    PredictPoses();
  }

  // Where the edges have the platform: a wrong reading must not take them along once more.
  void AdoptPoses(const LegCalibration& calibration) {
    for (size_t k = 0; k < result_.estimated.size(); ++k)
      prediction_.base_from_platform[result_.estimated[k]] =
          Inverse(calibration.camera_from_base) * calibration.camera_from_platform[k];
  }

  void PredictPoses() {
    prediction_.base_from_platform.assign(count_, std::nullopt);
    for (size_t i = 0; i < count_; ++i) {
      const auto fk =
          ForwardKinematics(prediction_.robot, session_.images[i].joint_readings_m, prediction_.robot.home);
      if (fk.status == ForwardKinematicsStatus::kConverged)
        prediction_.base_from_platform[i] = fk.base_from_platform;
    }
  }

  void FindEdges(double search_px) {
    LegEdgeOptions fine = options_.edges;
    fine.lock = std::nullopt;
    fine.search_px = search_px;
    Measure("finding edges", All(), fine);
  }

  void Measure(const std::string& stage, const std::vector<size_t>& which,
               const LegEdgeOptions& edge_options) {
    ForEachImage(stage, which, [&](size_t i) {
      result_.images[i].edges = LegEdges();
      if (!CanBeMeasured(i)) return;
      const LegsInCamera legs =
          PlaceLegs(prediction_.robot, prediction_.camera_from_base, *prediction_.base_from_platform[i]);
      result_.images[i].edges = MeasureLegEdges(images_[i], legs, prediction_.camera, edge_options);
    });
  }

  LegCalibrationInput Input(const std::vector<size_t>& which) const {
    LegCalibrationInput input{
        session_.robot,
        result_.guessed_camera,
        prediction_.camera_from_base,
        {},
        session_.known,
        CalibrationStart{prediction_.camera, prediction_.robot, prediction_.camera_from_base, {}}};
    for (size_t i : which) {
      if (!IsMeasured(i)) continue;
      input.images.push_back(ToObservation(session_.images[i].name, session_.images[i].joint_readings_m,
                                           result_.images[i].edges));
      input.start->camera_from_platform.push_back(
          prediction_.camera_from_base * prediction_.base_from_platform[i].value_or(prediction_.robot.home));
    }
    AddTags(which, input);
    input.board = options_.board;
    return input;
  }

  void AddTags(const std::vector<size_t>& which, LegCalibrationInput& input) const {
    if (!session_.tags) return;
    for (const TagGroup& group : session_.tags->groups) {
      if (!TakesPart(group)) continue;
      input.tags.push_back({group, {}});
      for (size_t i : which)
        if (IsMeasured(i)) input.tags.back().detections.push_back(result_.images[i].tags);
    }
  }

  bool TakesPart(const TagGroup& group) const { return options_.tag_groups.contains(group.name); }

  void Solve() {
    if (options_.progress) options_.progress("solving", 0, 1);
    result_.estimated.clear();
    for (size_t i = 0; i < count_; ++i)
      if (IsMeasured(i)) result_.estimated.push_back(i);
    result_.calibration = CalibrateLegs(Input(result_.estimated), options_.estimation);
    if (Usable()) Adopt(result_.calibration);
  }

  void RefuseContradicted() {
    LegCalibration& calibration = result_.calibration;
    if (!Usable() && calibration.status != CalibrationStatus::kUnobservable) return;
    const EdgeCounts edges = CountEdges(result_);
    const double misfit = calibration.Misfit();
    if (misfit < kMisfitOfFew || (misfit < kGrossMisfit && 2 * edges.used >= edges.in_sight)) return;
    calibration.tags.clear();
    calibration.status = CalibrationStatus::kNotConverged;
    calibration.message = fmt::format(
        "{} of {} edges in sight were found near the best model, and these lie {:.1f} times as far from it "
        "({:.2f} px rms) as their own scatter allows: what is held or known beforehand is wrong, legs stand "
        "in "
        "another order in joints.csv than in robot.yaml, the lens model is too poor, the camera moved "
        "between "
        "images, or this is not the robot of the drawing",
        edges.used, edges.in_sight, misfit, calibration.rms_px);
  }

  void CheckResult() {
    if (options_.progress) options_.progress("checking", 0, 1);
    const std::vector<size_t>& used = result_.estimated;
    for (const EdgeResidualSet& edge : result_.calibration.edges) CountResiduals(edge, used);
    const std::vector<CheckedGroup> groups = GroupsToCheck(used);
    if (options_.folds > 1) CheckHeldOut(used, groups);
    CheckTags(used, groups);
    result_.held_differences =
        DifferencesOfHeld(Input(used), result_.calibration, options_.estimation, kContradicting_sigma);
  }

  void CountResiduals(const EdgeResidualSet& edge, const std::vector<size_t>& used) {
    const size_t image = used[static_cast<size_t>(edge.image)];
    squares_.resize(count_);
    weights_.resize(count_);
    const Eigen::VectorXd weight = edge.CountedWeight();
    squares_[image] += weight.dot(edge.residual_px.cwiseAbs2());
    weights_[image] += weight.sum();
    result_.images[image].rms_px = std::sqrt(squares_[image] / std::max(weights_[image], 1e-9));
  }

  static void FinishImage(ImageOutcome& image) {
    if (image.edges.edges.empty()) {
      image.left_out = "no pose of the platform has its joint readings";
      return;
    }
    if (std::any_of(image.edges.edges.begin(), image.edges.edges.end(), IsMeasuredEdge)) return;
    std::map<std::string, int> counts;
    for (const LegEdge& edge : image.edges.edges) ++counts[edge.left_out];
    const auto commonest = std::max_element(counts.begin(), counts.end(),
                                            [](const auto& a, const auto& b) { return a.second < b.second; });
    image.left_out = "none of its edges could be measured (its joint readings may be wrong), most of them: " +
                     commonest->first;
  }

  void CheckHeldOut(const std::vector<size_t>& used, const std::vector<CheckedGroup>& groups) {
    const HeldOut held_out = CrossValidate(Input(used), result_.calibration, options_.estimation,
                                           FoldsOf(used.size(), options_.folds, options_.seed), groups);
    result_.held_out_folds = held_out.folds;
    result_.held_out_rms_px = held_out.rms_px;
    result_.held_out_folds_failed = held_out.folds_failed;
    for (size_t k = 0; k < used.size(); ++k)
      result_.images[used[k]].held_out_rms_px = held_out.image_rms_px[k];
    held_out_groups_ = held_out.groups;
  }

  // Of the images that the estimation was given.
  std::vector<CheckedGroup> GroupsToCheck(const std::vector<size_t>& used) const {
    std::vector<CheckedGroup> groups;
    if (!session_.tags) return groups;
    for (const TagGroup& group : session_.tags->groups) {
      const bool on_platform = group.carrier == TagCarrier::kPlatform;
      if (misfit_groups_.contains(group.name) || (on_platform && !options_.estimation.rigid_platform))
        continue;
      groups.push_back({group, {}});
      for (const size_t image : used)
        groups.back().sightings.push_back(result_.images[image].left_out.empty()
                                              ? Match(group, result_.images[image].tags)
                                              : GroupSighting());
    }
    return groups;
  }

  // On images held out where there are such; else against the model that has seen them all.
  void CheckTags(const std::vector<size_t>& used, const std::vector<CheckedGroup>& groups) {
    for (size_t g = 0; g < groups.size(); ++g) {
      const TagGroup& group = groups[g].group;
      const bool by_readings =
          group.carrier == TagCarrier::kPlatform && options_.estimation.use_joint_readings;
      const auto held_out = g < held_out_groups_.size() ? held_out_groups_[g] : std::nullopt;
      const auto check = held_out ? held_out : CheckBySolution(used, groups[g]);
      if (check)
        result_.tag_checks.push_back({group.name, TakesPart(group), by_readings, held_out.has_value(),
                                      check->images, check->rms_px, check->rms_m});
    }
  }

  std::optional<GroupCheck> CheckBySolution(const std::vector<size_t>& used,
                                            const CheckedGroup& checked) const {
    const bool on_platform = checked.group.carrier == TagCarrier::kPlatform;
    std::vector<GroupSighting> sightings;
    std::vector<Rigid3> camera_from_carrier;
    for (size_t k = 0; k < used.size(); ++k) {
      const auto carrier = on_platform ? PlatformPose(k, used[k], options_.estimation.use_joint_readings)
                                       : std::optional(prediction_.camera_from_base);
      if (!carrier) continue;
      sightings.push_back(checked.sightings[k]);
      camera_from_carrier.push_back(*carrier);
    }
    return CheckGroup(checked.group, prediction_.camera, sightings, camera_from_carrier);
  }

  // By the readings alone, which is what the robot would be sent to, unless one of them did not count;
  // without readings as the edges have it.
  std::optional<Rigid3> PlatformPose(size_t in_estimation, size_t image, bool by_readings) const {
    if (!by_readings) return result_.calibration.camera_from_platform[in_estimation];
    const auto& base_from_platform = prediction_.base_from_platform[image];
    if (!base_from_platform || !result_.calibration.ReadingsCountIn(in_estimation)) return std::nullopt;
    return prediction_.camera_from_base * *base_from_platform;
  }

  const Session& session_;
  const SessionCalibrationOptions& options_;
  size_t count_;
  Prediction prediction_;
  std::vector<GrayImage> images_;
  std::vector<double> squares_, weights_;
  std::set<std::string> misfit_groups_;
  std::vector<std::optional<GroupCheck>> held_out_groups_;
  SessionCalibration result_;
};

}  // namespace

void SessionCalibrationOptions::Check() const {
  estimation.Check();
  edges.Check();
  if (scouts < 1 || threads < 1 || folds < 0)
    throw std::invalid_argument("scouts, threads and folds must be positive");
}

bool IsSeen(const TagGroup& group, const std::vector<ImageOutcome>& images) {
  return std::any_of(images.begin(), images.end(),
                     [&](const ImageOutcome& image) { return !Match(group, image.tags).corners_px.empty(); });
}

EdgeCounts CountEdges(const SessionCalibration& result) {
  EdgeCounts counts;
  for (const ImageOutcome& image : result.images)
    for (const LegEdge& edge : image.edges.edges) {
      counts.in_sight += edge.in_sight ? 1 : 0;
      counts.used += IsMeasuredEdge(edge) ? 1 : 0;
    }
  return counts;
}

SessionCalibration CalibrateSession(const Session& session, const SessionCalibrationOptions& options) {
  options.Check();
  return SessionCalibrator(session, options).Run();
}

}  // namespace legible
