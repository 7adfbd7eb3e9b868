#include "calib/leg_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/problem_setup.h"
#include "calib/reading_rounds.h"
#include "calib/tag_rounds.h"
#include "core/stopwatch.h"

namespace legible {
namespace {

constexpr int kMaxRounds = 12;          // of solving and re-weighting; the last keeps its weights
constexpr int kRoundsByMedian = 2;      // the scale comes from the median until the worst outliers are gone
constexpr double kSteadyScale = 1e-3;   // relative change of the noise at which the rounds end
constexpr double kSteadyCommon = 1e-2;  // of the edges' shift and tilt, which some hundred edges tell to 5 %
constexpr double kSteadyWeight = 1e-4;  // mean absolute change of the weights at which they end
constexpr double kAbsurdRms_px = 20;    // a fit this bad is a wrong model, not noise

// What the corners of a board tell beyond where it stood in each view, as far as they count.
int BoardFreedom(const BoardProblem& board) {
  int freedom = -6 * static_cast<int>(board.views.size()) - (board.estimates_warp ? 2 : 0);
  for (const ViewObservation& view : board.views)
    for (const Eigen::Matrix2d& whitening : view.whitening_per_px)
      if (!whitening.isZero(0)) freedom += 2;
  return static_cast<int>(std::lround(board.mean_square * freedom));
}

// Infinite where the camera does not see the board.
double BoardSquares(const BoardProblem& board, const CameraParameters& parameters) {
  double squares = 0;
  for (const ViewObservation& view : board.views) {
    const auto errors =
        ViewErrors(WithParameters(board.camera, parameters), board.warp, view, Vector6d::Zero());
    squares += errors ? errors->squaredNorm() : std::numeric_limits<double>::infinity();
  }
  return squares;
}

// Works through rounds of least squares and re-weighting on one problem.
class Calibrator {
 public:
  Calibrator(const LegCalibrationInput& input, const LegCalibrationOptions& options)
      : input_(input),
        options_(options),
        start_(StartOf(input)),
        problem_(ProblemOf(input, options, start_)),
        readings_(problem_),
        tags_(problem_) {
    AddEdges();
    for (const EdgeResidualSet& edge : edges_) samples_ += static_cast<int>(edge.weight.size());
  }

  bool HasEnough() const {
    return samples_ + readings_.count() + tags_.rows() + PriorRows() > UnknownCount();
  }
  int UnknownCount() const {
    int unknowns =
        static_cast<int>(problem_.free.count()) - (problem_.HasPlatformGauge() ? 6 : 0) + PlacementUnknowns();
    for (const PoseUnit& unit : problem_.units) unknowns += unit.size();
    return unknowns;
  }

  // False where the model cannot be evaluated any more.
  bool Run() {
    if (!CanEvaluate()) return false;
    const double scale = MedianScale(edges_);
    noise_ = UniformNoise({scale, 1, 1});
    UpdateWeights(edges_, noise_);
    tags_.Start();
    readings_.Loosen(scale);
    for (int round = 0; round < kMaxRounds; ++round) {
      const SolveSummary summary = SolveRound();
      if (!CanEvaluate()) return false;
      if (round + 1 == kMaxRounds) return summary.converged;
      weights_steady_ = Reweight(round);
      if (weights_steady_ && summary.converged) return true;
    }
    return false;
  }

  bool CanEvaluate() {
    readings_.Evaluate();
    return EvaluateEdges() && !tags_.Evaluate();
  }
  // The first group that starts behind the camera; empty: none.
  std::string TagsBehindCamera() {
    const std::optional<size_t> group = tags_.Evaluate();
    return group ? input_.tags[*group].group.name : std::string();
  }

  LegCalibration Result() const;
  std::vector<TagGroupFit> TagFits() const { return tags_.Fits(input_.tags); }

