#include "core/vision/edge_band.h"

#include <algorithm>
#include <cmath>

#include "core/vision/median.h"

namespace legible {
namespace {

// Where brightness is read for flattening, clear of the blurred edge itself (px inside).
constexpr float kBackgroundFrom = -5, kBackgroundTo = -2, kLegFrom = 1.5, kLegTo = 6;
constexpr double kLeastRelativeContrast = 0.3;  // of a cell, against the median cell's
constexpr double kLargestRelativeJump =
    0.12;  // of brightness from one neighbour cell to the other, against the contrast
constexpr double kLargestJump = 3;  // grey levels: less is noise
constexpr size_t kFewestPixels = 4;
constexpr double kCoarse_px = 0.5;  // bins of a profile far from the edge

// least <= slope x + at_zero <= most as a range of x, for one slope and many at_zero.
class Strip {
 public:
  Strip(double slope, double least, double most)
      : least_(least), most_(most), is_flat_(std::abs(slope) < 1e-12) {
    if (!is_flat_) per_slope_ = 1 / slope;
  }
  // Narrows [low, high].
  void Clip(double at_zero, double& low, double& high) const {
    if (is_flat_) {
      if (at_zero < least_ || at_zero > most_) high = low - 1;
      return;
    }
    const double a = (least_ - at_zero) * per_slope_, b = (most_ - at_zero) * per_slope_;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }

