#include "calib/board/board_calibration.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calib/board/board_start.h"
#include "calib/board/corner_noise.h"
#include "calib/robust_weights.h"
#include "core/stopwatch.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr size_t kFewestCorners = 6;  // of a view: four fix its pose and leave nothing to check
constexpr size_t kFewestViews = 3;    // that differ: two leave the principal point open
constexpr size_t kViewsOfRoughSolve = 24;
constexpr double kOutlierOfStart = 8;        // times the median error: takes no part in the first solve
constexpr double kSameView = 5e-3;           // of the image's diagonal: views whose corners differ by less
constexpr double kLargestUnevenness = 0.06;  // of the distance of neighbouring corners
constexpr double kLargestFocalSigma = 0.05;  // of the focal length
constexpr double kHopelessFactor = 2;        // by which a guessed focal length may be off
constexpr int kMaxRounds = 20;
constexpr double kSteadyScale = 1e-4;   // relative change of the noise at which the rounds end
constexpr double kSteadyWeight = 1e-5;  // mean absolute change of the weights at which they end

// The whitening of a corner at a weight and a noise.
Eigen::Matrix2d Scaled(const Eigen::Matrix2d& whitening, double weight, double noise_factor) {
  return std::sqrt(weight) / noise_factor * whitening;
}

// The views with the most corners, from all over the sequence.
std::vector<size_t> ViewsOfRoughSolve(const std::vector<ViewObservation>& views) {
  std::vector<size_t> order;
  const size_t stride = std::max<size_t>(1, views.size() / kViewsOfRoughSolve);
  for (size_t first = 0; first < stride; ++first)
    for (size_t i = first; i < views.size(); i += stride) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return views[a].pixels.size() > views[b].pixels.size(); });
  order.resize(std::min(order.size(), kViewsOfRoughSolve));
  return order;
}

// Distances of the corners from where the model has them, px; infinite for a view it cannot produce.
std::vector<double> DistancesOf(const Camera& camera, const BoardWarp& warp, ViewObservation view) {
  view.whitening_per_px.assign(view.pixels.size(), Eigen::Matrix2d::Identity());
  const auto errors = ViewErrors(camera, warp, view, Vector6d::Zero());
  std::vector<double> distances(view.pixels.size(), std::numeric_limits<double>::infinity());
  for (size_t k = 0; errors && k < distances.size(); ++k)
    distances[k] = errors->segment<2>(2 * static_cast<Eigen::Index>(k)).norm();
  return distances;
}

double MedianDistance(const BoardProblem& problem) {
  std::vector<double> all;
  for (const ViewObservation& view : problem.views) {
    const std::vector<double> distances = DistancesOf(problem.camera, problem.warp, view);
    all.insert(all.end(), distances.begin(), distances.end());
  }
  return MedianOf(all);
}

// Takes what is far off by the median's measure out of a problem that has only been started.
void LeaveOutGross(BoardProblem& problem) {
  for (ViewObservation& view : problem.views) {
    const std::vector<double> distances = DistancesOf(problem.camera, problem.warp, view);
    const double limit = kOutlierOfStart * MedianOf(distances);
    for (size_t k = 0; k < distances.size(); ++k)
      view.whitening_per_px[k] = (distances[k] <= limit ? 1.0 : 0.0) * Eigen::Matrix2d::Identity();
  }
}

// A solve that need not be good: a few views, a few steps, gross errors left out.
BoardProblem RoughlySolved(BoardProblem problem, int iterations) {
  LeaveOutGross(problem);
  BoardSolveOptions solve;
  solve.max_iterations = iterations;
  solve.relative_tolerance = 1e-4;
  SolveBoard(problem, solve);
  return problem;
}

// Whether the corners do not span the board's plane, or the image's.
bool AreOnOneLine(const ViewObservation& view) {
  constexpr double kLeastWidth = 0.02;  // of the length
  const Eigen::Index count = static_cast<Eigen::Index>(view.pixels.size());
  Eigen::MatrixX2d on_board(count, 2), in_image(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    on_board.row(k) = view.points_in_board_m[static_cast<size_t>(k)].head<2>();
    in_image.row(k) = view.pixels[static_cast<size_t>(k)];
  }
  const auto is_narrow = [](Eigen::MatrixX2d points) {
    points.rowwise() -= points.colwise().mean();
    const Eigen::Vector2d widths = points.jacobiSvd().singularValues();
    return !(widths[1] > kLeastWidth * widths[0]);
  };
  return is_narrow(on_board) || is_narrow(in_image);
}

