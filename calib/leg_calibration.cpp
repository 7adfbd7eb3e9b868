#include "calib/leg_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>

#include "calib/tag_weights.h"

namespace legible {
namespace {

constexpr int kMaxRounds = 12;         // of solving and re-weighting; the last keeps its weights
constexpr int kRoundsByMedian = 2;     // the scale comes from the median until the worst outliers are gone
constexpr double kSteadyScale = 1e-3;  // relative change of the noise at which the rounds end
constexpr double kHeldJointSigma_m = 1e-6;  // by which base joints that are held may leave the drawing
constexpr double kSteadyWeight = 1e-4;      // mean absolute change of the weights at which they end
constexpr double kAbsurdRms_px = 20;        // a fit this bad is a wrong model, not noise

LegPoints DrawnJoints(const GoughStewart& robot, Eigen::Vector3d Leg::*joint) {
  LegPoints joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = robot.legs[i].*joint;
  return joints;
}

CalibrationStart StartOf(const LegCalibrationInput& input) {
  if (input.start) return *input.start;
  CalibrationStart start{input.camera, input.drawing, input.camera_from_base, {}};
  for (const ImageObservation& image : input.images) {
    Rigid3 base_from_platform = input.drawing.home;
    if (image.joint_readings_m) {
      const auto fk = ForwardKinematics(input.drawing, *image.joint_readings_m, input.drawing.home);
      if (fk.status == ForwardKinematicsStatus::kConverged) base_from_platform = fk.base_from_platform;
    }
    start.camera_from_platform.push_back(input.camera_from_base * base_from_platform);
  }
  return start;
}

SharedParameters ParametersOf(const Camera& camera, const GoughStewart& robot,
                              const Rigid3& camera_from_base) {
  SharedParameters shared;
  shared.camera = ParametersOf(camera);
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    shared.legs[i] << camera_from_base * leg.base_joint_m, leg.platform_joint_m, leg.radius_m,
        leg.joint_offset_m, Eigen::Vector4d::Zero();
  }
  return shared;
}

std::bitset<kSharedParameterCount> FreeParameters(const LegCalibrationInput& input,
                                                  const LegCalibrationOptions& options) {
  std::bitset<kSharedParameterCount> free;
  const HeldParameters& hold = options.hold;
  for (size_t i = 0; i < 4; ++i) free[i] = i < 2 ? !hold.focal_length : !hold.principal_point;
  for (size_t i = 0; i < static_cast<size_t>(input.camera.lens); ++i) free[4 + i] = !hold.distortion;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto set = [&](int entry, int count, bool value) {
      for (int i = 0; i < count; ++i) free[static_cast<size_t>(FirstParameterOfLeg(leg) + entry + i)] = value;
    };
    set(leg_parameter::kBaseJoint, 3, !(hold.base_joints && hold.camera_pose));
    set(leg_parameter::kPlatformJoint, 3, !hold.platform_joints && options.rigid_platform);
    set(leg_parameter::kRadius, 1, !hold.radii);
    set(leg_parameter::kJointOffset, 1,
        !hold.joint_offsets && options.rigid_platform && options.use_joint_readings);
  }
  return free;
}

// How far shading may move each leg's edge in all images alike.
double LastingShading(const LegCalibrationInput& input, const LegCalibrationOptions& options, int leg,
                      int edge) {
  double squares = 0, count = 0;
  for (const ImageObservation& image : input.images)
    for (const EdgeObservation& observation : image.edges) {
      if (observation.leg != leg || observation.edge != edge) continue;
      squares += observation.common_sigma_px * observation.common_sigma_px;
      count += 1;
    }
  return count > 0 ? options.lasting_shading * std::sqrt(squares / count) : 0;
}