 private:
  double least_, most_, per_slope_ = 0;
  bool is_flat_;
};

// Of x >= 0; std::ceil is a function call on machines without SSE 4.1.
int CeilOf(double x) {
  const int whole = static_cast<int>(x);
  return whole + (x > whole ? 1 : 0);
}

// The pixels of one cell: |along| <= half its length, and -inside_px <= outward <= outside_px.
void CollectCell(const GrayImage& image, const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                 double outside_px, double inside_px, const BandCell& cell, std::vector<BandPixel>& pixels) {
  const Eigen::Vector2d tangent = (end - start).normalized();
  const double half_length = (end - start).norm() / 2;
  const double reach =
      half_length * std::abs(tangent.y()) + std::max(outside_px, inside_px) * std::abs(tangent.x());
  const int top = std::max(0, static_cast<int>(std::ceil(cell.centre_px.y() - reach)));
  const int bottom = std::min(image.height - 1, static_cast<int>(std::floor(cell.centre_px.y() + reach)));
  const Strip along(tangent.x(), -half_length, half_length);
  const Strip outward(cell.normal_px.x(), -inside_px, outside_px);
  const auto step = static_cast<float>(-cell.normal_px.x());
  // A convex region holds no more lattice points than its area, half its perimeter and one.
  const size_t first = pixels.size();
  pixels.resize(first + static_cast<size_t>((2 * half_length + 1) * (outside_px + inside_px + 1)) + 1);
  BandPixel* next = pixels.data() + first;
  for (int y = top; y <= bottom; ++y) {
    const double dy = y - cell.centre_px.y();
    double low = -cell.centre_px.x(), high = image.width - 1 - cell.centre_px.x();
    along.Clip(tangent.y() * dy, low, high);
    outward.Clip(cell.normal_px.y() * dy, low, high);
    if (high < low) continue;
    const int from = CeilOf(low + cell.centre_px.x()), to = static_cast<int>(high + cell.centre_px.x());
    auto at = static_cast<float>(-cell.normal_px.dot(Eigen::Vector2d(from - cell.centre_px.x(), dy)));
    const std::uint8_t* row = image.Row(y);
    for (int x = from; x <= to; ++x, at += step) *next++ = {at, static_cast<float>(row[x])};
  }
  pixels.resize(static_cast<size_t>(next - pixels.data()));
}

// Mean brightness over part of a cell.
struct Level {
  double sum = 0;
  double squares = 0;
  double count = 0;
  void Add(double value) {
    sum += value;
    squares += value * value;
    count += 1;
  }
  void Add(const Level& other) {
    sum += other.sum;
    squares += other.squares;
    count += other.count;
  }
  double Mean() const { return count > 0 ? sum / count : 0; }
  double Variance() const { return (squares - sum * Mean()) / (count - 1); }
};

struct Levels {
  Level background, leg;
  double Contrast() const { return leg.Mean() - background.Mean(); }
  bool IsMeasured() const {
    return background.count >= static_cast<double>(kFewestPixels) &&
           leg.count >= static_cast<double>(kFewestPixels);
  }
  void Add(const Levels& other) {
    background.Add(other.background);
    leg.Add(other.leg);
  }
};

// Sums of whole grey levels: exact in single precision up to 258 pixels, about three cells of the usual
// length.
struct CellLevel {
  float sum = 0, squares = 0, count = 0;
  void Add(float value) {
    sum += value;
    squares += value * value;
    count += 1;
  }
  Level InDouble() const { return {sum, squares, count}; }
};

Levels LevelsOf(const EdgeBand& band, const BandCell& cell) {
  CellLevel background, leg;
  for (size_t i = cell.first; i < cell.last; ++i) {
    const float x = band.pixels[i].inside_px;
    if (x >= kLegFrom && x <= kLegTo)
      leg.Add(band.pixels[i].brightness);
    else if (x >= kBackgroundFrom && x <= kBackgroundTo)
      background.Add(band.pixels[i].brightness);
  }
  return {background.InDouble(), leg.InDouble()};
}

// Where the background or the leg changes within a few pixels along the edge (the horizon behind it, a
// shadow's border across it), it changes across the edge as well, unseen.
bool JumpsAt(const EdgeBand& band, const std::vector<Levels>& levels, size_t i, double largest) {
  const bool has_before = i > 0 && band.cells[i].follows_previous && levels[i - 1].IsMeasured();
  const bool has_after =
      i + 1 < levels.size() && band.cells[i + 1].follows_previous && levels[i + 1].IsMeasured();
  const size_t before = has_before ? i - 1 : i, after = has_after ? i + 1 : i;
  return std::abs(levels[after].background.Mean() - levels[before].background.Mean()) > largest ||
         std::abs(levels[after].leg.Mean() - levels[before].leg.Mean()) > largest;
}

// Drops what is not a plain stretch of the leg's edge: contrast missing or reversed, or brightness that
// jumps.
void DropUnevenCells(EdgeBand& band, std::vector<Levels>& levels) {
  std::vector<double> contrasts;
  contrasts.reserve(levels.size());
  for (const Levels& of_cell : levels)
    if (of_cell.IsMeasured()) contrasts.push_back(of_cell.Contrast());
  if (contrasts.empty()) {
    band.cells.clear();
    levels.clear();
    return;
  }
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
  for (size_t i = 0; i < cells.size(); ++i) {
    smooth[i].Add(levels[i]);
    if (!cells[i].follows_previous || i == 0) continue;
    smooth[i].Add(levels[i - 1]);
    smooth[i - 1].Add(levels[i]);
  }
  return smooth;
}

constexpr double kLeastLevel = 5;  // grey levels: below, nothing is in proportion to it
constexpr double kFewestForVariance = 8;

}  // namespace

EdgeBand CollectBand(const GrayImage& image, const std::vector<PredictedEdgePoint>& curve, double outside_px,
                     double inside_px) {
  EdgeBand band;
  band.cells.reserve(curve.size());
  if (curve.size() > 1) {
    const double length = (curve.back().point_px - curve.front().point_px).norm();
    band.pixels.reserve(static_cast<size_t>(1.1 * length * (outside_px + inside_px)));
  }
  bool previous = false;
  for (size_t i = 0; i + 1 < curve.size(); ++i) {
    const PredictedEdgePoint &a = curve[i], &b = curve[i + 1];
    const bool visible =
        a.obstacle == EdgeObstacle::kNone && b.obstacle == EdgeObstacle::kNone && a.point_px != b.point_px;
    if (visible) {
      BandCell cell{
          (a.share + b.share) / 2, (a.point_px + b.point_px) / 2, {}, previous, band.pixels.size(), 0};
      const Eigen::Vector2d chord = (b.point_px - a.point_px).normalized();
      cell.normal_px = Eigen::Vector2d(-chord.y(), chord.x());
      if (cell.normal_px.dot(a.normal_px) < 0) cell.normal_px = -cell.normal_px;
      CollectCell(image, a.point_px, b.point_px, outside_px, inside_px, cell, band.pixels);
      cell.last = band.pixels.size();
      band.cells.push_back(cell);
    }
    previous = visible;
  }
  return band;
}

void MeasureLevels(EdgeBand& band) {
  if (band.cells.empty()) return;
  std::vector<Levels> levels;
  levels.reserve(band.cells.size());
  for (const BandCell& cell : band.cells) levels.push_back(LevelsOf(band, cell));
  DropUnevenCells(band, levels);
  Levels all;
  for (const Levels& of_cell : levels) all.Add(of_cell);
  const std::vector<Levels> smooth = Smoothed(band.cells, levels);
  for (size_t i = 0; i < band.cells.size(); ++i) {
    band.cells[i].background = smooth[i].background.Mean() - all.background.Mean();
    band.cells[i].leg = smooth[i].leg.Mean() - all.leg.Mean();
    if (levels[i].background.count >= kFewestForVariance)
      band.cells[i].background_variance = levels[i].background.Variance();
  }
}

double GreyNoise(const EdgeBand& band) {
  std::vector<double> variances;
  for (const BandCell& cell : band.cells)
    if (cell.background_variance) variances.push_back(*cell.background_variance);
  return variances.empty() ? 0 : std::sqrt(std::max(MedianOf(std::move(variances)), 0.0));
}

size_t BinGrid::size() const { return static_cast<size_t>(std::ceil((outside_px + inside_px) / width_px)); }

BandBins BinBand(const EdgeBand& band, size_t first_cell, size_t last_cell, const BinGrid& grid) {
  BandBins bins(grid.size());
  const auto per_px = static_cast<float>(1 / grid.width_px), count = static_cast<float>(bins.size());
  const auto first_px = static_cast<float>(grid.outside_px);
  for (size_t c = first_cell; c < last_cell; ++c) {
    const BandCell& cell = band.cells[c];
    const auto background = static_cast<float>(cell.background), leg = static_cast<float>(cell.leg);
    for (size_t i = cell.first; i < cell.last; ++i) {
      const BandPixel& pixel = band.pixels[i];
      const float position = (pixel.inside_px + first_px) * per_px;
      if (position < 0 || position >= count) continue;
      BandBin& bin = bins[static_cast<size_t>(static_cast<int>(position))];
      bin.sums += Eigen::Array4f(pixel.inside_px, pixel.brightness, background, leg);
      bin.count += 1;
    }
  }
  return bins;
}

void Add(const BandBins& bins, BandBins& to) {
  for (size_t i = 0; i < bins.size(); ++i) {
    to[i].sums += bins[i].sums;
    to[i].count += bins[i].count;
  }
}

LevelShape SoftStep(const BinGrid& grid) {
  LevelShape shape;
  for (size_t i = 0; i < grid.size(); ++i) {
    const double leg = 1 / (1 + std::exp(-1.7 * grid.Middle(i)));
    shape.push_back({1 - leg, leg});
  }
  return shape;
}

LevelShape ShapeOf(const ProfileFit& fit, const ProfileFitOptions& options, const BinGrid& grid) {
  std::vector<double> places;
  for (size_t i = 0; i < grid.size(); ++i) places.push_back(grid.Middle(i));
  const std::vector<BrightnessParts> parts = PredictParts(fit, places, options);
  // Against the mean over the distances from which levels are read.
  Level background, leg;
  for (size_t i = 0; i < places.size(); ++i) {
    if (places[i] >= kBackgroundFrom && places[i] <= kBackgroundTo) background.Add(parts[i].background);
    if (places[i] >= kLegFrom && places[i] <= kLegTo) leg.Add(parts[i].leg);
  }
  if (std::min(std::abs(background.Mean()), std::abs(leg.Mean())) < kLeastLevel) return SoftStep(grid);
  LevelShape shape;
  for (const BrightnessParts& at : parts)
    shape.push_back({at.background / background.Mean(), at.leg / leg.Mean()});
  return shape;
}

EdgeProfile FlatProfile(const BandBins& bins, const LevelShape& shape, const BinGrid& grid, double fine_px) {
  const int together = std::max(1, static_cast<int>(std::lround(kCoarse_px / grid.width_px)));
  EdgeProfile profile;
  profile.reserve(bins.size());
  int in_group = together;
  for (size_t i = 0; i < bins.size(); ++i) {
    const BandBin& sum = bins[i];
    if (sum.count == 0) continue;
    const double flat = sum.sums[1] - shape[i].background * sum.sums[2] - shape[i].leg * sum.sums[3];
    const ProfileBin bin{sum.sums[0] / sum.count, flat / sum.count, sum.count};
    const bool is_fine = std::abs(bin.inside_px) < fine_px;
    if (is_fine || in_group == together) {
      profile.push_back(bin);
      in_group = is_fine ? together : 1;
      continue;
    }
    ProfileBin& group = profile.back();
    const double count = group.count + bin.count;
    group.inside_px += (bin.inside_px - group.inside_px) * bin.count / count;
    group.brightness += (bin.brightness - group.brightness) * bin.count / count;
    group.count = count;
    ++in_group;
  }
  return profile;
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

}  // namespace legible