// Whether two views show the same corners in the same places.
bool AreSame(const BoardView& a, const BoardView& b, double tolerance_px) {
  if (a.corners.size() != b.corners.size()) return false;
  double squares = 0;
  for (size_t k = 0; k < a.corners.size(); ++k) {
    if (a.corners[k].point != b.corners[k].point) return false;
    squares += (a.corners[k].pixel - b.corners[k].pixel).squaredNorm();
  }
  return squares <= tolerance_px * tolerance_px * static_cast<double>(a.corners.size());
}

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
  void AddView(size_t view);
  size_t DistinctViews() const;
  bool Start(const StraightenedViews& straightened);
  bool HasFlatBoards(const StraightenedViews& straightened) const;
  void Report(const char* stage, int iteration, double rms_px) const {
    if (options_.progress) options_.progress(stage, iteration, rms_px);
  }
  void Place(const BoardCalibration& earlier);
  void Whiten();
  bool Run();
  BoardSolveSummary Solve();
  bool Evaluate();
  bool Reweight(bool by_median);
  double NoiseBySquares() const;
  double Rms() const;
  BoardCalibration Failed(BoardCalibrationStatus status, const std::string& message);
  BoardCalibration Result(bool settled);
  void Judge(bool settled);

  const BoardCalibrationInput& input_;
  const BoardCalibrationOptions& options_;
  const Stopwatch stopwatch_;
  BoardProblem problem_;                                     // of the views that have a part
  std::vector<size_t> source_;                               // which of the input these are
  std::vector<std::vector<Eigen::Matrix2d>> own_whitening_;  // of their corners, by their own covariances
  std::vector<std::vector<double>> weights_;
  std::vector<std::vector<Eigen::Vector2d>> errors_px_;
  double noise_factor_ = 1;
  BoardCalibration result_;
};

void CameraCalibrator::AddView(size_t view) {
  const BoardView& seen = input_.views[view];
  if (seen.corners.size() < kFewestCorners) {
    result_.views[view].left_out =
        fmt::format("shows {} corners of the board, fewer than {}", seen.corners.size(), kFewestCorners);
    return;
  }
  ViewObservation observation;
  std::vector<Eigen::Matrix2d> whitening;
  for (const BoardCorner& corner : seen.corners) {
    observation.points_in_board_m.push_back(input_.points_in_board_m.at(static_cast<size_t>(corner.point)));
    observation.pixels.push_back(corner.pixel);
    whitening.push_back(WhiteningOf(corner.covariance_px2));
  }
  observation.whitening_per_px.assign(seen.corners.size(), Eigen::Matrix2d::Identity());
  if (AreOnOneLine(observation)) {
    result_.views[view].left_out = "shows corners on one line of the board only";
    return;
  }
  problem_.views.push_back(observation);
  source_.push_back(view);
  own_whitening_.push_back(whitening);
  weights_.emplace_back(seen.corners.size(), 1.0);
  errors_px_.emplace_back(seen.corners.size(), Eigen::Vector2d::Zero());
}

size_t CameraCalibrator::DistinctViews() const {
  const double tolerance_px = kSameView * std::hypot(input_.width_px, input_.height_px);
  std::vector<size_t> distinct;
  for (size_t view : source_)
    if (std::none_of(distinct.begin(), distinct.end(), [&](size_t other) {
          return AreSame(input_.views[view], input_.views[other], tolerance_px);
        }))
      distinct.push_back(view);
  return distinct.size();
}

bool CameraCalibrator::HasFlatBoards(const StraightenedViews& straightened) const {
  std::vector<double> shares;
  for (size_t i = 0; i < problem_.views.size(); ++i)
    if (const auto& view = straightened.views[i])
      shares.push_back(view->median_error * straightened.unit_px / NeighbourDistance_px(problem_.views[i]));
  return !shares.empty() && MedianOf(shares) <= kLargestUnevenness;
}

// Several focal lengths, each roughly solved on some views; the one that leaves least is taken for all.
bool CameraCalibrator::Start(const StraightenedViews& straightened) {
  std::vector<double> focal_lengths = {0.35, 0.6, 1, 1.7, 3, 6, 12};  // 141 to 10 degrees across the diagonal
  if (const auto zhang = FocalLengthOf(straightened)) focal_lengths.push_back(*zhang);
  if (options_.guess) focal_lengths.push_back(options_.guess->fx_px / straightened.unit_px);
  const std::vector<size_t> some = ViewsOfRoughSolve(problem_.views);
  std::optional<BoardProblem> best;
  double least = std::numeric_limits<double>::infinity();
  for (double focal_length : focal_lengths) {
    const BoardProblem all = ProblemAt(straightened, focal_length, options_.lens, input_.width_px,
                                       input_.height_px, problem_.views);
    BoardProblem few = all;
    few.views.clear();
    for (size_t i : some) few.views.push_back(all.views[i]);
    few = RoughlySolved(few, 15);
    const double error = MedianDistance(few);
    Report("looking for a start", 0, error);
    if (!(error < least) || !(few.camera.fx_px > 0) || !(few.camera.fy_px > 0)) continue;
    least = error;
    best = all;
    best->camera = few.camera;
    for (size_t k = 0; k < some.size(); ++k) best->views[some[k]] = few.views[k];
  }
  if (!best) return false;
  problem_.camera = best->camera;
  // The poses of all views under that camera: by their homographies under its focal length, then fitted.
  const BoardProblem at_last = ProblemAt(straightened, best->camera.fx_px / straightened.unit_px,
                                         options_.lens, input_.width_px, input_.height_px, problem_.views);
  for (size_t i = 0; i < problem_.views.size(); ++i)
    problem_.views[i].camera_from_board = at_last.views[i].camera_from_board;
  for (size_t i : some) problem_.views[i].camera_from_board = best->views[i].camera_from_board;
  problem_ = RoughlySolved(problem_, 15);
  return true;
}

