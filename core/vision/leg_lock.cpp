#include "core/vision/leg_lock.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace legible {
namespace {

constexpr int kProfiles = 24;         // a leg
constexpr double kMaxContrast = 12;   // grey levels per px: a stronger edge counts no more than this
constexpr double kCommonStep_px = 3;  // of the search for the common shift, about the blurred edge's width
constexpr int kCell = 1;              // steps to either side of its centre that a cell of shifts covers
constexpr int kRollSteps = 3, kScaleSteps = 3;  // to either side of the prediction
constexpr double kLeastShareOfProfiles = 0.35;  // that must show both edges

double Bilinear(const GrayImage& image, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (x < 0 || y < 0 || x + 1 >= image.width || y + 1 >= image.height) return -1;
  const double fx = p.x() - x, fy = p.y() - y;
  return (1 - fy) * ((1 - fx) * image(x, y) + fx * image(x + 1, y)) +
         fy * ((1 - fx) * image(x, y + 1) + fx * image(x + 1, y + 1));
}

// How leg-like the image is at whole-pixel shifts across the predicted axis, at one place along it.
struct Profile {
  Eigen::Vector2d centre_px;
  Eigen::Vector2d across_px;  // unit, towards edge 2
  double share = 0;           // along the axis
  // At shifts -reach … reach: the weaker of the two edges' contrasts, clipped; and the largest of these
  // within a cell of shifts about each.
  std::vector<float> leg_likeness, most_in_cell;
};
using LegProfiles = std::vector<Profile>;

class ProfileTable {
 public:
  // polarity +1: legs brighter than what is behind them, -1: darker.
  ProfileTable(const GrayImage& blurred, const PredictedEdges& predicted, int reach, double polarity)
      : reach_(reach) {
    for (size_t leg = 0; leg < kLegCount; ++leg) AddLeg(blurred, predicted[leg], polarity, legs_[leg]);
  }

  const LegProfiles& Of(size_t leg) const { return legs_[leg]; }

  float At(const Profile& profile, double shift_px) const { return Look(profile.leg_likeness, shift_px); }
  // No smaller than At() anywhere in the cell of shifts about one that is `shift_px` across the profile.
  float MostInCell(const Profile& profile, double shift_px) const {
    const double rim = reach_;  // beyond it a cell may reach back in
    return Look(profile.most_in_cell, std::clamp(shift_px, -rim, rim));
  }

 private:
  float Look(const std::vector<float>& values, double shift_px) const {
    const int index = static_cast<int>(std::lround(shift_px)) + reach_;
    return index < 0 || index > 2 * reach_ ? 0.0f : values[static_cast<size_t>(index)];
  }

  void AddLeg(const GrayImage& blurred, const std::array<PredictedEdge, 2>& edges, double polarity,
              LegProfiles& profiles) const {
    const size_t count = std::min(edges[0].points.size(), edges[1].points.size());
    if (count < 2) return;
    for (int i = 0; i < kProfiles; ++i) {
      const double share = 0.08 + 0.84 * i / (kProfiles - 1);
      const auto at = static_cast<size_t>(std::lround(share * static_cast<double>(count - 1)));
      const PredictedEdgePoint &first = edges[0].points[at], &second = edges[1].points[at];
      Profile profile{(first.point_px + second.point_px) / 2, second.normal_px, share, {}, {}};
      const double half_width = std::abs(second.normal_px.dot(second.point_px - first.point_px)) / 2;
      FillLikeness(blurred, half_width, polarity, profile);
      FillMostInCell(profile);
      profiles.push_back(std::move(profile));
    }
  }

  void FillLikeness(const GrayImage& blurred, double half_width, double polarity, Profile& profile) const {
    const auto slope = [&](double u) {
      const double ahead = Bilinear(blurred, profile.centre_px + (u + 1) * profile.across_px);
      const double behind = Bilinear(blurred, profile.centre_px + (u - 1) * profile.across_px);
      return ahead < 0 || behind < 0 ? 0.0 : polarity * (ahead - behind) / 2;
    };
    profile.leg_likeness.reserve(static_cast<size_t>(2 * reach_ + 1));
    for (int u = -reach_; u <= reach_; ++u) {
      const double weaker = std::min(slope(u - half_width), -slope(u + half_width));
      profile.leg_likeness.push_back(static_cast<float>(std::clamp(weaker, 0.0, kMaxContrast)));
    }
  }

  static void FillMostInCell(Profile& profile) {
    // A cell's corner is this far from its centre, whichever way the profile lies; one for the rounding.
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(2.0) * kCell * kCommonStep_px)) + 1;
    const std::vector<float>& likeness = profile.leg_likeness;
    const auto count = static_cast<std::ptrdiff_t>(likeness.size());
    for (std::ptrdiff_t i = 0; i < count; ++i)
      profile.most_in_cell.push_back(
          *std::max_element(likeness.begin() + std::max<std::ptrdiff_t>(i - reach, 0),
                            likeness.begin() + std::min(i + reach + 1, count)));
  }

  int reach_;
  std::array<LegProfiles, kLegCount> legs_;
};

// A movement of the whole picture of the robot: shift, roll about `centre`, relative growth.
struct CommonMove {
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
  double roll_rad = 0, growth = 0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();