// Adds what is known beforehand to the problem, about the drawing's and the guessed camera's values.
void AddPriors(const LegCalibrationInput& input, const LegCalibrationOptions& options,
               EstimationProblem& problem) {
  const SharedParameters nominal = ParametersOf(input.camera, input.drawing, input.camera_from_base);
  const auto add = [&](int parameter, const std::optional<double>& sigma) {
    if (sigma && problem.free[static_cast<size_t>(parameter)])
      problem.priors.push_back({parameter, Parameter(nominal, parameter), *sigma});
  };
  const PriorKnowledge& known = input.known;
  for (int i = 0; i < 2; ++i) add(i, known.focal_length_px);
  for (int i = 2; i < 4; ++i) add(i, known.principal_point_px);
  for (int i = 4; i < kCameraParameterCount; ++i) add(i, known.distortion);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const int at = FirstParameterOfLeg(leg);
    for (int i = 0; i < 3; ++i) add(at + leg_parameter::kPlatformJoint + i, known.platform_joint_m);
    add(at + leg_parameter::kRadius, known.radius_m);
    add(at + leg_parameter::kJointOffset, known.joint_offset_m);
    for (int i = 0; i < 4; ++i) {
      const double sigma_px = LastingShading(input, options, leg, i / 2);
      const int parameter = at + leg_parameter::kShading + i;
      problem.free[static_cast<size_t>(parameter)] = sigma_px > 0;
      if (sigma_px > 0) add(parameter, sigma_px);
    }
  }
  const double drawn_sigma_m = options.hold.base_joints ? kHeldJointSigma_m : known.base_joint_m.value_or(0);
  if (problem.free[static_cast<size_t>(FirstParameterOfLeg(0))]) problem.base_joint_sigma_m = drawn_sigma_m;
}

TagPlacement PlacementOf(const TagGroup& group, const Rigid3& camera_from_base) {
  const bool on_base = group.carrier == TagCarrier::kBase;
  return {group.carrier, on_base ? camera_from_base * group.carrier_from_group : group.carrier_from_group,
          group.carrier_from_group, group.translation_sigma_m, group.rotation_sigma_rad};
}

// Each tag of a group on the base once, where the images have it in the median.
std::vector<TagObservation> BaseTags(const ObservedTagGroup& observed, size_t group) {
  std::vector<TagObservation> tags;
  for (const Tag& tag : observed.group.tags) {
    std::vector<std::array<Eigen::Vector2d, 4>> seen;
    for (const auto& image : observed.detections)
      for (const TagDetection& detection : image)
        if (detection.id == tag.id) seen.push_back(detection.corners_px);
    if (!seen.empty()) tags.push_back({group, tag.corners_m, MedianCorners(seen), 1});
  }
  return tags;
}

std::vector<TagObservation> PlatformTags(const ObservedTagGroup& observed, size_t group, size_t image) {
  std::vector<TagObservation> tags;
  for (const Tag& tag : observed.group.tags)
    for (const TagDetection& detection : observed.detections[image])
      if (detection.id == tag.id) tags.push_back({group, tag.corners_m, detection.corners_px, 1});
  return tags;
}

// Works through rounds of least squares and re-weighting on one problem.
class Calibrator {
 public:
  Calibrator(const LegCalibrationInput& input, const LegCalibrationOptions& options)
      : input_(input), options_(options), start_(StartOf(input)) {
    problem_.shared = ParametersOf(start_.camera, start_.robot, start_.camera_from_base);
    problem_.free = FreeParameters(input, options);
    AddPriors(input, options, problem_);
    HoldAtDrawing();
    problem_.drawn_base_joints = DrawnJoints(input.drawing, &Leg::base_joint_m);
    problem_.drawn_platform_joints = DrawnJoints(input.drawing, &Leg::platform_joint_m);
    for (size_t image = 0; image < input.images.size(); ++image) AddImage(image);
    AddTags();
    for (const EdgeResidualSet& edge : edges_) samples_ += static_cast<int>(edge.weight.size());
  }

  bool HasEnough() const { return samples_ + readings_ + TagRows() + PriorRows() > UnknownCount(); }
  int UnknownCount() const {
    int unknowns =
        static_cast<int>(problem_.free.count()) - (problem_.HasPlatformGauge() ? 6 : 0) + PlacementUnknowns();
    for (const PoseUnit& unit : problem_.units) unknowns += unit.size();
    return unknowns;
  }

  // False where the model cannot be evaluated any more.
  bool Run() {
    if (!EvaluateResiduals()) return false;
    noise_ = UniformNoise({MedianScale(edges_), 1, 1});
    UpdateWeights(edges_, noise_);
    if (!tag_errors_.empty()) tag_sigma_px_ = MedianTagSigma(tag_errors_);
    for (int round = 0; round < kMaxRounds; ++round) {
      const SolveSummary summary = SolveRound();
      if (!EvaluateResiduals()) return false;
      if (round + 1 == kMaxRounds) return summary.converged;
      if (Reweight(round) && summary.converged) return true;
    }
    return false;
  }

