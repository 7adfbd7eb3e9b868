#include "calib/board/board_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "calib/board/board_start.h"
#include "calib/board/corner_noise.h"
#include "calib/board/rough_start.h"
#include "calib/board/usable_views.h"
#include "calib/robust_weights.h"
#include "core/stopwatch.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr size_t kFewestViews = 3;           // that differ: two leave the principal point open
constexpr double kLargestUnevenness = 0.06;  // of the distance of neighbouring corners
constexpr double kLargestFocalSigma = 0.05;  // of the focal length
constexpr double kHopelessFactor = 2;        // by which a guessed focal length may be off
constexpr int kMaxRounds = 100, kRoundsOfScale = 4;
constexpr double kSteadyScale = 1e-4;   // relative change of the noise at which the rounds end
constexpr double kSteadyWeight = 1e-5;  // mean absolute change of the weights at which they end

// The whitening of a corner at a weight and a noise.
Eigen::Matrix2d Scaled(const Eigen::Matrix2d& whitening, double weight, double noise_factor) {
  return std::sqrt(weight) / noise_factor * whitening;
}

// A view that has a part.
struct UsedView {
  size_t source = 0;  // which of the input's views
  ViewObservation observation;
  std::vector<Eigen::Matrix2d> own_whitening;  // of the corners, by their own covariances
  std::vector<double> weight;
  std::vector<Eigen::Vector2d> error_px;

  double CountedCorners() const { return std::accumulate(weight.begin(), weight.end(), 0.0); }
  double Square(size_t corner) const { return (own_whitening[corner] * error_px[corner]).squaredNorm(); }
};

class CameraCalibrator {
 public:
  CameraCalibrator(const BoardCalibrationInput& input, const BoardCalibrationOptions& options)
      : input_(input), options_(options) {
    result_.views.resize(input.views.size());
    for (size_t i = 0; i < input.views.size(); ++i) AddView(i);
  }

  BoardCalibration FromNothing();
  BoardCalibration From(const BoardCalibration& earlier);
  BoardProblem SolvedBy(const BoardCalibration& solution);

 private:
  enum class Outcome { kSettled, kUnsettled, kTooFewViews, kCannotBeEvaluated };

  void AddView(size_t view);
  int DistinctViews() const;
  bool HasFlatBoards(const StraightenedViews& straightened) const;
  BoardCalibration NotFlat();
  bool Start(const StraightenedViews& straightened);
  void Place(const BoardCalibration& earlier);
  void Drop(size_t view, const std::string& reason);
  void DropOutlyingViews();
  std::vector<ViewObservation> Observations() const;
  BoardProblem Whitened() const;

  Outcome Run();
  bool Solve();
  bool Evaluate();
  bool Reweight(int round);
  double NoiseByMedian() const;
  double NoiseBySquares() const;
  double Rms() const;
  void Report(const char* stage, int iteration, double rms_px) const {
    if (options_.progress) options_.progress(stage, iteration, rms_px);
  }

  BoardCalibration Failed(BoardCalibrationStatus status, const std::string& message);
  BoardCalibration Result(Outcome outcome);
  void Describe(const UsedView& view);
  void Judge(Outcome outcome);

  const BoardCalibrationInput& input_;
  const BoardCalibrationOptions& options_;
  const Stopwatch stopwatch_;
  Camera camera_;
  BoardWarp warp_;
  std::vector<UsedView> views_;
  double noise_factor_ = 1, weight_scale_ = 1;
  BoardCalibration result_;
};

// --- Views. ----------------------------------------------------------------------------------------------