  double Across(const Profile& profile) const {
    const Eigen::Vector2d arm = profile.centre_px - centre_px;
    const Eigen::Vector2d turned(-arm.y(), arm.x());
    return profile.across_px.dot(shift_px + roll_rad * turned + growth * arm);
  }
};

using Likeness = float (ProfileTable::*)(const Profile&, double) const;

double CommonScore(const ProfileTable& table, const CommonMove& move, Likeness likeness) {
  double sum = 0;
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (const Profile& profile : table.Of(leg)) sum += (table.*likeness)(profile, move.Across(profile));
  return sum;
}

struct CommonBest {
  CommonMove move;
  double score = -1;
};

// Calls visit(move) for every roll and growth, and for shifts in cells whose centres cover the range.
template <typename F>
void ForEachCell(const Eigen::Vector2d& centre, const LegLockOptions& options, F visit) {
  const double side_px = (2 * kCell + 1) * kCommonStep_px;
  const int cells = static_cast<int>(std::ceil((options.range_px - kCell * kCommonStep_px) / side_px));
  for (int roll = -kRollSteps; roll <= kRollSteps; ++roll)
    for (int growth = -kScaleSteps; growth <= kScaleSteps; ++growth)
      for (int dx = -cells; dx <= cells; ++dx)
        for (int dy = -cells; dy <= cells; ++dy)
          visit(CommonMove{side_px * Eigen::Vector2d(dx, dy), roll * options.roll_range_rad / kRollSteps,
                           growth * options.scale_range / kScaleSteps, centre});
}

// Branch and bound: the best of the cells' centres first, then those cells that could hold a better one.
CommonBest SearchCommonMove(const ProfileTable& table, const Eigen::Vector2d& centre,
                            const LegLockOptions& options) {
  CommonBest best;
  const auto keep_better = [&](const CommonMove& move) {
    const double score = CommonScore(table, move, &ProfileTable::At);
    if (score > best.score) best = {move, score};
  };
  ForEachCell(centre, options, keep_better);
  ForEachCell(centre, options, [&](CommonMove move) {
    if (CommonScore(table, move, &ProfileTable::MostInCell) <= best.score) return;
    const Eigen::Vector2d middle = move.shift_px;
    for (int dx = -kCell; dx <= kCell; ++dx)
      for (int dy = -kCell; dy <= kCell; ++dy) {
        move.shift_px = middle + kCommonStep_px * Eigen::Vector2d(dx, dy);
        keep_better(move);
      }
  });
  return best;
}

std::optional<LegLock> SearchLeg(const ProfileTable& table, const LegProfiles& profiles,
                                 const CommonMove& move, const LegLockOptions& options) {
  if (profiles.empty()) return std::nullopt;
  const double base_a = move.Across(profiles.front()), base_b = move.Across(profiles.back());
  const int range = static_cast<int>(std::ceil(options.leg_range_px));
  LegLock best;
  double best_sum = -1;
  for (int a = -range; a <= range; ++a)
    for (int b = -range; b <= range; ++b) {
      const double at_a = base_a + a, at_b = base_b + b;
      double sum = 0;
      for (const Profile& profile : profiles) sum += table.At(profile, at_a + (at_b - at_a) * profile.share);
      if (sum > best_sum) {
        best_sum = sum;
        best = {at_a, at_b, sum / static_cast<double>(profiles.size())};
      }
    }
  int supporting = 0;
  for (const Profile& profile : profiles)
    if (table.At(profile, best.shift_at_a_px + (best.shift_at_b_px - best.shift_at_a_px) * profile.share) >
        options.least_contrast)
      ++supporting;
  const bool enough = supporting >= kLeastShareOfProfiles * static_cast<double>(profiles.size());
  return enough ? std::optional(best) : std::nullopt;
}

}  // namespace

void LegLockOptions::Check() const {
  if (!(blur_px > 0) || !(range_px > 0) || !(leg_range_px > 0) || !(roll_range_rad >= 0) ||
      !(scale_range >= 0))
    throw std::invalid_argument("LegLockOptions: blur and ranges must be positive");
}

std::array<std::optional<LegLock>, kLegCount> LockOnLegs(const GrayImage& image,
                                                         const PredictedEdges& predicted,
                                                         const LegLockOptions& options) {
  options.Check();
  const GrayImage blurred = Blurred(image, options.blur_px);
  const Eigen::Vector2d centre(image.width / 2.0, image.height / 2.0);
  const double turned = options.roll_range_rad * centre.norm() + options.scale_range * centre.norm();
  const int reach = static_cast<int>(std::ceil(1.5 * options.range_px + turned + options.leg_range_px));

  std::optional<ProfileTable> best_table;
  CommonBest best;
  for (const double polarity : {1.0, -1.0}) {
    ProfileTable table(blurred, predicted, reach, polarity);
    const CommonBest found = SearchCommonMove(table, centre, options);
    if (found.score <= best.score) continue;
    best = found;
    best_table = std::move(table);
  }
  std::array<std::optional<LegLock>, kLegCount> locks;
  for (size_t leg = 0; leg < kLegCount; ++leg)
    locks[leg] = SearchLeg(*best_table, best_table->Of(leg), best.move, options);
  return locks;
}

}  // namespace legible