  bool CanEvaluate() { return EvaluateResiduals(); }
  // The first group that starts behind the camera; empty: none.
  std::string TagsBehindCamera();

  LegCalibration Result() const;
  std::vector<TagGroupFit> TagFits() const;

 private:
  // What is held keeps the drawing's and the guessed camera's values, wherever the iterations start.
  void HoldAtDrawing() {
    const SharedParameters nominal = ParametersOf(input_.camera, input_.drawing, start_.camera_from_base);
    for (int i = 0; i < kSharedParameterCount; ++i)
      if (!problem_.free[static_cast<size_t>(i)]) Parameter(problem_.shared, i) = Parameter(nominal, i);
  }
  void AddImage(size_t image);
  void AddEdge(size_t image, size_t edge);
  void AddTags();
  // Every tag with the pose of the platform that carries it (on the base: not looked at), in a fixed order.
  template <typename F>
  void ForEachTag(F f) {
    size_t index = 0;
    for (TagObservation& tag : problem_.base_tags) f(index++, tag, Rigid3());
    for (PoseUnit& unit : problem_.units)
      for (TagObservation& tag : unit.tags) f(index++, tag, unit.camera_from_platform);
  }
  SolveSummary SolveRound();
  bool EvaluateResiduals();
  bool EvaluateTags();
  double ReweightTags(int round);  // by how much the weights changed, in all
  bool Reweight(int round);
  EdgeNoise NoiseOf(const EdgeResidualSet& edge) const {
    EdgeNoise noise = noise_[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
    noise.shift /= std::sqrt(edge.common_weight);
    noise.tilt /= std::sqrt(edge.common_weight);
    return noise;
  }
  double Rms() const;
  double EdgeSigma() const;
  double OtherSquares() const;
  double ReadingSquares() const;
  int PriorRows() const {
    return static_cast<int>(problem_.priors.size()) + (problem_.base_joint_sigma_m > 0 ? 12 : 0) +
           PlacementUnknowns();  // of which each has a prior
  }
  int PlacementUnknowns() const { return 6 * static_cast<int>(problem_.tag_placements.size()); }
  size_t SeenTagGroups() const {
    std::set<size_t> seen;
    for (size_t i = 0; i < tag_errors_.size(); ++i)
      if (tag_errors_[i].weight > 0) seen.insert(tag_groups_[i]);
    return seen.size();
  }
  int TagRows() const { return kTagRows * static_cast<int>(tag_errors_.size()); }

  const LegCalibrationInput& input_;
  const LegCalibrationOptions& options_;
  CalibrationStart start_;
  EstimationProblem problem_;
  std::vector<EdgeResidualSet> edges_;  // parallel to sources_
  std::vector<const EdgeObservation*> sources_;
  std::vector<std::pair<size_t, size_t>> placements_;  // unit, leg observation in it
  NoiseByEdge noise_ = UniformNoise({});
  std::vector<TagErrors> tag_errors_;  // in the order of ForEachTag
  std::vector<size_t> tag_groups_;     // of the same tags
  double tag_sigma_px_ = 0;
  int samples_ = 0;
  int readings_ = 0;
  int iterations_ = 0;
};

void Calibrator::AddImage(size_t image) {
  const ImageObservation& observation = input_.images[image];
  if (observation.edges.empty()) return;
  const Rigid3& camera_from_platform = start_.camera_from_platform[image];
  PoseUnit whole{static_cast<int>(image), options_.rigid_platform, camera_from_platform, {}, {}};
  for (int leg = 0; leg < kLegCount; ++leg) {
    LegObservation of_leg{leg, {}, {}, 1};
    if (options_.use_joint_readings && options_.rigid_platform && observation.joint_readings_m) {
      of_leg.reading_m = (*observation.joint_readings_m)[leg];
      of_leg.reading_sigma_m = input_.known.joint_reading_m.value_or(options_.default_joint_reading_sigma_m);
      ++readings_;
    }
    whole.legs.push_back(of_leg);
  }
  if (options_.rigid_platform) {
    problem_.units.push_back(std::move(whole));
  } else {
    for (const LegObservation& of_leg : whole.legs) {
      const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(of_leg.leg)];
      const Eigen::Vector3d tip = camera_from_platform * leg.segment<3>(leg_parameter::kPlatformJoint);
      problem_.units.push_back(
          {static_cast<int>(image), false, {}, tip - leg.segment<3>(leg_parameter::kBaseJoint), {of_leg}});
    }
  }
  for (size_t edge = 0; edge < observation.edges.size(); ++edge) AddEdge(image, edge);
}

