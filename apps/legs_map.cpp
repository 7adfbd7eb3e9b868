#include "apps/legs_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/robots/platform_motion.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr Eigen::Index kMapPoints = 61;  // of each coordinate
// Of the search for where the robot reaches: that many points each way, out to that many times the robot's
// size.
constexpr Eigen::Index kSearchPoints = 41;
constexpr double kFarthestOfSize = 1.5;

Vector6d CoordinatesOf(const Rigid3& pose) {
  Vector6d coordinates;
  coordinates << pose.translation, VectorFromRotation(pose.rotation);
  return coordinates;
}

Eigen::VectorXd Spaced(const std::array<double, 2>& range, Eigen::Index points) {
  return Eigen::VectorXd::LinSpaced(points, range[0], range[1]);
}

// Widened to every cell that `counts`, by one cell more on every side; the slice as it is where none does.
template <typename F>
bool NarrowTo(const ParallelRobot& robot, PoseSlice& slice, const F& counts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Array2d low(kInfinity, kInfinity), high = -low;
  for (Eigen::Index cell = 0; cell < slice.CellCount(); ++cell) {
    if (!counts(StateOfCell(robot, PoseOfCell(robot, slice, cell)))) continue;
    const Eigen::Array2d place(slice.first[cell % slice.first.size()],
                               slice.second[cell / slice.first.size()]);
    low = low.min(place);
    high = high.max(place);
  }
  if (!(low <= high).all()) return false;
  const double margin_x = slice.first[1] - slice.first[0], margin_y = slice.second[1] - slice.second[0];
  slice.first = Spaced({low[0] - margin_x, high[0] + margin_x}, kMapPoints);
  slice.second = Spaced({low[1] - margin_y, high[1] + margin_y}, kMapPoints);
  return true;
}

PoseSlice WithinReach(const ParallelRobot& robot, const Rigid3& goal) {
  PoseSlice slice;
  slice.held = CoordinatesOf(goal);
  const double far_m = kFarthestOfSize * SizeOf_m(robot, goal);
  const auto around = [&](int coordinate) {
    return Spaced({slice.held[coordinate] - far_m, slice.held[coordinate] + far_m}, kSearchPoints);
  };
  slice.first = around(slice.axes[0]);
  slice.second = around(slice.axes[1]);
  if (!NarrowTo(robot, slice, [](CellState state) { return state == CellState::kFine; }))
    NarrowTo(robot, slice, [](CellState state) { return state != CellState::kOutOfReach; });
  return slice;
}

void DemandMotion(const LegsSettings& settings, const ParallelRobot& robot, const PoseSlice& slice) {
  for (const Eigen::Index cell : {Eigen::Index{0}, slice.CellCount() - 1})
    if (!CanTake(robot, PoseOfCell(robot, slice, cell)))
      throw InputError(settings.model, 0, "has a platform that does not move along the coordinates of --map",
                       "map two along which it moves");
}

}  // namespace

CoordinateRanges ParseMap(const std::string& text) {
  CoordinateRanges ranges = ParseRanges(Split(text, ','));
  if (ranges.size() != 2) throw std::invalid_argument("a map is over two coordinates");
  for (const auto& [coordinate, range] : ranges)
    if (!(range[0] < range[1]))
      throw std::invalid_argument(
          fmt::format("the range of {} is empty", CoordinateNames()[static_cast<size_t>(coordinate)]));
  return ranges;
}

PoseSlice SliceOf(const LegsSettings& settings, const ParallelRobot& robot, const Rigid3& goal) {
  if (!settings.map) return WithinReach(robot, goal);
  PoseSlice slice;
  slice.held = CoordinatesOf(goal);
  const auto& [first, first_range] = *settings.map->begin();
  const auto& [second, second_range] = *settings.map->rbegin();
  slice.axes = {first, second};
  slice.first = Spaced(first_range, kMapPoints);
  slice.second = Spaced(second_range, kMapPoints);
  DemandMotion(settings, robot, slice);
  return slice;
}

SliceMap MapLegSets(const LegsSettings& settings, const ParallelRobot& robot, const PoseSlice& slice,
                    const std::vector<std::vector<int>>& leg_sets, ProgressLine& progress) {
  return MapSlice(robot, slice, leg_sets, settings.noise_rad, [&](int cells, int of) {
    progress.Show(StageText("mapping the slice, point", cells, of));
  });
}

}  // namespace legible