 private:
  void AddEdges();
  void AddEdge(size_t unit, const EdgeObservation& observation);
  SolveSummary SolveRound();
  bool EvaluateEdges();
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
  int PriorRows() const {
    // Of a prior on all platform joints six rows follow where their frame is fitted to the drawing.
    const bool on_platform = input_.known.platform_joint_m && problem_.HasPlatformGauge();
    return static_cast<int>(problem_.priors.size() + problem_.camera_prior.root.rows()) -
           (on_platform ? 6 : 0) + (problem_.base_joint_sigma_m > 0 ? 12 : 0) +
           PlacementUnknowns() +  // of which each has a prior
           (problem_.board ? BoardFreedom(*problem_.board) : 0);
  }
  int PlacementUnknowns() const { return 6 * static_cast<int>(problem_.tag_placements.size()); }

  const LegCalibrationInput& input_;
  const LegCalibrationOptions& options_;
  CalibrationStart start_;
  EstimationProblem problem_;
  ReadingRounds readings_;
  TagRounds tags_;
  std::vector<EdgeResidualSet> edges_;  // parallel to sources_
  std::vector<const EdgeObservation*> sources_;
  std::vector<std::pair<size_t, size_t>> placements_;  // unit, leg observation in it
  NoiseByEdge noise_ = UniformNoise({});
  int samples_ = 0;
  int iterations_ = 0;
  bool weights_steady_ = false;
};

void Calibrator::AddEdges() {
  const size_t units_an_image = options_.rigid_platform ? 1 : kLegCount;
  for (size_t unit = 0; unit < problem_.units.size(); unit += units_an_image)
    for (const EdgeObservation& observation :
         input_.images[static_cast<size_t>(problem_.units[unit].image)].edges)
      AddEdge(unit, observation);
}

// `unit` is the first of the image's.
void Calibrator::AddEdge(size_t unit, const EdgeObservation& observation) {
  const size_t count = observation.samples.size();
  if (count == 0) return;
  const Eigen::Index rows = static_cast<Eigen::Index>(count);
  EdgeResidualSet set{problem_.units[unit].image,
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
  placements_.emplace_back(options_.rigid_platform ? std::pair(unit, leg) : std::pair(unit + leg, size_t{0}));
}

SolveSummary Calibrator::SolveRound() {
  tags_.SetScales();
  for (PoseUnit& unit : problem_.units)
    for (LegObservation& leg : unit.legs) leg.edges.clear();
  for (size_t i = 0; i < edges_.size(); ++i)
    problem_.units[placements_[i].first].legs[placements_[i].second].edges.emplace_back(
        *sources_[i], NoiseOf(edges_[i]), edges_[i].weight);
  SolveOptions solve;
  solve.max_iterations = options_.max_iterations;
  solve.threads = options_.threads;
  // Weights and noise stand still within the round: the residuals go with the root of the cost.
  if (options_.progress)
    solve.progress = [this, rms_px = Rms(), first = 0.0](int iteration, double cost) mutable {
      if (iteration == 0) first = cost;
      options_.progress(iterations_ + iteration, first > 0 ? rms_px * std::sqrt(cost / first) : rms_px);
    };
  const SolveSummary summary = Solve(problem_, solve);
  iterations_ += summary.iterations;
  return summary;
}

bool Calibrator::EvaluateEdges() {
  const double at_rest[6] = {};
  for (size_t i = 0; i < edges_.size(); ++i) {
    EdgeResidualSet& edge = edges_[i];
    const LegParameters& leg = problem_.shared.legs[static_cast<size_t>(edge.leg)];
    const LegTip tip = TipOf(problem_.units[placements_[i].first], leg, at_rest);
    const auto distances = EdgeDistances(CameraOf(problem_), leg.segment<3>(leg_parameter::kBaseJoint),
                                         tip.b_in_camera, leg[leg_parameter::kRadius], *sources_[i]);
    if (!distances) return false;
    const Eigen::Vector2d shading = leg.segment<2>(leg_parameter::kShading + 2 * edge.edge);
    edge.residual_px = distances->array() - shading[0] - shading[1] * edge.place.array();
  }
  return true;
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
    const double fitted = UnknownCount() - readings_.Weight() - PriorRows() -
                          6.0 * static_cast<double>(tags_.SeenGroups()) + OtherSquares();
    noise_ = EstimateNoise(edges_, std::clamp(fitted, 0.0, static_cast<double>(UnknownCount())));
  }
  UpdateWeights(edges_, noise_);
  const double tag_scale_before = tags_.scale();
  double change = tags_.Reweight(round < kRoundsByMedian) + readings_.Reweight();
  for (size_t i = 0; i < edges_.size(); ++i)
    change += (edges_[i].weight - weights_before[i]).cwiseAbs().sum();
  const auto steady = [](double a, double b, double share = kSteadyScale) {
    return std::abs(a - b) <= share * std::max(a, b);
  };
  const EdgeNoise now = MeanNoise(noise_);
  return round > kRoundsByMedian && steady(before.sample, now.sample) &&
         steady(before.shift, now.shift, kSteadyCommon) && steady(before.tilt, now.tilt, kSteadyCommon) &&
         steady(tag_scale_before, tags_.scale(), kSteadyCommon) && change <= kSteadyWeight * samples_;
}

double Calibrator::Rms() const {
  double squares = 0, weights = 0;
  for (const EdgeResidualSet& edge : edges_) {
    const Eigen::VectorXd weight = edge.CountedWeight();
    squares += weight.dot(edge.residual_px.cwiseAbs2());
    weights += weight.sum();
  }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

// Root mean square of what the noise says of one sample: its own, and its edge's common shift.
double Calibrator::EdgeSigma() const {
  double variance = 0;
  for (const EdgeResidualSet& edge : edges_) {
    const EdgeNoise& noise = noise_[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
    variance += (noise.sample * edge.sigma_px).squaredNorm() +
                static_cast<double>(edge.sigma_px.size()) * std::pow(noise.shift * edge.common_sigma_px, 2);
  }
  return samples_ > 0 ? std::sqrt(variance / samples_) : 0;
}

// Sum of squares, in sigmas, of the residuals of readings and priors.
double Calibrator::OtherSquares() const {
  double squares = readings_.Squares();
  for (const PlacementResiduals& placement : EvaluatePlacements(problem_))
    squares += placement.residual.squaredNorm();
  for (const ParameterPrior& prior : problem_.priors)
    squares += std::pow((Parameter(problem_.shared, prior.parameter) - prior.value) / prior.sigma, 2);
  squares += problem_.camera_prior.Residual(problem_.shared.camera).squaredNorm();
  if (problem_.board) squares += BoardSquares(*problem_.board, problem_.shared.camera);
  if (problem_.base_joint_sigma_m > 0)
    squares += EvaluateDrawnBase(problem_, problem_.shared).residual_m.squaredNorm() /
               (problem_.base_joint_sigma_m * problem_.base_joint_sigma_m);
  return squares;
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
  result.base_joints_held = options_.hold.base_joints;
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
  result.tag_sigma_px = tags_.Sigma_px();
  result.noise = MeanNoise(noise_);
  result.noise_by_edge = noise_;
  result.rms_px = Rms();
  result.edges = edges_;
  result.edge_sigma_px = EdgeSigma();
  result.reading_rms = readings_.Rms();
  result.reading_scatter = readings_.Scatter();
  result.outlying_readings = readings_.Outlying();
  result.samples = samples_;
  result.iterations = iterations_;
  result.weights_steady = weights_steady_;
  const Stopwatch of_covariance;
  result.observability = AnalyseObservability(problem_);
  result.covariance_s = of_covariance.Seconds();
  return result;
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

bool LegCalibration::ReadingsCountIn(size_t image) const {
  return std::none_of(
      outlying_readings.begin(), outlying_readings.end(),
      [&](const OutlyingReading& reading) { return static_cast<size_t>(reading.image) == image; });
}

double LegCalibration::Misfit() const { return std::max({noise.sample, noise.shift, noise.tilt}); }

void LegCalibrationOptions::Check() const {
  if (!(default_joint_reading_sigma_m > 0))
    throw std::invalid_argument("default_joint_reading_sigma_m must be positive");
  if (!(lasting_shading >= 0)) throw std::invalid_argument("lasting_shading must not be negative");
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
  CheckInput(input, options);
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