void Calibrator::AddEdge(size_t image, size_t edge) {
  const EdgeObservation& observation = input_.images[image].edges[edge];
  const size_t count = observation.samples.size();
  if (count == 0) return;
  const Eigen::Index rows = static_cast<Eigen::Index>(count);
  EdgeResidualSet set{static_cast<int>(image),
                      observation.leg,
                      observation.edge,
                      PlacesAlong(observation),
                      {},
                      {},
                      Eigen::VectorXd::Ones(rows),
                      observation.common_sigma_px};
  set.sigma_px.resize(rows);
  for (size_t i = 0; i < count; ++i)
    set.sigma_px[static_cast<Eigen::Index>(i)] = observation.samples[i].sigma_px;
  edges_.push_back(std::move(set));
  sources_.push_back(&observation);
  const size_t leg = static_cast<size_t>(observation.leg);
  if (options_.rigid_platform)
    placements_.emplace_back(problem_.units.size() - 1, leg);
  else
    placements_.emplace_back(problem_.units.size() - kLegCount + leg, 0);
}

std::string Calibrator::TagsBehindCamera() {
  std::string behind;
  ForEachTag([&](size_t, const TagObservation& tag, const Rigid3& camera_from_platform) {
    const auto r = EvaluateTag(problem_.shared.camera, problem_.tag_placements[tag.group], Vector6d::Zero(),
                               camera_from_platform, Vector6d::Zero(), tag);
    if (!r && behind.empty()) behind = input_.tags[tag.group].group.name;
  });
  return behind;
}

void Calibrator::AddTags() {
  for (size_t group = 0; group < input_.tags.size(); ++group) {
    const ObservedTagGroup& observed = input_.tags[group];
    problem_.tag_placements.push_back(PlacementOf(observed.group, start_.camera_from_base));
    const bool on_base = observed.group.carrier == TagCarrier::kBase;
    if (on_base) {
      const std::vector<TagObservation> tags = BaseTags(observed, group);
      problem_.base_tags.insert(problem_.base_tags.end(), tags.begin(), tags.end());
    }
    for (PoseUnit& unit : problem_.units) {
      if (on_base) break;
      const std::vector<TagObservation> tags = PlatformTags(observed, group, static_cast<size_t>(unit.image));
      unit.tags.insert(unit.tags.end(), tags.begin(), tags.end());
    }
  }
  ForEachTag([&](size_t, const TagObservation& tag, const Rigid3&) {
    tag_errors_.emplace_back();
    tag_groups_.push_back(tag.group);
  });
}

bool Calibrator::EvaluateTags() {
  bool all = true;
  ForEachTag([&](size_t index, const TagObservation& tag, const Rigid3& camera_from_platform) {
    const auto r = EvaluateTag(problem_.shared.camera, problem_.tag_placements[tag.group], Vector6d::Zero(),
                               camera_from_platform, Vector6d::Zero(), tag);
    all &= r.has_value();
    if (r) tag_errors_[index].error_px = r->residual * tag.sigma_px;
  });
  return all;
}

double Calibrator::ReweightTags(int round) {
  if (tag_errors_.empty()) return 0;
  const std::vector<TagErrors> before = tag_errors_;
  WeighTags(tag_errors_, tag_sigma_px_);
  double change = 0;
  for (size_t i = 0; i < before.size(); ++i)
    change += kTagRows * std::abs(tag_errors_[i].weight - before[i].weight);
  tag_sigma_px_ =
      round < kRoundsByMedian ? MedianTagSigma(tag_errors_) : TagSigma(tag_errors_, SeenTagGroups());
  return change;
}