void CameraCalibrator::AddView(size_t view) {
  const BoardView& seen = input_.views[view];
  if (std::ssize(seen.corners) < kFewestViewCorners) {
    result_.views[view].left_out =
        fmt::format("shows {} corners of the board, fewer than {}", seen.corners.size(), kFewestViewCorners);
    return;
  }
  UsedView used;
  used.source = view;
  for (const BoardCorner& corner : seen.corners) {
    used.observation.points_in_board_m.push_back(
        input_.points_in_board_m.at(static_cast<size_t>(corner.point)));
    used.observation.pixels.push_back(corner.pixel);
    used.own_whitening.push_back(WhiteningOf(corner.covariance_px2));
  }
  used.observation.whitening_per_px.assign(seen.corners.size(), Eigen::Matrix2d::Identity());
  used.weight.assign(seen.corners.size(), 1.0);
  used.error_px.assign(seen.corners.size(), Eigen::Vector2d::Zero());
  if (AreOnOneLine(used.observation))
    result_.views[view].left_out = "shows corners on one line of the board only";
  else
    views_.push_back(std::move(used));
}

int CameraCalibrator::DistinctViews() const {
  std::vector<size_t> sources;
  for (const UsedView& view : views_) sources.push_back(view.source);
  return CountDistinctViews(input_, sources);
}

bool CameraCalibrator::HasFlatBoards(const StraightenedViews& straightened) const {
  std::vector<double> shares;
  for (size_t i = 0; i < views_.size(); ++i)
    if (const auto& view = straightened.views[i])
      shares.push_back(view->median_error * straightened.unit_px /
                       NeighbourDistance_px(views_[i].observation));
  return !shares.empty() && MedianOf(shares) <= kLargestUnevenness;
}

// What a pinhole cannot make flat, a lens perhaps can.
BoardCalibration CameraCalibrator::NotFlat() {
  const bool may_be_the_lens =
      options_.lens == LensModel::kPinhole &&
      HasFlatBoards(Straighten(Observations(), input_.width_px, input_.height_px, true));
  if (may_be_the_lens)
    return Failed(BoardCalibrationStatus::kNotConverged,
                  "the lens bends straight lines: take another lens model than pinhole");
  return Failed(BoardCalibrationStatus::kNotFlat, "the corners do not lie to each other as on the board");
}

std::vector<ViewObservation> CameraCalibrator::Observations() const {
  std::vector<ViewObservation> observations;
  observations.reserve(views_.size());
  for (const UsedView& view : views_) observations.push_back(view.observation);
  return observations;
}

// Takes the start over, without views that no pose of the board explains.
bool CameraCalibrator::Start(const StraightenedViews& straightened) {
  std::vector<double> more;
  if (options_.guess) more.push_back(options_.guess->fx_px / straightened.unit_px);
  const auto start =
      RoughStart(straightened, options_.lens, input_.width_px, input_.height_px, Observations(), more,
                 [this](double error_px) { Report("looking for a start", 0, error_px); });
  if (!start) return false;
  camera_ = start->camera;
  for (size_t i = 0; i < views_.size(); ++i)
    views_[i].observation.camera_from_board = start->views[i].camera_from_board;
  const std::vector<size_t> unexplained = UnexplainedViews(*start, options_.trusts_all);
  for (size_t i = unexplained.size(); i-- > 0;)
    Drop(unexplained[i], "fits no pose of the board: its corners are far from where any puts them");
  return true;
}

void CameraCalibrator::Place(const BoardCalibration& earlier) {
  camera_ = earlier.camera;
  warp_ = earlier.warp;
  for (size_t i = views_.size(); i-- > 0;) {
    const ViewFit& fit = earlier.views.at(views_[i].source);
    views_[i].observation.camera_from_board = fit.camera_from_board;
    if (!fit.left_out.empty()) Drop(i, fit.left_out);
  }
}

// Views count from 0 among those that have a part.
void CameraCalibrator::Drop(size_t view, const std::string& reason) {
  result_.views[views_[view].source].left_out = reason;
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(view));
}

