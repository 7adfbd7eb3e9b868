#include "core/vision/leg_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vision/edge_band.h"
#include "core/vision/edge_curve.h"
#include "core/vision/edge_line.h"
#include "core/vision/edge_profile.h"
#include "core/vision/median.h"
#include "core/vision/rough_trace.h"

namespace legible {
namespace {

constexpr double kOutside_px = 6.5, kInside_px = 6;  // the fine band
constexpr double kBin_px = 0.125, kFineBins_px = 2.5;
constexpr double kLargestStretchSigma_px = 0.15;  // beyond, something else than shading disturbs the stretch
constexpr double kLargestRelativeSigma = 3;       // of a stretch, against the median stretch's
constexpr double kLeastStretchContrast = 12;      // grey levels, of the same sign as the whole edge's
constexpr double kLeastGreyNoise = 0.5;           // quantisation alone leaves 0.3
// Shading that no model here follows, as a step in brightness beside the edge (grey levels): it moves the
// place by its share of the contrast.
constexpr double kStretchMisfit = 1.5, kEdgeMisfit = 1.0;
constexpr double kFirstBlur_px = 0.75, kLastBlurStep_px = 0.05;
constexpr double kPlainBlurStep_px = 0.1, kFirstBlurStep_px = 0.15;
constexpr int kMostBlurRounds = 30;
constexpr const char* kNoEdge = "no edge in the brightness across it";

// One edge on its way through the stages.
struct Work {
  LegEdge* result = nullptr;
  const LegInCamera* leg = nullptr;
  PredictedEdge predicted;  // its points follow `normal`
  EdgeBand band;
  EdgeProfile profile;
  ProfileFitOptions fit_options;
  std::optional<ProfileFit> fit;

