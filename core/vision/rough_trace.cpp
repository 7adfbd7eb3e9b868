#include "core/vision/rough_trace.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/vision/edge_band.h"

namespace legible {
namespace {

constexpr double kBin_px = 0.5, kStretch_px = 18;
constexpr double kRim_px = 2;          // of the window, in which no step is told from its neighbours
constexpr double kTolerance_px = 0.9;  // of a stretch from the curve through the others
constexpr double kBendStep_px = 3;
constexpr int kFewestPlaces = 3;
constexpr double kLeastShare = 0.4;  // of the stretches that lie on the curve

struct RoughPlace {
  double share = 0;
  Eigen::Vector2d centre_px, normal_px;  // of the predicted curve there
  double outward_px = 0;
  double step = 0;    // grey levels, signed: positive where the leg is brighter
  double weight = 0;  // its square root
};

// A step between the pixels of the two bins before bin i and those of the two from it on. A pair of bins is a
// pixel wide: it holds pixels also where an edge runs along the image's rows or columns and every second bin
// is empty.
struct Step {
  double inside_px = 0;  // between the pixels' mean distances
  double grey = 0;       // by which the inner ones are brighter
};
std::optional<Step> StepAt(const BandBins& bins, size_t i) {
  const auto before = bins[i - 2].sums + bins[i - 1].sums, after = bins[i].sums + bins[i + 1].sums;
  const float count_before = bins[i - 2].count + bins[i - 1].count,
              count_after = bins[i].count + bins[i + 1].count;
  if (count_before == 0 || count_after == 0) return std::nullopt;
  return Step{(before[0] / count_before + after[0] / count_after) / 2,
              after[1] / count_after - before[1] / count_before};
}

// The strongest step that is no weaker than those a pixel to either side (shading grows steeper towards the
// window's end without an edge there), moved by the parabola through the three.
std::optional<RoughPlace> StrongestStep(const BandBins& bins, const BandCell& middle) {
  std::vector<std::optional<Step>> steps(bins.size());
  for (size_t i = 2; i + 2 < bins.size(); ++i) steps[i] = StepAt(bins, i);
  std::optional<RoughPlace> best;
  for (size_t i = 4; i + 4 < bins.size(); ++i) {
    if (!steps[i] || !steps[i - 2] || !steps[i + 2]) continue;
    const double before = std::abs(steps[i - 2]->grey), peak = std::abs(steps[i]->grey),
                 after = std::abs(steps[i + 2]->grey);
    if (peak < std::max(before, after) || (best && peak <= std::abs(best->step))) continue;
    const double curvature = 2 * peak - before - after;
    const double moved_px = curvature > 0 ? (after - before) / (2 * curvature) : 0;
    best = RoughPlace{middle.share,   middle.centre_px, middle.normal_px, -(steps[i]->inside_px + moved_px),
                      steps[i]->grey, std::sqrt(peak)};
  }
  return best && best->step != 0 ? best : std::nullopt;
}

// outward_px = at_a + slope * share + bend * share * (share - 1): the prediction's error along the leg.
struct RoughCurve {
  double at_a_px = 0, slope_px = 0, bend_px = 0;
  double polarity = 0;
  double support = 0;  // sum over the agreeing stretches of their step's square root
  int count = 0;

  double At(double share) const { return at_a_px + slope_px * share + bend_px * share * (share - 1); }
  bool Agrees(const RoughPlace& place) const {
    return place.step * polarity > 0 && std::abs(place.outward_px - At(place.share)) <= kTolerance_px;
  }
};

RoughCurve CurveThrough(const RoughPlace& a, const RoughPlace& b, double bend_px) {
  const auto straight = [&](const RoughPlace& p) { return p.outward_px - bend_px * p.share * (p.share - 1); };
  const double slope = (straight(b) - straight(a)) / (b.share - a.share);
  return {straight(a) - slope * a.share, slope, bend_px, a.step, 0, 0};
}

// The curve through two of the places, with a bend up to largest_bend_px, on which most of the contrast of
// one sign lies.
RoughCurve Consensus(const std::vector<RoughPlace>& places, double largest_bend_px) {
  RoughCurve best;
  for (size_t i = 0; i < places.size(); ++i)
    for (size_t j = i + 1; j < places.size(); ++j) {
      const RoughPlace &a = places[i], &b = places[j];
      if (b.share - a.share < 0.1 || a.step * b.step < 0) continue;
      for (double bend = -largest_bend_px; bend <= largest_bend_px; bend += kBendStep_px) {
        RoughCurve curve = CurveThrough(a, b, bend);
        for (const RoughPlace& place : places) {
          if (!curve.Agrees(place)) continue;
          curve.support += place.weight;
          ++curve.count;
        }
        if (curve.support > best.support) best = curve;
        if (best.count == static_cast<int>(places.size())) return best;
      }
    }
  return best;
}

// The curve of the same bend that lies closest to the places that agree with it, a strong step counting for
// more.
RoughCurve Settled(RoughCurve curve, const std::vector<RoughPlace>& places) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const RoughPlace& place : places) {
    if (!curve.Agrees(place)) continue;
    const Eigen::Vector2d row(1, place.share);
    information += std::abs(place.step) * row * row.transpose();
    moment += std::abs(place.step) * row * (place.outward_px - curve.At(place.share));
  }
  const Eigen::Vector2d change = information.inverse() * moment;
  curve.at_a_px += change[0];
  curve.slope_px += change[1];
  return curve;
}

}  // namespace

std::optional<RoughTrace> TraceRoughly(const GrayImage& image, const PredictedEdge& edge,
                                       const RoughTraceOptions& options) {
  // Beyond the leg's axis lies its other edge, which may be the stronger one.
  const double outside_px = options.search_px + kRim_px;
  const double inside_px = std::min(options.search_px, edge.half_width_px) + kRim_px;
  const EdgeBand band = CollectBand(image, edge.points, outside_px, inside_px);
  const BinGrid grid{outside_px, inside_px, kBin_px};
  std::vector<RoughPlace> places;
  for (const auto& [first, last] : Stretches(band, kStretch_px, options.step_px)) {
    const BandBins bins = BinBand(band, first, last, grid);
    if (const auto place = StrongestStep(bins, band.cells[(first + last) / 2])) places.push_back(*place);
  }
  const RoughCurve curve = Consensus(places, options.bend_px);
  if (curve.count < kFewestPlaces || curve.count < kLeastShare * static_cast<double>(places.size()))
    return std::nullopt;
  const RoughCurve settled = Settled(curve, places);
  RoughTrace trace{settled.At(0), settled.At(1), {}, 0};
  for (const RoughPlace& place : places) {
    if (!curve.Agrees(place)) continue;
    trace.samples.push_back(
        {place.centre_px + place.outward_px * place.normal_px, place.normal_px, kTolerance_px / 2});
    trace.contrast += place.step / curve.count;
  }
  return trace;
}

}  // namespace legible
