#include "core/vision/edge_band.h"

#include <algorithm>
#include <cmath>

#include "core/vision/median.h"

namespace legible {
namespace {

// Where brightness is read for flattening, clear of the blurred edge itself (px inside).
constexpr double kBackgroundFrom = -5, kBackgroundTo = -2, kLegFrom = 1.5, kLegTo = 6;
constexpr double kLeastRelativeContrast = 0.3;  // of a cell, against the median cell's
constexpr double kLargestRelativeJump =
    0.12;  // of brightness from one neighbour cell to the other, against the contrast
constexpr double kLargestJump = 3;  // grey levels: less is noise
constexpr size_t kFewestPixels = 4;

// x range in a row within which |along| <= half_length and -inside <= outward <= outside.
struct Span {
  double low, high;
  void Clip(double slope, double at_zero, double least, double most) {
    // least <= slope x + at_zero <= most
    if (std::abs(slope) < 1e-12) {
      if (at_zero < least || at_zero > most) high = low - 1;
      return;
    }
    const double a = (least - at_zero) / slope, b = (most - at_zero) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
};

void CollectCell(const GrayImage& image, const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                 double outside_px, double inside_px, const BandCell& cell, std::vector<BandPixel>& pixels) {
  const Eigen::Vector2d tangent = (end - start).normalized();
  const double half_length = (end - start).norm() / 2;
  const double reach = half_length * std::abs(tangent.y()) + std::max(outside_px, inside_px);
  const int top = std::max(0, static_cast<int>(std::ceil(cell.centre_px.y() - reach)));
  const int bottom = std::min(image.height - 1, static_cast<int>(std::floor(cell.centre_px.y() + reach)));
  for (int y = top; y <= bottom; ++y) {
    const double dy = y - cell.centre_px.y();
    Span span{0.0 - cell.centre_px.x(), image.width - 1 - cell.centre_px.x()};
    span.Clip(tangent.x(), tangent.y() * dy, -half_length, half_length);
    span.Clip(cell.normal_px.x(), cell.normal_px.y() * dy, -inside_px, outside_px);
    const int from = static_cast<int>(std::ceil(span.low + cell.centre_px.x()));
    const int to = static_cast<int>(std::floor(span.high + cell.centre_px.x()));
    if (from > to) continue;
    const size_t first = pixels.size();
    pixels.resize(first + static_cast<size_t>(to - from + 1));
    const auto at_first =
        static_cast<float>(-cell.normal_px.dot(Eigen::Vector2d(from - cell.centre_px.x(), dy)));
    const auto step = static_cast<float>(-cell.normal_px.x());
    const std::uint8_t* row = image.Row(y) + from;
    for (int i = 0; i <= to - from; ++i)
      pixels[first + static_cast<size_t>(i)] = {at_first + static_cast<float>(i) * step,
                                                static_cast<float>(row[i])};
  }
}

// Mean brightness over part of a cell.
struct Level {
  double sum = 0;
  double count = 0;
  void Add(double value) {
    sum += value;
    count += 1;
  }
  void Add(const Level& other, double weight) {
    sum += weight * other.sum;
    count += weight * other.count;
  }
  double Mean() const { return count > 0 ? sum / count : 0; }
};

struct Levels {
  Level background, leg;
  double Contrast() const { return leg.Mean() - background.Mean(); }
  bool IsMeasured() const {
    return background.count >= static_cast<double>(kFewestPixels) &&
           leg.count >= static_cast<double>(kFewestPixels);
  }
};

Levels LevelsOf(const EdgeBand& band, const BandCell& cell, double place_px) {
  Levels levels;
  for (size_t i = cell.first; i < cell.last; ++i) {
    const double x = band.pixels[i].inside_px - place_px;
    if (x >= kBackgroundFrom && x <= kBackgroundTo) levels.background.Add(band.pixels[i].brightness);
    if (x >= kLegFrom && x <= kLegTo) levels.leg.Add(band.pixels[i].brightness);
  }
  return levels;
}

// Where the background or the leg changes within a few pixels along the edge (the horizon behind it, a
// shadow's border across it), it changes across the edge as well, unseen.
bool JumpsAt(const EdgeBand& band, const std::vector<Levels>& levels, size_t i, double largest) {
  const size_t before = i > 0 && band.cells[i].follows_previous ? i - 1 : i;
  const size_t after = i + 1 < levels.size() && band.cells[i + 1].follows_previous ? i + 1 : i;
  return std::abs(levels[after].background.Mean() - levels[before].background.Mean()) > largest ||
         std::abs(levels[after].leg.Mean() - levels[before].leg.Mean()) > largest;
}

// Drops what is not a plain stretch of the leg's edge: contrast missing or reversed, or brightness that
// jumps.
void DropUnevenCells(EdgeBand& band, std::vector<Levels>& levels) {
  std::vector<double> contrasts;
  contrasts.reserve(levels.size());
  for (const Levels& of_cell : levels) contrasts.push_back(of_cell.Contrast());
  const double typical = MedianOf(contrasts);
  const double largest_jump = std::max(kLargestRelativeJump * std::abs(typical), kLargestJump);
  std::vector<BandCell> kept;
  std::vector<Levels> kept_levels;
  bool previous_kept = false;
  for (size_t i = 0; i < band.cells.size(); ++i) {
    const bool has_contrast = levels[i].Contrast() * typical > kLeastRelativeContrast * typical * typical;
    const bool keep = levels[i].IsMeasured() && has_contrast && !JumpsAt(band, levels, i, largest_jump);
    if (keep) {
      kept.push_back(band.cells[i]);
      kept.back().follows_previous &= previous_kept;
      kept_levels.push_back(levels[i]);
    }
    previous_kept = keep;
  }
  band.cells = std::move(kept);
  levels = std::move(kept_levels);
}

// Each cell's levels averaged with its neighbours' (1 2 1).
std::vector<Levels> Smoothed(const std::vector<BandCell>& cells, const std::vector<Levels>& levels) {
  std::vector<Levels> smooth = levels;
  const auto add = [&](size_t to, size_t from, double weight) {
    smooth[to].background.Add(levels[from].background, weight);
    smooth[to].leg.Add(levels[from].leg, weight);
  };
  for (size_t i = 0; i < cells.size(); ++i) {
    add(i, i, 1);
    if (!cells[i].follows_previous || i == 0) continue;
    add(i, i - 1, 1);
    add(i - 1, i, 1);
  }
  return smooth;
}

constexpr double kLeastLevel = 5;  // grey levels: below, nothing is in proportion to it
constexpr double kTableFrom_px = -10, kTableTo_px = 10, kTableStep_px = 1.0 / 8;

std::vector<double> TablePlaces() {
  std::vector<double> places;
  for (double x = kTableFrom_px; x <= kTableTo_px; x += kTableStep_px) places.push_back(x);
  return places;
}

}  // namespace

LevelShape::LevelShape() {
  for (const double x : TablePlaces()) {
    const auto leg = static_cast<float>(1 / (1 + std::exp(-1.7 * x)));
    table_.push_back({1 - leg, leg});
  }
}

LevelShape::LevelShape(const ProfileFit& fit, const ProfileFitOptions& options) {
  const std::vector<double> places = TablePlaces();
  const std::vector<BrightnessParts> parts = PredictParts(fit, places, options);
  // Against the mean over the distances from which levels are read.
  Level background, leg;
  for (size_t i = 0; i < places.size(); ++i) {
    const double x = places[i] - fit.place_px;
    if (x >= kBackgroundFrom && x <= kBackgroundTo) background.Add(parts[i].background);
    if (x >= kLegFrom && x <= kLegTo) leg.Add(parts[i].leg);
  }
  if (std::min(std::abs(background.Mean()), std::abs(leg.Mean())) < kLeastLevel) {
    *this = LevelShape();
    return;
  }
  for (const BrightnessParts& at : parts)
    table_.push_back(
        {static_cast<float>(at.background / background.Mean()), static_cast<float>(at.leg / leg.Mean())});
}

LevelShape::Shares LevelShape::At(float inside_px) const {
  const float position =
      (inside_px - static_cast<float>(kTableFrom_px)) * static_cast<float>(1 / kTableStep_px) + 0.5f;
  return table_[static_cast<size_t>(std::clamp(position, 0.0f, static_cast<float>(table_.size() - 1)))];
}

EdgeBand CollectBand(const GrayImage& image, const std::vector<PredictedEdgePoint>& curve, double outside_px,
                     double inside_px) {
  EdgeBand band;
  bool previous = false;
  for (size_t i = 0; i + 1 < curve.size(); ++i) {
    const PredictedEdgePoint &a = curve[i], &b = curve[i + 1];
    const bool visible = a.obstacle == EdgeObstacle::kNone && b.obstacle == EdgeObstacle::kNone;
    if (visible) {
      BandCell cell{
          (a.share + b.share) / 2, (a.point_px + b.point_px) / 2, {}, previous, band.pixels.size(), 0};
      const Eigen::Vector2d chord = (b.point_px - a.point_px).normalized();
      cell.normal_px = Eigen::Vector2d(-chord.y(), chord.x());
      if (cell.normal_px.dot(a.normal_px) < 0) cell.normal_px = -cell.normal_px;
      CollectCell(image, a.point_px, b.point_px, outside_px, inside_px, cell, band.pixels);
      cell.last = band.pixels.size();
      band.cells.push_back(cell);
      band.length_px += (b.point_px - a.point_px).norm();
    }
    previous = visible;
  }
  return band;
}

void Flatten(EdgeBand& band, double place_px, const LevelShape& shape) {
  if (band.cells.empty()) return;
  std::vector<Levels> levels;
  for (const BandCell& cell : band.cells) levels.push_back(LevelsOf(band, cell, place_px));
  DropUnevenCells(band, levels);
  if (band.cells.empty()) return;
  Levels all;
  for (const Levels& of_cell : levels) {
    all.background.Add(of_cell.background, 1);
    all.leg.Add(of_cell.leg, 1);
  }
  const std::vector<Levels> smooth = Smoothed(band.cells, levels);
  for (size_t i = 0; i < band.cells.size(); ++i) {
    const auto background = static_cast<float>(smooth[i].background.Mean() - all.background.Mean());
    const auto leg = static_cast<float>(smooth[i].leg.Mean() - all.leg.Mean());
    for (size_t p = band.cells[i].first; p < band.cells[i].last; ++p) {
      const LevelShape::Shares shares = shape.At(band.pixels[p].inside_px);
      band.pixels[p].brightness -= background * shares.background + leg * shares.leg;
    }
  }
}

EdgeProfile BinProfile(const EdgeBand& band, size_t first_cell, size_t last_cell, double outside_px,
                       double inside_px, double width_px) {
  EdgeProfile profile(static_cast<size_t>(std::ceil((outside_px + inside_px) / width_px)));
  const double per_px = 1 / width_px, bins = static_cast<double>(profile.size());
  for (size_t c = first_cell; c < last_cell; ++c)
    for (size_t i = band.cells[c].first; i < band.cells[c].last; ++i) {
      const BandPixel& pixel = band.pixels[i];
      const double position = (pixel.inside_px + outside_px) * per_px;
      if (position < 0 || position >= bins) continue;
      ProfileBin& bin = profile[static_cast<size_t>(position)];
      bin.inside_px += pixel.inside_px;
      bin.brightness += pixel.brightness;
      bin.count += 1;
    }
  for (ProfileBin& bin : profile) {
    if (bin.count == 0) continue;
    bin.inside_px /= bin.count;
    bin.brightness /= bin.count;
  }
  return profile;
}

EdgeProfile CoarserFarFromTheEdge(const EdgeProfile& profile, double fine_px) {
  constexpr int kTogether = 4;
  EdgeProfile coarser;
  int in_group = kTogether;
  for (const ProfileBin& bin : profile) {
    if (bin.count == 0) continue;
    if (std::abs(bin.inside_px) < fine_px || in_group == kTogether) {
      coarser.push_back(bin);
      in_group = std::abs(bin.inside_px) < fine_px ? kTogether : 1;
      continue;
    }
    ProfileBin& group = coarser.back();
    const double count = group.count + bin.count;
    group.inside_px += (bin.inside_px - group.inside_px) * bin.count / count;
    group.brightness += (bin.brightness - group.brightness) * bin.count / count;
    group.count = count;
    ++in_group;
  }
  return coarser;
}

std::vector<std::pair<size_t, size_t>> Stretches(const EdgeBand& band, double length_px, double step_px) {
  const double cells = std::max(1.0, length_px / step_px);
  std::vector<std::pair<size_t, size_t>> stretches;
  for (size_t first = 0, last = 0; first < band.cells.size(); first = last) {
    last = first + 1;
    while (last < band.cells.size() && band.cells[last].follows_previous) ++last;
    const auto run = static_cast<double>(last - first);
    const auto parts = static_cast<size_t>(std::max(1.0, std::round(run / cells)));
    for (size_t i = 0; i < parts; ++i)
      stretches.emplace_back(first + i * (last - first) / parts, first + (i + 1) * (last - first) / parts);
  }
  return stretches;
}

double GreyNoise(const EdgeBand& band) {
  std::vector<double> variances;
  for (const BandCell& cell : band.cells) {
    const Level mean = LevelsOf(band, cell, 0).background;
    if (mean.count < 8) continue;
    double squares = 0;
    for (size_t i = cell.first; i < cell.last; ++i) {
      const double x = band.pixels[i].inside_px;
      if (x >= kBackgroundFrom && x <= kBackgroundTo)
        squares += std::pow(band.pixels[i].brightness - mean.Mean(), 2);
    }
    variances.push_back(squares / (mean.count - 1));
  }
  return variances.empty() ? 0 : std::sqrt(MedianOf(variances));
}

}  // namespace legible