  bool Dropped() const { return !result->left_out.empty(); }
};

// ---- The fine stage: one profile of the whole edge, one blur of the whole image.

EdgeProfile ProfileOf(const EdgeBand& band, size_t first_cell, size_t last_cell) {
  return CoarserFarFromTheEdge(
      BinProfile(band, first_cell, last_cell, kOutside_px + 1, kInside_px + 1, kBin_px), kFineBins_px);
}

void CollectProfile(const GrayImage& image, double place_px, const LevelShape& shape, Work& work) {
  // A little wider than the window of the fit, whose centre moves with the place.
  work.band = CollectBand(image, work.predicted.points, kOutside_px + 1, kInside_px + 1);
  Flatten(work.band, place_px, shape);
  work.profile = ProfileOf(work.band, 0, work.band.cells.size());
}

void FitAt(double blur_px, Work& work) {
  work.fit_options.blur_px = blur_px;
  work.fit = FitSimplestModel(work.profile, 0, work.fit_options);
}

// Keeps the fit where a plain edge is not to be had.
void FitAsPlain(double blur_px, Work& work) {
  work.fit_options.blur_px = blur_px;
  if (const auto plain = FitProfile(work.profile, ShadingModel::kFlat, 0, work.fit_options)) work.fit = plain;
}

// Squares of all edges at a blur, each in proportion to how well its model fits it.
double SquaresAt(double blur_px, const std::vector<Work>& works) {
  double sum = 0;
  for (const Work& work : works) {
    if (work.Dropped() || !work.fit) continue;
    ProfileFitOptions options = work.fit_options;
    options.blur_px = std::max(blur_px, 0.1);
    sum += SquaresAtBlur(work.profile, *work.fit, options) / std::max(work.fit->chi2_per_bin, 1.0);
  }
  return sum;
}

// Towards the blur at which all edges together fit best, by the parabola through three neighbouring misfits.
double ImprovedBlur(double blur_px, double step_px, const std::vector<Work>& works) {
  const double low = SquaresAt(blur_px - step_px, works), mid = SquaresAt(blur_px, works),
               high = SquaresAt(blur_px + step_px, works);
  const double curvature = low - 2 * mid + high;
  const double steps = curvature <= 0 ? (low < high ? -1 : 1) : 0.5 * (low - high) / curvature;
  return std::clamp(blur_px + step_px * std::clamp(steps, -1.5, 1.5), 0.3, 4.0);
}

// ---- Samples: the place of each stretch, from its own profile.

// One stretch's place, with coefficients of its own: shading changes along a leg.
void SampleStretch(size_t first, size_t last, Work& work) {
  const BandCell& cell = work.band.cells[(first + last) / 2];
  const EdgeProfile profile = ProfileOf(work.band, first, last);
  ProfileFitOptions options = work.fit_options;
  options.half_width_px *= work.leg->AxisPoint(0.5).z() / work.leg->AxisPoint(cell.share).z();
  const auto fit = FitStretch(profile, *work.fit, options);
  if (!fit || fit->contrast * work.fit->contrast < kLeastStretchContrast * std::abs(work.fit->contrast))
    return;
  Eigen::Vector2d centre = cell.centre_px;
  if ((last - first) % 2 == 0)  // an even number of cells: their middle is the end of a cell
    centre = (centre + work.band.cells[(first + last) / 2 - 1].centre_px) / 2;
  const double sigma_px = std::hypot(fit->sigma_px, kStretchMisfit / fit->contrast);
  if (!(sigma_px <= kLargestStretchSigma_px)) return;
  work.result->observation.samples.push_back(
      {centre - fit->place_px * cell.normal_px, cell.normal_px, sigma_px});
}

// A stretch far less certain than the others is disturbed by something that no model here knows.
void DropDisturbedSamples(std::vector<EdgeSample>& samples) {
  if (samples.empty()) return;
  std::vector<double> sigmas;
  sigmas.reserve(samples.size());
  for (const EdgeSample& sample : samples) sigmas.push_back(sample.sigma_px);
  const double largest = kLargestRelativeSigma * MedianOf(std::move(sigmas));
  std::erase_if(samples, [&](const EdgeSample& sample) { return sample.sigma_px > largest; });
}

void Sample(const LegEdgeOptions& options, double length_px, Work& work) {
  work.result->observation = {work.result->leg, work.result->edge, {}, 0};
  for (const auto& [first, last] : Stretches(work.band, length_px, options.visibility.step_px))
    SampleStretch(first, last, work);
  DropDisturbedSamples(work.result->observation.samples);
  work.result->observation.common_sigma_px = std::hypot(work.fit->sigma_px, kEdgeMisfit / work.fit->contrast);
  work.result->contrast = work.fit->contrast;
  work.result->length_px = work.band.length_px;
}

void FitLine(const Camera& camera, Work& work) {
  EdgeLine line = FitEdgeLine(camera, work.predicted.normal, work.result->observation.samples);
  work.result->normal = line.normal;
  work.result->normal_covariance = line.normal_covariance;
  work.result->observation.samples = std::move(line.samples);
  work.result->rms_px = line.rms_px;
}

void Judge(const LegEdgeOptions& options, Work& work) {
  LegEdge& edge = *work.result;
  if (std::abs(edge.contrast) < options.least_contrast)
    edge.left_out = fmt::format("contrast of only {:.0f} grey levels", std::abs(edge.contrast));
  else if (!(edge.observation.common_sigma_px <= options.largest_common_sigma_px))
    edge.left_out =
        fmt::format("its shading leaves its place open by {:.2f} px", edge.observation.common_sigma_px);
  else if (edge.observation.samples.size() < 3)
    edge.left_out = "fewer than three stretches lie on one line";
}

class Measurement {
 public:
  Measurement(const GrayImage& image, const LegsInCamera& legs, const Camera& camera,
              const LegEdgeOptions& options)
      : image_(image), legs_(legs), camera_(camera), options_(options) {
    result_.edges.resize(2 * kLegCount);
    const PredictedEdges predicted = PredictEdges(legs, camera, options.visibility);
    for (int i = 0; i < 2 * kLegCount; ++i) {
      LegEdge& edge = result_.edges[static_cast<size_t>(i)];
      edge.leg = i / 2;
      edge.edge = i % 2;
      works_.push_back({&edge,
                        &legs_[static_cast<size_t>(i / 2)],
                        predicted[static_cast<size_t>(i / 2)][static_cast<size_t>(i % 2)],
                        {},
                        {},
                        {},
                        {}});
    }
    if (options.lock) Lock(predicted);
    for (Work& work : works_) CheckLength(work);
  }

  LegEdges Run() {
    for (Work& work : works_)
      if (!work.Dropped()) Trace(work);
    if (options_.rough_only) return std::move(result_);
    for (Work& work : works_)
      if (!work.Dropped()) CollectProfile(image_, 0, LevelShape(), work);
    result_.grey_noise = CommonGreyNoise();
    const double first_blur = options_.blur_px.value_or(kFirstBlur_px);
    for (Work& work : works_) FitFirst(first_blur, work);
    for (Work& work : works_) Recentre(work);
    result_.blur_px = options_.blur_px ? *options_.blur_px : FindBlur();
    for (Work& work : works_)
      if (!work.Dropped()) Finish(work);
    return std::move(result_);
  }

 private:
  void Lock(const PredictedEdges& predicted) {
    const auto locks = LockOnLegs(image_, predicted, *options_.lock);
    for (Work& work : works_) {
      const auto& lock = locks[static_cast<size_t>(work.result->leg)];
      if (!lock) {
        work.result->left_out = "no leg found near the prediction";
        continue;
      }
      // The lock's shift is towards edge 2: outward for that one, inward for edge 1.
      const double sign = work.result->edge == 1 ? 1 : -1;
      ShiftEnds(camera_, *work.leg, sign * lock->shift_at_a_px, sign * lock->shift_at_b_px, work.predicted);
    }
  }

