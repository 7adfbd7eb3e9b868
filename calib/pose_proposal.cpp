#include "calib/pose_proposal.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "calib/calibrated_model.h"
#include "calib/image_choice.h"
#include "calib/observability.h"
#include "calib/problem_setup.h"
#include "calib/shared_information.h"

namespace legible {
namespace {

constexpr double kAssumedSigma = 0.05;  // of each parameter in natural units, so that C exists
constexpr int kPosesCaredFor = 200;
constexpr std::uint64_t kOtherSeed = 0x9e3779b97f4a7c15;  // keeps those poses apart from the candidates
constexpr double kLeastRegularity = 1e-3;                 // of a pose in which the platform has been

template <typename F>
void ForEach(size_t count, int threads, const F& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(size_t{0}, count, work); });
}

RigModel ModelOf(const LegCalibrationInput& input) {
  if (!input.start) return {input.drawing, input.camera, input.camera_from_base};
  return {input.start->robot, input.start->camera, input.start->camera_from_base};
}

// Edges that no image shows yet are shaded as they are expected to be.
void AddExpectedShading(double sigma_px, EstimationProblem& problem) {
  if (!(sigma_px > 0)) return;
  for (int leg = 0; leg < kLegCount; ++leg)
    for (int i = 0; i < 4; ++i) {
      const int parameter = FirstParameterOfLeg(leg) + leg_parameter::kShading + i;
      if (problem.free[static_cast<size_t>(parameter)]) continue;
      problem.free.set(static_cast<size_t>(parameter));
      problem.priors.push_back({parameter, 0, sigma_px});
    }
}

void DemandProposable(const LegCalibrationInput& input, const LegCalibrationOptions& estimation) {
  CheckInput(input, estimation);
  estimation.Check();
  if (!input.tags.empty())
    throw std::invalid_argument("PoseProposer: what tags will show is not foreseen; leave them out");
  if (!estimation.rigid_platform || !estimation.use_joint_readings)
    throw std::invalid_argument(
        "PoseProposer: poses are predicted from joint readings of a rigid platform; these cannot be left "
        "out");
}

// Root mean square over the entries [first, first + count) of each leg in ModelCovariance; nothing where one
// is open.
std::optional<double> RmsOverLegs(const ModelCovariance& model, int first, int count) {
  double squares = 0;
  for (int leg = 0; leg < kLegCount; ++leg)
    for (int i = first; i < first + count; ++i) {
      const int row = kCameraParameterCount + leg * kModelLegParameters + i;
      if (!model.known[static_cast<size_t>(row)]) return std::nullopt;
      squares += model.covariance(row, row);
    }
  return std::sqrt(squares / (kLegCount * count));
}

// Of camera parameters first and first + 1.
std::optional<double> RmsOfTwo(const Observability& found, int first) {
  const auto at = static_cast<size_t>(first);
  if (!found.known[at] || !found.known[at + 1]) return std::nullopt;
  return std::sqrt((found.covariance(first, first) + found.covariance(first + 1, first + 1)) / 2);
}

}  // namespace

void PoseProposalOptions::Check() const {
  candidates.Check();
  if (lever_m && !(*lever_m >= 0)) throw std::invalid_argument("lever_m must not be negative");
  if (!(same_pose_m >= 0)) throw std::invalid_argument("same_pose_m must not be negative");
  if (planned_images < 0 || plan_passes < 0)
    throw std::invalid_argument("planned_images and plan_passes must not be negative");
  if (threads < 1) throw std::invalid_argument("PoseProposalOptions: threads must be at least 1");
}

PoseProposer::PoseProposer(LegCalibrationInput input, const LegCalibrationOptions& estimation,
                           PoseProposalOptions options)
    : input_(std::move(input)),
      estimation_(estimation),
      options_(std::move(options)),
      model_(ModelOf(input_)),
      seen_(Eigen::MatrixXd::Zero(kSharedParameterCount, kSharedParameterCount)) {
  options_.Check();
  DemandProposable(input_, estimation_);
  const std::vector<ImageObservation> images = std::exchange(input_.images, {});
  lever_m_ = options_.lever_m.value_or(PlatformRadius(model_.robot));
  candidates_ = DrawPoseCandidates(model_, options_.candidates);
  if (options_.cared_for.empty())
    options_.cared_for = DrawReachablePoses(model_.robot, kPosesCaredFor,
                                            options_.candidates.seed ^ kOtherSeed, options_.candidates.reach);
  if (options_.cared_for.empty())
    throw std::invalid_argument(
        "PoseProposer: hardly any pose is within the joint ranges and away from singular ones; mend the "
        "drawing's joint_range_m");
  const EstimationProblem problem = WithoutUnits();
  by_shared_ = ModelBySharedParameters(BaseJointsInCamera(problem.shared), problem.drawn_base_joints,
                                       estimation_.hold.base_joints);
  forms_ = PoseErrorOf(model_.robot, options_.cared_for, by_shared_);
  taken_.assign(candidates_.poses.size(), false);
  roots_.resize(candidates_.poses.size());
  ForEach(roots_.size(), options_.threads, [&](size_t i) {
    const PoseCandidate& candidate = candidates_.poses[i];
    roots_[i] =
        RootOf(InformationOf(candidate.expected, model_.camera_from_base * candidate.base_from_platform));
  });
  for (size_t i = 0; i < images.size(); ++i)
    input_.start ? AddAt(images[i], input_.start->camera_from_platform[i]) : Add(images[i]);
}