// Few corners left do not hold a view's pose.
void CameraCalibrator::DropOutlyingViews() {
  for (size_t i = views_.size(); i-- > 0;)
    if (views_[i].CountedCorners() < kFewestViewCorners)
      Drop(i, "contradicts the others: nearly all of its corners are far from where these put them");
}

// --- The estimate. ---------------------------------------------------------------------------------------

// With the weights and the noise as they stand.
BoardProblem CameraCalibrator::Whitened() const {
  BoardProblem problem{camera_, Observations(), warp_, options_.estimates_warp};
  for (size_t i = 0; i < views_.size(); ++i)
    for (size_t k = 0; k < views_[i].weight.size(); ++k)
      problem.views[i].whitening_per_px[k] =
          Scaled(views_[i].own_whitening[k], views_[i].weight[k], noise_factor_);
  return problem;
}

bool CameraCalibrator::Solve() {
  BoardProblem problem = Whitened();
  BoardSolveOptions solve;
  solve.max_iterations = options_.max_iterations;
  solve.threads = options_.threads;
  if (options_.progress)
    solve.progress = [this, rms_px = Rms(), first = 0.0](int iteration, double cost) mutable {
      if (iteration == 0) first = cost;
      Report("estimating", result_.iterations + iteration,
             first > 0 ? rms_px * std::sqrt(cost / first) : rms_px);
    };
  const BoardSolveSummary summary = SolveBoard(problem, solve);
  result_.iterations += summary.iterations;
  camera_ = problem.camera;
  warp_ = problem.warp;
  for (size_t i = 0; i < views_.size(); ++i)
    views_[i].observation.camera_from_board = problem.views[i].camera_from_board;
  return summary.converged;
}

// False where the model cannot be evaluated any more.
bool CameraCalibrator::Evaluate() {
  for (UsedView& view : views_) {
    const auto errors = ViewErrors(camera_, warp_, view.observation, Vector6d::Zero());
    if (!errors) return false;
    for (size_t k = 0; k < view.error_px.size(); ++k)
      view.error_px[k] = errors->segment<2>(2 * static_cast<Eigen::Index>(k));
  }
  return true;
}

double CameraCalibrator::NoiseByMedian() const {
  std::vector<double> squares;
  for (const UsedView& view : views_)
    for (size_t k = 0; k < view.weight.size(); ++k) squares.push_back(view.Square(k));
  return std::sqrt(MedianOf(squares) / kMedianSquareInPlane);
}

// The factor on the corners' own sigmas that the weighted residuals show.
double CameraCalibrator::NoiseBySquares() const {
  double squares = 0, weights = 0;
  for (const UsedView& view : views_)
    for (size_t k = 0; k < view.weight.size(); ++k) {
      squares += view.weight[k] * view.Square(k);
      weights += view.weight[k];
    }
  const double unknowns = 4 + static_cast<double>(camera_.lens) + 6 * static_cast<double>(views_.size()) +
                          (options_.estimates_warp ? 2 : 0);
  const double freedom = 2 * weights - unknowns;
  const double cut_off = options_.trusts_all ? 1 : CutOffInPlane();
  return freedom > 0 ? std::sqrt(squares / freedom / cut_off) : 0;
}

// Updates noise and weights; true once they stand still. The scale of the weights follows the noise in the
// first rounds only: under a lens model that does not fit it would go on shrinking, and take ever more
// corners for outliers.
bool CameraCalibrator::Reweight(int round) {
  const bool by_median = round <= 0 && !options_.trusts_all;
  noise_factor_ = std::max(by_median ? NoiseByMedian() : NoiseBySquares(), 1e-9);  // exact data
  const double scale_before = weight_scale_;
  if (round < kRoundsOfScale) weight_scale_ = noise_factor_;
  double change = 0, count = 0;
  for (UsedView& view : views_)
    for (size_t k = 0; k < view.weight.size(); ++k) {
      const double next = options_.trusts_all ? 1 : RobustWeight(std::sqrt(view.Square(k)) / weight_scale_);
      change += std::abs(next - view.weight[k]);
      view.weight[k] = next;
      count += 1;
    }
  return !by_median && std::abs(weight_scale_ - scale_before) <= kSteadyScale * weight_scale_ &&
         change <= kSteadyWeight * count;
}