SolveSummary Calibrator::SolveRound() {
  constexpr double kLeastTagWeight = 1e-8;
  ForEachTag([&](size_t index, TagObservation& tag, const Rigid3&) {
    tag.sigma_px = tag_sigma_px_ / std::sqrt(std::max(tag_errors_[index].weight, kLeastTagWeight));
  });
  for (PoseUnit& unit : problem_.units)
    for (LegObservation& leg : unit.legs) leg.edges.clear();
  for (size_t i = 0; i < edges_.size(); ++i)
    problem_.units[placements_[i].first].legs[placements_[i].second].edges.emplace_back(
        *sources_[i], NoiseOf(edges_[i]), edges_[i].weight);
  SolveOptions solve;
  solve.max_iterations = options_.max_iterations;
  solve.threads = options_.threads;
  if (options_.progress)
    solve.progress = [this](int iteration, double) { options_.progress(iterations_ + iteration, Rms()); };
  const SolveSummary summary = Solve(problem_, solve);
  iterations_ += summary.iterations;
  return summary;
}

bool Calibrator::EvaluateResiduals() {
  const double at_rest[6] = {};
  for (size_t i = 0; i < edges_.size(); ++i) {
    EdgeResidualSet& edge = edges_[i];
    const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(edge.leg)];
    const LegTip tip = TipOf(problem_.units[placements_[i].first], leg, at_rest);
    const auto distances = EdgeDistances(problem_.shared.camera, leg.segment<3>(leg_parameter::kBaseJoint),
                                         tip.b_in_camera, leg[leg_parameter::kRadius], *sources_[i]);
    if (!distances) return false;
    const Eigen::Vector2d shading = leg.segment<2>(leg_parameter::kShading + 2 * edge.edge);
    edge.residual_px = distances->array() - shading[0] - shading[1] * edge.place.array();
  }
  return EvaluateTags();
}

// Updates noise and weights; true once they stand still.
bool Calibrator::Reweight(int round) {
  const EdgeNoise before = MeanNoise(noise_);
  std::vector<Eigen::VectorXd> weights_before;
  for (const EdgeResidualSet& edge : edges_) weights_before.push_back(edge.weight);
  if (round < kRoundsByMedian) {
    noise_ = UniformNoise({MedianScale(edges_), 1, 1});
  } else {
    // Of the freedom that all residuals have, readings and priors use up what their own squares show; tags,
    // whose sigma comes from their own squares, what placing their groups takes.
    const double fitted = UnknownCount() - readings_ - PriorRows() -
                          6.0 * static_cast<double>(SeenTagGroups()) + OtherSquares();
    noise_ = EstimateNoise(edges_, std::max(fitted, 0.0));
  }
  UpdateWeights(edges_, noise_);
  const double tag_sigma_before_px = tag_sigma_px_;
  double change = ReweightTags(round);
  for (size_t i = 0; i < edges_.size(); ++i)
    change += (edges_[i].weight - weights_before[i]).cwiseAbs().sum();
  const auto steady = [](double a, double b) { return std::abs(a - b) <= kSteadyScale * std::max(a, b); };
  const EdgeNoise now = MeanNoise(noise_);
  return round > kRoundsByMedian && steady(before.sample, now.sample) && steady(before.shift, now.shift) &&
         steady(tag_sigma_before_px, tag_sigma_px_) && change <= kSteadyWeight * samples_;
}

double Calibrator::Rms() const {
  double squares = 0, weights = 0;
  for (const EdgeResidualSet& edge : edges_) {
    squares += (edge.weight.array() * edge.residual_px.array().square()).sum();
    weights += edge.weight.sum();
  }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

// Root mean square of what the noise says of one sample: its own, and its edge's common shift.
double Calibrator::EdgeSigma() const {
  double variance = 0;
  for (const EdgeResidualSet& edge : edges_)
    variance +=
        (NoiseOf(edge).sample * edge.sigma_px).squaredNorm() +
        static_cast<double>(edge.sigma_px.size()) * std::pow(NoiseOf(edge).shift * edge.common_sigma_px, 2);
  return samples_ > 0 ? std::sqrt(variance / samples_) : 0;
}

// Sum of squares, in sigmas, of the residuals of readings and priors.
double Calibrator::OtherSquares() const {
  double squares = ReadingSquares();
  if (!problem_.tag_placements.empty()) {
    const BaseFrame base = FitBaseFrame(BaseJointsInCamera(problem_.shared), problem_.drawn_base_joints);
    for (const TagPlacement& placement : problem_.tag_placements)
      squares += EvaluatePlacement(placement, Vector6d::Zero(), base).residual.squaredNorm();
  }
  for (const ParameterPrior& prior : problem_.priors)
    squares += std::pow((Parameter(problem_.shared, prior.parameter) - prior.value) / prior.sigma, 2);
  if (problem_.base_joint_sigma_m > 0)
    squares += EvaluateDrawnBase(problem_, problem_.shared).residual_m.squaredNorm() /
               (problem_.base_joint_sigma_m * problem_.base_joint_sigma_m);
  return squares;
}

double Calibrator::ReadingSquares() const {
  const double at_rest[6] = {};
  double squares = 0;
  for (const PoseUnit& unit : problem_.units)
    for (const LegObservation& observation : unit.legs) {
      if (!observation.reading_m) continue;
      const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(observation.leg)];
      const double length_m =
          (TipOf(unit, leg, at_rest).b_in_camera - leg.segment<3>(leg_parameter::kBaseJoint)).norm();
      squares += std::pow((length_m - leg[leg_parameter::kJointOffset] - *observation.reading_m) /
                              observation.reading_sigma_m,
                          2);
    }
  return squares;
}