// The estimator's problem of the images so far, but for their poses and data, which count by `seen_`.
EstimationProblem PoseProposer::WithoutUnits() const {
  EstimationProblem problem = ProblemOf(
      input_, estimation_, {model_.camera, model_.robot, model_.camera_from_base, camera_from_platform_});
  problem.units = {PoseUnit{0, true, model_.camera_from_base * model_.robot.home, {}, {}}};
  AddExpectedShading(estimation_.lasting_shading * options_.candidates.edges.common_sigma_px, problem);
  return problem;
}

Eigen::MatrixXd PoseProposer::InformationOf(const ImageObservation& image,
                                            const Rigid3& camera_from_platform) const {
  return ImageInformation(WithoutUnits(), image, camera_from_platform,
                          input_.known.joint_reading_m.value_or(estimation_.default_joint_reading_sigma_m),
                          options_.noise);
}

void PoseProposer::Add(const ImageObservation& image) {
  if (!image.joint_readings_m)
    throw std::invalid_argument(fmt::format("PoseProposer: image {} has no joint readings", image.name));
  const auto pose = PoseFromHome(model_.robot, *image.joint_readings_m, kLeastRegularity);
  if (!pose)
    throw std::invalid_argument(
        fmt::format("PoseProposer: the joint readings of image {} lead to no pose", image.name));
  AddAt(image, model_.camera_from_base * *pose);
}

void PoseProposer::AddAt(const ImageObservation& image, const Rigid3& camera_from_platform) {
  LegCalibrationInput one = input_;
  one.start.reset();
  one.images = {image};
  CheckInput(one, estimation_);
  input_.images.push_back(image);  // before its information: its edges may be the first that are shaded
  camera_from_platform_.push_back(camera_from_platform);
  try {
    if (!image.edges.empty()) {
      seen_ += InformationOf(image, camera_from_platform);
      ++images_with_edges_;
    }
  } catch (...) {
    input_.images.pop_back();
    camera_from_platform_.pop_back();
    throw;
  }
  if (image.joint_readings_m) Take(*image.joint_readings_m);
}

void PoseProposer::Reject(const Rigid3& base_from_platform) {
  Take(InverseKinematics(model_.robot, base_from_platform));
}

void PoseProposer::Take(const Vector6d& joint_readings_m) {
  for (size_t i = 0; i < taken_.size(); ++i)
    if ((*candidates_.poses[i].expected.joint_readings_m - joint_readings_m).cwiseAbs().maxCoeff() <=
        options_.same_pose_m)
      taken_[i] = true;
}

ExpectedSigma PoseProposer::SigmaOf(const EstimationProblem& problem,
                                    const Eigen::MatrixXd& information) const {
  const Observability found = AnalyseObservability(problem, information);
  ExpectedSigma sigma;
  sigma.focal_length_px = RmsOfTwo(found, 0);
  sigma.principal_point_px = RmsOfTwo(found, 2);
  ModelCovariance model{{}, by_shared_ * found.covariance * by_shared_.transpose(), {}};
  model.known.reserve(static_cast<size_t>(by_shared_.rows()));
  for (Eigen::Index row = 0; row < by_shared_.rows(); ++row) {
    bool known = true;
    for (Eigen::Index i = 0; i < kSharedParameterCount; ++i)
      known &= by_shared_(row, i) == 0 || found.known[static_cast<size_t>(i)];
    model.known.push_back(known);
  }
  sigma.base_joint_m = RmsOverLegs(model, 0, 3);
  sigma.platform_joint_m = RmsOverLegs(model, 3, 3);
  sigma.radius_m = RmsOverLegs(model, 6, 1);
  sigma.joint_offset_m = RmsOverLegs(model, 7, 1);
  if (sigma.base_joint_m && sigma.platform_joint_m && sigma.joint_offset_m) {
    sigma.position_m = std::sqrt((forms_.position * found.covariance).trace());
    sigma.rotation_rad = std::sqrt((forms_.rotation * found.covariance).trace());
  }
  return sigma;
}

ExpectedSigma PoseProposer::Expected() const {
  const EstimationProblem problem = WithoutUnits();
  return SigmaOf(problem, seen_ + SharedInformation(problem));
}

std::optional<PoseProposal> PoseProposer::Next() const {
  const EstimationProblem problem = WithoutUnits();
  const Eigen::MatrixXd information = seen_ + SharedInformation(problem);
  const ImageChoice choice(AnalysedDirections(problem), kAssumedSigma,
                           RootOf(forms_.position + lever_m_ * lever_m_ * forms_.rotation), roots_,
                           options_.threads);
  const int together = std::max(options_.planned_images - images_with_edges_, 1);
  const std::vector<size_t> best = choice.BestTogether(information, taken_, together, options_.plan_passes);
  if (best.empty()) return std::nullopt;
  const size_t i = best.front();
  const PoseCandidate& candidate = candidates_.poses[i];
  return PoseProposal{candidate.base_from_platform, *candidate.expected.joint_readings_m,
                      static_cast<int>(candidate.expected.edges.size()),
                      SigmaOf(problem, information + roots_[i].transpose() * roots_[i])};
}

}  // namespace legible