void CameraCalibrator::Whiten() {
  for (size_t i = 0; i < problem_.views.size(); ++i)
    for (size_t k = 0; k < weights_[i].size(); ++k)
      problem_.views[i].whitening_per_px[k] = Scaled(own_whitening_[i][k], weights_[i][k], noise_factor_);
}

BoardSolveSummary CameraCalibrator::Solve() {
  Whiten();
  BoardSolveOptions solve;
  solve.max_iterations = options_.max_iterations;
  solve.threads = options_.threads;
  if (options_.progress)
    solve.progress = [this, rms_px = Rms(), first = 0.0](int iteration, double cost) mutable {
      if (iteration == 0) first = cost;
      Report("estimating", result_.iterations + iteration,
             first > 0 ? rms_px * std::sqrt(cost / first) : rms_px);
    };
  const BoardSolveSummary summary = SolveBoard(problem_, solve);
  result_.iterations += summary.iterations;
  return summary;
}

// False where the model cannot be evaluated any more.
bool CameraCalibrator::Evaluate() {
  for (size_t i = 0; i < problem_.views.size(); ++i) {
    ViewObservation view = problem_.views[i];
    view.whitening_per_px.assign(view.pixels.size(), Eigen::Matrix2d::Identity());
    const auto errors = ViewErrors(problem_.camera, problem_.warp, view, Vector6d::Zero());
    if (!errors) return false;
    for (size_t k = 0; k < view.pixels.size(); ++k)
      errors_px_[i][k] = errors->segment<2>(2 * static_cast<Eigen::Index>(k));
  }
  return true;
}

// The factor on the corners' own sigmas that the weighted residuals show.
double CameraCalibrator::NoiseBySquares() const {
  double squares = 0, weights = 0;
  for (size_t i = 0; i < errors_px_.size(); ++i)
    for (size_t k = 0; k < errors_px_[i].size(); ++k) {
      squares += weights_[i][k] * (own_whitening_[i][k] * errors_px_[i][k]).squaredNorm();
      weights += weights_[i][k];
    }
  const double unknowns = problem_.CameraUnknowns() + 6 * static_cast<double>(problem_.views.size()) +
                          (problem_.estimates_warp ? 2 : 0);
  const double freedom = 2 * weights - unknowns;
  const double cut_off = options_.trusts_all ? 1 : CutOffInPlane();
  return freedom > 0 ? std::sqrt(squares / freedom / cut_off) : 0;
}

// Updates noise and weights; true once they stand still.
bool CameraCalibrator::Reweight(bool by_median) {
  const double before = noise_factor_;
  std::vector<double> squares;
  for (size_t i = 0; i < errors_px_.size(); ++i)
    for (size_t k = 0; k < errors_px_[i].size(); ++k)
      squares.push_back((own_whitening_[i][k] * errors_px_[i][k]).squaredNorm());
  noise_factor_ = by_median ? std::sqrt(MedianOf(squares) / kMedianSquareInPlane) : NoiseBySquares();
  noise_factor_ = std::max(noise_factor_, 1e-9);  // exact data
  double change = 0;
  size_t at = 0;
  for (std::vector<double>& weights : weights_)
    for (double& weight : weights) {
      const double now = options_.trusts_all ? 1 : RobustWeight(std::sqrt(squares[at++]) / noise_factor_);
      change += std::abs(now - weight);
      weight = now;
    }
  return !by_median && std::abs(noise_factor_ - before) <= kSteadyScale * noise_factor_ &&
         change <= kSteadyWeight * static_cast<double>(squares.size());
}

// Rounds of least squares and re-weighting; whether they settled.
bool CameraCalibrator::Run() {
  if (!Evaluate()) return false;
  Reweight(true);
  for (int round = 0; round < kMaxRounds; ++round) {
    const BoardSolveSummary summary = Solve();
    if (!Evaluate()) return false;
    const bool steady = Reweight(round == 0 && !options_.trusts_all);
    if (summary.converged && (steady || options_.trusts_all)) return true;
  }
  return false;
}