// Rounds of least squares and re-weighting.
CameraCalibrator::Outcome CameraCalibrator::Run() {
  if (!Evaluate()) return Outcome::kCannotBeEvaluated;
  Reweight(-1);
  for (int round = 0; round < kMaxRounds; ++round) {
    DropOutlyingViews();
    if (views_.size() < kFewestViews) return Outcome::kTooFewViews;
    const bool converged = Solve();
    if (!Evaluate()) return Outcome::kCannotBeEvaluated;
    const bool steady = Reweight(round);
    if (converged && (steady || options_.trusts_all)) return Outcome::kSettled;
  }
  return Outcome::kUnsettled;
}

double CameraCalibrator::Rms() const {
  double squares = 0, weights = 0;
  for (const UsedView& view : views_)
    for (size_t k = 0; k < view.weight.size(); ++k) {
      squares += view.weight[k] * view.error_px[k].squaredNorm();
      weights += view.weight[k];
    }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

// --- What came out. --------------------------------------------------------------------------------------

BoardCalibration CameraCalibrator::Failed(BoardCalibrationStatus status, const std::string& message) {
  result_.status = status;
  result_.message = message;
  result_.seconds = stopwatch_.Seconds();
  return result_;
}

void CameraCalibrator::Describe(const UsedView& view) {
  ViewFit& fit = result_.views[view.source];
  fit.camera_from_board = view.observation.camera_from_board;
  fit.residual_px = view.error_px;
  fit.weight = view.weight;
  double squares = 0;
  for (size_t k = 0; k < view.weight.size(); ++k) {
    squares += view.weight[k] * view.error_px[k].squaredNorm();
    if (view.weight[k] == 0) ++result_.corners_left_out;
  }
  fit.rms_px = std::sqrt(squares / std::max(view.CountedCorners(), 1e-9));
  result_.corners += view.CountedCorners();
}

BoardCalibration CameraCalibrator::Result(Outcome outcome) {
  if (outcome == Outcome::kCannotBeEvaluated)
    return Failed(BoardCalibrationStatus::kNotConverged,
                  "the estimate ran into a camera that could not see the boards");
  if (outcome == Outcome::kTooFewViews)
    return Failed(BoardCalibrationStatus::kTooFewViews,
                  fmt::format("no more than {} views agree with each other", views_.size()));
  result_.camera = camera_;
  result_.warp = warp_;
  result_.rms_px = Rms();
  result_.noise_factor = noise_factor_;
  result_.distinct_views = DistinctViews();
  double own_squares = 0;
  for (const UsedView& view : views_) {
    Describe(view);
    for (size_t k = 0; k < view.weight.size(); ++k)
      own_squares += view.weight[k] * input_.views[view.source].corners[k].covariance_px2.trace() / 2;
  }
  result_.corner_sigma_px = noise_factor_ * std::sqrt(own_squares / result_.corners);
  Judge(outcome);
  result_.seconds = stopwatch_.Seconds();
  return result_;
}

void CameraCalibrator::Judge(Outcome outcome) {
  result_.information = InformationOf(Whitened());
  const double sigma_px = std::sqrt(result_.information.covariance.diagonal().head<2>().maxCoeff());
  if (!(sigma_px <= kLargestFocalSigma * camera_.fx_px)) {
    result_.status = BoardCalibrationStatus::kUndetermined;
    result_.message = fmt::format(
        "the views tell the focal length to {:.0f} % only: tilt the board by 30 degrees and more against the "
        "image, to different sides",
        100 * sigma_px / camera_.fx_px);
  } else if (outcome != Outcome::kSettled) {
    result_.message = "the estimate did not settle: another lens model may fit better";
  } else if (options_.guess && (options_.guess->fx_px > kHopelessFactor * camera_.fx_px ||
                                options_.guess->fx_px * kHopelessFactor < camera_.fx_px)) {
    result_.status = BoardCalibrationStatus::kHopelessGuess;
    result_.message =
        fmt::format("the guess has a focal length of {:.6g} px, and the views lead to {:.6g} px",
                    options_.guess->fx_px, camera_.fx_px);
  } else {
    result_.status = BoardCalibrationStatus::kConverged;
  }
}

BoardCalibration CameraCalibrator::FromNothing() {
  if (views_.empty())
    return Failed(BoardCalibrationStatus::kTooFewViews,
                  fmt::format("no view shows {} or more corners of the board", kFewestViewCorners));
  const size_t distinct = static_cast<size_t>(DistinctViews());
  if (distinct < kFewestViews)
    return Failed(
        BoardCalibrationStatus::kTooFewViews,
        views_.size() > distinct
            ? fmt::format("{} views show the board in the same place, which is no more than {} does",
                          views_.size(), distinct == 1 ? "one" : "two")
            : fmt::format("{} view{} of the board cannot determine a camera", distinct,
                          distinct == 1 ? "" : "s"));
  const StraightenedViews straightened =
      Straighten(Observations(), input_.width_px, input_.height_px, options_.lens != LensModel::kPinhole);
  if (!HasFlatBoards(straightened)) return NotFlat();
  if (!Start(straightened))
    return Failed(BoardCalibrationStatus::kNotConverged, "no camera explains the views");
  warp_ = FlatOver(input_.points_in_board_m);
  return Result(Run());
}

BoardCalibration CameraCalibrator::From(const BoardCalibration& earlier) {
  Place(earlier);
  return Result(Run());
}

BoardProblem CameraCalibrator::SolvedBy(const BoardCalibration& solution) {
  Place(solution);
  noise_factor_ = solution.widening * solution.noise_factor;
  for (UsedView& view : views_) view.weight = solution.views[view.source].weight;
  BoardProblem problem = Whitened();
  problem.mean_square = 1 / (solution.widening * solution.widening);
  return problem;
}

}  // namespace