  void Trace(Work& work) const {
    const auto trace = TraceRoughly(
        image_, work.predicted, {options_.search_px, options_.rough_bend_px, options_.visibility.step_px});
    if (!trace)
      work.result->left_out = "no straight edge near the prediction";
    else if (options_.rough_only)
      work.result->observation = {work.result->leg, work.result->edge, trace->samples, 0};
    else
      ShiftEnds(camera_, *work.leg, trace->at_a_px, trace->at_b_px, work.predicted);
  }

  void CheckLength(Work& work) const {
    if (work.Dropped()) return;
    if (work.predicted.points.empty())
      work.result->left_out = "not in front of the camera";
    else if (VisibleLength(work.predicted) < options_.least_length_px)
      work.result->left_out = MainObstacle(work.predicted);
  }

  double CommonGreyNoise() const {
    std::vector<double> noises;
    for (const Work& work : works_)
      if (!work.Dropped()) noises.push_back(GreyNoise(work.band));
    if (noises.empty()) return 0;
    return std::max(MedianOf(std::move(noises)), kLeastGreyNoise);
  }

  void FitFirst(double blur_px, Work& work) const {
    if (work.Dropped()) return;
    work.fit_options.half_width_px = std::max(work.predicted.half_width_px, 2.0);
    work.fit_options.grey_noise = result_.grey_noise;
    work.fit_options.outside_px = kOutside_px;
    work.fit_options.inside_px = std::min(kInside_px, 0.6 * work.fit_options.half_width_px);
    FitAt(blur_px, work);
    if (!work.fit) work.result->left_out = kNoEdge;
  }

  template <typename F>
  void ForEachFit(F refit) {
    for (Work& work : works_)
      if (!work.Dropped() && work.fit) refit(work);
  }

  // Improves the blur, the edges fitted again each time, by ever smaller steps.
  double Settle(double blur, double step, void (*refit)(double, Work&)) {
    ForEachFit([&](Work& work) { refit(blur, work); });
    for (int round = 0; round < kMostBlurRounds && step > kLastBlurStep_px; ++round) {
      const double before = blur;
      blur = ImprovedBlur(blur, step, works_);
      ForEachFit([&](Work& work) { refit(blur, work); });
      if (std::abs(blur - before) < step / 2) step *= 0.6;
    }
    return blur;
  }

  // In turn with the edges' models, for at a wrong blur a plain edge looks shaded; as if all were plain to
  // begin with, for a shaded edge's model would follow a wrong blur.
  double FindBlur() {
    if (!AnyLeft()) return 0;
    const double blur = Settle(kFirstBlur_px, kPlainBlurStep_px, FitAsPlain);
    return Settle(blur, kFirstBlurStep_px, FitAt);
  }

  bool AnyLeft() const {
    return std::any_of(works_.begin(), works_.end(), [](const Work& work) { return !work.Dropped(); });
  }

  // A band that lies askew to its edge would look blurred: lays it along the line through the first samples.
  void Recentre(Work& work) const {
    if (work.Dropped()) return;
    Sample(options_, 2 * options_.sample_length_px, work);
    FitLine(camera_, work);
    MoveTo(camera_, *work.leg, work.result->normal, work.predicted);
    // The samples moved the curve onto the edge.
    work.fit->place_px = 0;
    CollectProfile(image_, 0, LevelShape(*work.fit, work.fit_options), work);
    work.fit = FitProfile(work.profile, work.fit->model, 0, work.fit_options);
    if (!work.fit) work.result->left_out = kNoEdge;
  }

  void Finish(Work& work) const {
    if (!work.fit) {
      work.result->left_out = kNoEdge;
      return;
    }
    Sample(options_, options_.sample_length_px, work);
    FitLine(camera_, work);
    Judge(options_, work);
  }

  const GrayImage& image_;
  const LegsInCamera& legs_;
  const Camera& camera_;
  const LegEdgeOptions& options_;
  LegEdges result_;
  std::vector<Work> works_;
};

}  // namespace

void LegEdgeOptions::Check() const {
  if (!(search_px > 0) || !(least_length_px > 0) || !(sample_length_px > 0) || !(visibility.step_px > 0))
    throw std::invalid_argument("LegEdgeOptions: lengths must be positive");
  if (rough_bend_px < 0) throw std::invalid_argument("LegEdgeOptions: rough_bend_px must not be negative");
  if (lock) lock->Check();
}

LegEdges MeasureLegEdges(const GrayImage& image, const LegsInCamera& legs, const Camera& camera,
                         const LegEdgeOptions& options) {
  options.Check();
  return Measurement(image, legs, camera, options).Run();
}

ImageObservation ToObservation(const std::string& name, const std::optional<Vector6d>& joint_readings_m,
                               const LegEdges& edges) {
  ImageObservation observation{name, joint_readings_m, {}};
  for (const LegEdge& edge : edges.edges)
    if (edge.left_out.empty()) observation.edges.push_back(edge.observation);
  return observation;
}

}  // namespace legible
