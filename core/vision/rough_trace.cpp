#include "core/vision/rough_trace.h"

#include <cmath>

#include "core/vision/edge_band.h"

namespace legible {
namespace {

constexpr double kBin_px = 0.5, kStretch_px = 18;
constexpr double kTolerance_px = 0.9;  // of a stretch from the curve through the others
constexpr double kBendStep_px = 3;
constexpr int kFewestPlaces = 3;
constexpr double kLeastShare = 0.4;  // of the stretches that lie on the curve

struct RoughPlace {
  double share = 0;
  Eigen::Vector2d centre_px, normal_px;  // of the predicted curve there
  double outward_px = 0;
  double step = 0;  // grey levels over two bins, signed: positive where the leg is brighter
};

std::optional<RoughPlace> StrongestStep(const EdgeProfile& profile, const BandCell& middle) {
  RoughPlace best{middle.share, middle.centre_px, middle.normal_px, 0, 0};
  for (size_t i = 2; i + 2 < profile.size(); ++i) {
    if (profile[i - 2].count == 0 || profile[i - 1].count == 0 || profile[i].count == 0 ||
        profile[i + 1].count == 0)
      continue;
    const double step = (profile[i].brightness + profile[i + 1].brightness - profile[i - 1].brightness -
                         profile[i - 2].brightness) /
                        2;
    if (std::abs(step) <= std::abs(best.step)) continue;
    best.step = step;
    best.outward_px = -(profile[i].inside_px + profile[i - 1].inside_px) / 2;
  }
  if (best.step == 0) return std::nullopt;
  return best;
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
          curve.support += std::sqrt(std::abs(place.step));
          ++curve.count;
        }
        if (curve.support > best.support) best = curve;
      }
    }
  return best;
}

}  // namespace

std::optional<RoughTrace> TraceRoughly(const GrayImage& image, const PredictedEdge& edge,
                                       const RoughTraceOptions& options) {
  const double reach = options.search_px + 2;
  const EdgeBand band = CollectBand(image, edge.points, reach, reach);
  std::vector<RoughPlace> places;
  for (const auto& [first, last] : Stretches(band, kStretch_px, options.step_px)) {
    const EdgeProfile profile = BinProfile(band, first, last, reach, reach, kBin_px);
    if (const auto place = StrongestStep(profile, band.cells[(first + last) / 2])) places.push_back(*place);
  }
  const RoughCurve curve = Consensus(places, options.bend_px);
  if (curve.count < kFewestPlaces || curve.count < kLeastShare * static_cast<double>(places.size()))
    return std::nullopt;
  RoughTrace trace{curve.At(0), curve.At(1), {}};
  for (const RoughPlace& place : places)
    if (curve.Agrees(place))
      trace.samples.push_back(
          {place.centre_px + place.outward_px * place.normal_px, place.normal_px, kTolerance_px / 2});
  return trace;
}

}  // namespace legible