const char* ToString(BoardCalibrationStatus status) {
  switch (status) {
    case BoardCalibrationStatus::kConverged:
      return "converged";
    case BoardCalibrationStatus::kTooFewViews:
      return "too_few_views";
    case BoardCalibrationStatus::kNotFlat:
      return "not_flat";
    case BoardCalibrationStatus::kUndetermined:
      return "undetermined";
    case BoardCalibrationStatus::kHopelessGuess:
      return "hopeless_guess";
    case BoardCalibrationStatus::kNotConverged:
      return "not_converged";
  }
  return "unknown";
}

void BoardCalibrationOptions::Check() const {
  if (max_iterations < 1 || threads < 1)
    throw std::invalid_argument("max_iterations and threads must be at least 1");
}

BoardCalibration CalibrateCamera(const BoardCalibrationInput& input, const BoardCalibrationOptions& options) {
  options.Check();
  return CameraCalibrator(input, options).FromNothing();
}

BoardCalibration Widened(BoardCalibration calibration, double factor) {
  calibration.widening *= factor;
  calibration.information.information /= factor * factor;
  calibration.information.covariance *= factor * factor;
  return calibration;
}

BoardProblem SolvedProblem(const BoardCalibrationInput& input, const BoardCalibration& calibration,
                           const BoardCalibrationOptions& options) {
  return CameraCalibrator(input, options).SolvedBy(calibration);
}

BoardCalibration RefineCamera(const BoardCalibrationInput& input, const BoardCalibration& from,
                              const BoardCalibrationOptions& options) {
  options.Check();
  return CameraCalibrator(input, options).From(from);
}

}  // namespace legible
