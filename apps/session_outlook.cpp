#include "apps/session_outlook.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "calib/first_look.h"

namespace legible {
namespace {

// Numbers of images from which a model is calibrated.
constexpr std::array<size_t, 4> kCalibrateAt = {8, 12, 20, 40};
constexpr size_t kScoutsThatFind = 3;
constexpr double kNearlyFound = 0.25;  // share of the range that is searched then
constexpr size_t kMostScouts = 12;     // images by which the camera is found before a model is calibrated
constexpr int kLeastEdges = 6;   // expected of a pose; small images show few, and looking for more takes long
constexpr int kFewestEdges = 4;  // of an image that tells something

// Without a lock: the model is good enough.
LegEdgeOptions FineEdges() {
  LegEdgeOptions options;
  options.lock.reset();
  options.search_px = kSearchAfterFirstLook_px;
  return options;
}

std::string WhyUnusable(const LegEdges& edges) {
  std::map<std::string, int> counts;
  for (const LegEdge& edge : edges.edges)
    if (!edge.left_out.empty()) ++counts[edge.left_out];
  const auto commonest = std::max_element(counts.begin(), counts.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
  return "hardly any edge could be measured, for most of them: " + commonest->first;
}

}  // namespace

SessionOutlook::SessionOutlook(const Session& session, const OutlookOptions& options)
    : options_(options), input_{session.robot, session.camera, session.camera_from_base.value(), {},
                                session.known, std::nullopt} {
  const auto may_be_last = std::upper_bound(kCalibrateAt.begin(), kCalibrateAt.end(), session.images.size());
  for (auto at = may_be_last; at != kCalibrateAt.begin() && !proposer_;) Calibrate(session, *--at);
  if (!proposer_) Propose({});
  for (auto i = static_cast<size_t>(images_in_model_); i < session.images.size(); ++i) {
    const SessionImage& image = session.images[i];
    const auto pixels = ReadGrayImage(image.file);
    if (pixels) Take(Look(image.name, *pixels, image.joint_readings_m));
  }
}

// The best there is so far.
RigModel SessionOutlook::Model() const {
  if (input_.start) return {input_.start->robot, input_.start->camera, input_.start->camera_from_base};
  return scouted_.value_or(RigModel{input_.drawing, input_.camera, input_.camera_from_base});
}

Sighting SessionOutlook::Look(const std::string& name, const GrayImage& image,
                              const Vector6d& joint_readings_m) const {
  std::optional<Scout> scout;
  if (!input_.start && scouts_.size() < kMostScouts) {
    std::vector<ImageObservation> looks = scouts_;
    looks.push_back(LookRoughly(name, image, joint_readings_m));
    // Where it does not fit the others, it is the one that went wrong.
    if (const auto together = Scouted(looks)) scout = {looks.back(), *together};
  }
  Sighting fine = Measure(scout ? scout->model : Model(), name, image, joint_readings_m, FineEdges());
  fine.scout = std::move(scout);
  return fine;
}

// A few looks have found the camera nearly; further ones need not search as far, nor go as wrong.
ImageObservation SessionOutlook::LookRoughly(const std::string& name, const GrayImage& image,
                                             const Vector6d& joint_readings_m) const {
  const bool is_nearly_found = scouted_ && scouts_.size() >= kScoutsThatFind;
  const RigModel from =
      is_nearly_found ? *scouted_ : RigModel{input_.drawing, input_.camera, input_.camera_from_base};
  const double range_px = TapePoseRange_px(input_.camera) * (is_nearly_found ? kNearlyFound : 1);
  return Measure(from, name, image, joint_readings_m, FirstLookEdges(LegEdgeOptions(), range_px)).observation;
}

Sighting SessionOutlook::Measure(const RigModel& model, const std::string& name, const GrayImage& image,
                                 const Vector6d& joint_readings_m, const LegEdgeOptions& options) const {
  Sighting sighting;
  const auto pose = ForwardKinematics(model.robot, joint_readings_m, model.robot.home);
  if (pose.status != ForwardKinematicsStatus::kConverged) {
    sighting.unusable = "no pose of the platform has its joint readings";
    return sighting;
  }
  const LegsInCamera legs = PlaceLegs(model.robot, model.camera_from_base, pose.base_from_platform);
  const LegEdges edges = MeasureLegEdges(image, legs, model.camera, options);
  sighting.observation = ToObservation(name, joint_readings_m, edges);
  sighting.edges = static_cast<int>(sighting.observation.edges.size());
  if (sighting.edges < kFewestEdges) sighting.unusable = WhyUnusable(edges);
  return sighting;
}

// The model that first looks lead to; nothing where they do not agree on one.
std::optional<RigModel> SessionOutlook::Scouted(std::vector<ImageObservation> looks) const {
  LegCalibrationInput input = input_;
  input.images = std::move(looks);
  const LegCalibration found = FirstLook(std::move(input), HeldParameters(), options_.threads);
  if (found.status != CalibrationStatus::kConverged) return std::nullopt;
  return RigModel{found.robot, found.camera, found.camera_from_base};
}

void SessionOutlook::Add(const Session& session, const Sighting& sighting) {
  const size_t count = session.images.size();
  const bool is_due = std::find(kCalibrateAt.begin(), kCalibrateAt.end(), count) != kCalibrateAt.end();
  if (is_due && tells_something_ && Calibrate(session, count)) return;
  Take(sighting);
}

void SessionOutlook::Reject(const Rigid3& base_from_platform, bool for_good) {
  (for_good ? rejected_ : rejected_for_now_).push_back(base_from_platform);
  proposer_->Reject(base_from_platform);
}

void SessionOutlook::Take(const Sighting& sighting) {
  if (sighting.scout && sighting.unusable.empty()) {
    scouts_.push_back(sighting.scout->look);
    scouted_ = sighting.scout->model;
  }
  if (sighting.unusable.empty()) {
    observations_.push_back(sighting.observation);
    AddToProposer(sighting.observation);
  }
  // A further first look sees better.
  if (!input_.start && !rejected_for_now_.empty()) {
    Propose({});
    for (const ImageObservation& observation : observations_) AddToProposer(observation);
  }
}

void SessionOutlook::AddToProposer(const ImageObservation& observation) {
  try {
    proposer_->Add(observation);
    tells_something_ = true;
  } catch (const std::runtime_error&) {
    // The model cannot produce these edges at all: nothing can be said of what they are worth.
  } catch (const std::invalid_argument&) {
  }
}

void SessionOutlook::Propose(std::vector<ImageObservation> images) {
  PoseProposalOptions options;
  options.candidates.seed = options_.seed;
  options.candidates.least_edges = kLeastEdges;
  if (!options_.proposes) options.candidates.count = 1;
  options.threads = options_.threads;
  options.noise = noise_;
  LegCalibrationInput input = input_;
  input.images = std::move(images);
  LegCalibrationOptions estimation;
  estimation.threads = options_.threads;
  proposer_ = std::make_unique<PoseProposer>(std::move(input), estimation, options);
  rejected_for_now_.clear();
  for (const Rigid3& pose : rejected_) proposer_->Reject(pose);
}

// Of the session's first images; whether that led to a model.
bool SessionOutlook::Calibrate(const Session& session, size_t images) {
  Session first = session;
  first.images.resize(images);
  first.tags.reset();
  SessionCalibrationOptions options;
  options.folds = 0;
  options.threads = options.estimation.threads = options_.threads;
  const SessionCalibration found = CalibrateSession(first, options);
  const LegCalibration& calibration = found.calibration;
  trouble_.clear();
  if (calibration.status != CalibrationStatus::kConverged) {
    trouble_ = fmt::format("the first {} images lead to no model yet: {}", images, calibration.message);
    return false;
  }
  input_.start = {calibration.camera, calibration.robot, calibration.camera_from_base,
                  calibration.camera_from_platform};
  noise_ = calibration.noise;
  std::vector<ImageObservation> observations;
  for (const size_t i : found.estimated)
    observations.push_back(
        ToObservation(first.images[i].name, first.images[i].joint_readings_m, found.images[i].edges));
  images_in_model_ = static_cast<int>(images);
  tells_something_ = true;
  Propose(std::move(observations));
  return true;
}

}  // namespace legible