double CameraCalibrator::Rms() const {
  double squares = 0, weights = 0;
  for (size_t i = 0; i < errors_px_.size(); ++i)
    for (size_t k = 0; k < errors_px_[i].size(); ++k) {
      squares += weights_[i][k] * errors_px_[i][k].squaredNorm();
      weights += weights_[i][k];
    }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

BoardCalibration CameraCalibrator::Failed(BoardCalibrationStatus status, const std::string& message) {
  result_.status = status;
  result_.message = message;
  result_.seconds = stopwatch_.Seconds();
  return result_;
}

BoardCalibration CameraCalibrator::Result(bool settled) {
  result_.camera = problem_.camera;
  result_.warp = problem_.warp;
  result_.rms_px = Rms();
  result_.noise_factor = noise_factor_;
  for (size_t i = 0; i < source_.size(); ++i) {
    ViewFit& view = result_.views[source_[i]];
    view.camera_from_board = problem_.views[i].camera_from_board;
    view.residual_px = errors_px_[i];
    view.weight = weights_[i];
    double squares = 0, weights = 0;
    for (size_t k = 0; k < weights_[i].size(); ++k) {
      squares += weights_[i][k] * errors_px_[i][k].squaredNorm();
      weights += weights_[i][k];
      if (weights_[i][k] == 0) ++result_.corners_left_out;
    }
    view.rms_px = weights > 0 ? std::sqrt(squares / weights) : 0;
    result_.corners += weights;
  }
  Whiten();
  Judge(settled);
  result_.seconds = stopwatch_.Seconds();
  return result_;
}

void CameraCalibrator::Judge(bool settled) {
  result_.information = InformationOf(problem_);
  const Camera& camera = problem_.camera;
  const double sigma_px = std::sqrt(result_.information.covariance.diagonal().head<2>().maxCoeff());
  if (!(sigma_px <= kLargestFocalSigma * camera.fx_px)) {
    result_.status = BoardCalibrationStatus::kUndetermined;
    result_.message = fmt::format(
        "the views tell the focal length to {:.0f} % only: tilt the board by 30 degrees and more against the "
        "image, to different sides",
        100 * sigma_px / camera.fx_px);
  } else if (!settled) {
    result_.message = "the estimate did not settle";
  } else if (options_.guess && (options_.guess->fx_px > kHopelessFactor * camera.fx_px ||
                                options_.guess->fx_px * kHopelessFactor < camera.fx_px)) {
    result_.status = BoardCalibrationStatus::kHopelessGuess;
    result_.message =
        fmt::format("the guess has a focal length of {:.6g} px, and the views lead to {:.6g} px",
                    options_.guess->fx_px, camera.fx_px);
  } else {
    result_.status = BoardCalibrationStatus::kConverged;
  }
}

BoardCalibration CameraCalibrator::FromNothing() {
  if (problem_.views.empty())
    return Failed(BoardCalibrationStatus::kTooFewViews,
                  fmt::format("no view shows {} or more corners of the board", kFewestCorners));
  const size_t distinct = DistinctViews();
  if (distinct < kFewestViews)
    return Failed(
        BoardCalibrationStatus::kTooFewViews,
        problem_.views.size() > distinct
            ? fmt::format("{} views show the board in the same place, which is no more than {} does",
                          problem_.views.size(), distinct == 1 ? "one" : "two")
            : fmt::format("{} view{} of the board cannot determine a camera", distinct,
                          distinct == 1 ? "" : "s"));
  const StraightenedViews straightened =
      Straighten(problem_.views, input_.width_px, input_.height_px, options_.lens != LensModel::kPinhole);
  if (!HasFlatBoards(straightened))
    return Failed(BoardCalibrationStatus::kNotFlat, "the corners do not lie to each other as on the board");
  if (!Start(straightened))
    return Failed(BoardCalibrationStatus::kNotConverged, "no camera explains the views");
  problem_.warp = FlatOver(input_.points_in_board_m);
  problem_.estimates_warp = options_.estimates_warp;
  return Result(Run());
}

void CameraCalibrator::Place(const BoardCalibration& earlier) {
  problem_.camera = earlier.camera;
  problem_.warp = earlier.warp;
  problem_.estimates_warp = options_.estimates_warp;
  for (size_t i = 0; i < source_.size(); ++i)
    problem_.views[i].camera_from_board = earlier.views.at(source_[i]).camera_from_board;
}

BoardCalibration CameraCalibrator::From(const BoardCalibration& earlier) {
  Place(earlier);
  return Result(Run());
}

BoardProblem CameraCalibrator::SolvedBy(const BoardCalibration& solution) {
  Place(solution);
  noise_factor_ = solution.noise_factor;
  for (size_t i = 0; i < source_.size(); ++i) weights_[i] = solution.views[source_[i]].weight;
  Whiten();
  return problem_;
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