std::vector<TagGroupFit> Calibrator::TagFits() const {
  const BaseFrame base = FitBaseFrame(BaseJointsInCamera(problem_.shared), problem_.drawn_base_joints);
  std::vector<TagGroupFit> fits;
  for (size_t group = 0; group < input_.tags.size(); ++group) {
    const TagPlacement& placement = problem_.tag_placements[group];
    TagGroupFit fit{input_.tags[group].group.name, placement.parent_from_group};
    if (placement.carrier == TagCarrier::kBase)
      fit.carrier_from_group = Inverse(base.camera_from_base) * placement.parent_from_group;
    fit.placement_sigmas =
        EvaluatePlacement(placement, Vector6d::Zero(), base).residual.norm() / std::sqrt(6.0);
    double squares = 0, weights = 0;
    for (size_t i = 0; i < tag_errors_.size(); ++i) {
      if (tag_groups_[i] != group) continue;
      ++fit.tags;
      if (tag_errors_[i].weight == 0) ++fit.tags_left_out;
      squares += tag_errors_[i].weight * tag_errors_[i].error_px.squaredNorm();
      weights += kTagRows * tag_errors_[i].weight;
    }
    if (weights > 0) fit.rms_px = std::sqrt(2 * squares / weights);  // two coordinates a corner
    fits.push_back(fit);
  }
  return fits;
}

LegCalibration Calibrator::Result() const {
  LegCalibration result;
  result.camera = WithParameters(input_.camera, problem_.shared.camera);
  result.robot = input_.drawing;
  result.camera_from_platform = start_.camera_from_platform;
  for (const PoseUnit& unit : problem_.units)
    if (unit.rigid) result.camera_from_platform[static_cast<size_t>(unit.image)] = unit.camera_from_platform;
  result.base_joints_in_camera_m = BaseJointsInCamera(problem_.shared);
  result.drawn_base_joints_m = problem_.drawn_base_joints;
  const BaseFrame base = FitBaseFrame(result.base_joints_in_camera_m, result.drawn_base_joints_m);
  const JointsInBase joints = TakeToBase(base, result.base_joints_in_camera_m);
  result.camera_from_base = base.camera_from_base;
  for (size_t i = 0; i < kLegCount; ++i) {
    const LegParameters& leg = problem_.shared.legs[i];
    result.robot.legs[i] = {joints.base_joints_m[i], leg.segment<3>(leg_parameter::kPlatformJoint),
                            leg[leg_parameter::kRadius], leg[leg_parameter::kJointOffset],
                            input_.drawing.legs[i].joint_range_m};
    result.shading_px[i] = leg.segment<4>(leg_parameter::kShading);
  }
  result.tag_sigma_px = tag_sigma_px_;
  result.noise = MeanNoise(noise_);
  result.noise_by_edge = noise_;
  result.rms_px = Rms();
  result.edges = edges_;
  result.edge_sigma_px = EdgeSigma();
  if (readings_ > 0) result.reading_rms = std::sqrt(ReadingSquares() / readings_);
  result.samples = samples_;
  result.iterations = iterations_;
  const auto before = std::chrono::steady_clock::now();
  result.observability = AnalyseObservability(problem_);
  result.covariance_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return result;
}

void CheckTags(const LegCalibrationInput& input, const LegCalibrationOptions& options) {
  for (const ObservedTagGroup& tags : input.tags) {
    if (tags.detections.size() != input.images.size())
      throw std::invalid_argument("CalibrateLegs: a tag group must hold the detections of each image");
    if (tags.group.carrier == TagCarrier::kPlatform && !options.rigid_platform)
      throw std::invalid_argument(fmt::format(
          "CalibrateLegs: the tags {} are on the platform, which is not taken to be rigid", tags.group.name));
    if (!(tags.group.translation_sigma_m > 0 && tags.group.rotation_sigma_rad > 0))
      throw std::invalid_argument(
          fmt::format("CalibrateLegs: the place of the tags {} needs sigmas", tags.group.name));
  }
}

void CheckInput(const LegCalibrationInput& input) {
  if (input.start && input.start->camera_from_platform.size() != input.images.size())
    throw std::invalid_argument("CalibrateLegs: the start must hold a pose for each image");
  for (const ImageObservation& image : input.images)
    for (const EdgeObservation& edge : image.edges) {
      if (edge.leg < 0 || edge.leg >= kLegCount || edge.edge < 0 || edge.edge > 1)
        throw std::invalid_argument(fmt::format("CalibrateLegs: image {} names leg {}, edge {}", image.name,
                                                edge.leg + 1, edge.edge + 1));
      for (const EdgeSample& sample : edge.samples)
        if (!(sample.sigma_px > 0) || !std::isfinite(sample.sigma_px))
          throw std::invalid_argument(
              fmt::format("CalibrateLegs: image {} has a sample of sigma {} px on leg {}", image.name,
                          sample.sigma_px, edge.leg + 1));
    }
}

LegCalibration WithoutEstimate(CalibrationStatus status, const std::string& message) {
  LegCalibration result;
  result.status = status;
  result.message = message;
  result.base_joints_in_camera_m.fill(Eigen::Vector3d::Zero());
  result.drawn_base_joints_m.fill(Eigen::Vector3d::Zero());
  result.shading_px.fill(Eigen::Vector4d::Zero());
  return result;
}

}  // namespace

void LegCalibrationOptions::Check() const {
  if (!(default_joint_reading_sigma_m > 0))
    throw std::invalid_argument("default_joint_reading_sigma_m must be positive");
  if (max_iterations < 1 || threads < 1)
    throw std::invalid_argument("max_iterations and threads must be at least 1");
}

const char* ToString(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::kConverged:
      return "converged";
    case CalibrationStatus::kUnobservable:
      return "unobservable";
    case CalibrationStatus::kNotConverged:
      return "not_converged";
    case CalibrationStatus::kTooFewObservations:
      return "too_few_observations";
  }
  return "unknown";
}

LegCalibration CalibrateLegs(const LegCalibrationInput& input, const LegCalibrationOptions& options) {
  options.Check();
  CheckInput(input);
  CheckTags(input, options);
  Calibrator calibrator(input, options);
  if (!calibrator.HasEnough())
    return WithoutEstimate(CalibrationStatus::kTooFewObservations,
                           "fewer observations than unknowns: add images, or say what is known beforehand");
  if (const std::string tags = calibrator.TagsBehindCamera(); !tags.empty())
    return WithoutEstimate(
        CalibrationStatus::kNotConverged,
        fmt::format("tags.yaml puts the tags {} behind the camera: mend their place, or leave them out",
                    tags));
  const bool settled = calibrator.Run();
  if (!calibrator.CanEvaluate())
    return WithoutEstimate(
        CalibrationStatus::kNotConverged,
        "the estimate ran into a robot whose legs the camera could not see: the first guess is too far off");
  LegCalibration result = calibrator.Result();
  if (!result.observability.unobservable.empty()) {
    result.status = CalibrationStatus::kUnobservable;
    result.message = result.observability.unobservable.front().description;
  } else if (!settled) {
    result.message = "the estimate did not settle";
  } else if (result.rms_px > kAbsurdRms_px) {
    result.message = fmt::format(
        "the best fit leaves {:.0f} px: the images do not show the robot that the drawing "
        "describes, or the first guess of the camera is too far off",
        result.rms_px);
  } else {
    result.status = CalibrationStatus::kConverged;
    result.tags = calibrator.TagFits();
  }
  return result;
}

}  // namespace legible
