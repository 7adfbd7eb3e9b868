#include "apps/legs_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/hidden/singularity_conditions.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

constexpr Eigen::Index kMapPoints = 61;  // of each coordinate
// Of the search for where the robot reaches: that many points each way, the goal's in the middle, out to that
// many times the robot's size and that far turned.
constexpr Eigen::Index kSearchPoints = 41;
constexpr double kFarthestOfSize = 1.5;
constexpr double kFarthestTurn_rad = std::numbers::pi / 2;
// Areas as those of AreaMoved: of coordinates that depend on each other, and of such that a map shows well.
constexpr double kNoArea = 1e-6;
constexpr double kClearArea = 0.5;

using Axes = std::array<int, 2>;

Eigen::VectorXd Spaced(const std::array<double, 2>& range, Eigen::Index points) {
  return Eigen::VectorXd::LinSpaced(points, range[0], range[1]);
}

// How far the platform moves along two coordinates independently, as the area that its unit twists reach in
// them: 1 where each is a freedom of its own, 0 where one does not change or follows from the other.
double AreaMoved(const Eigen::Matrix<double, 6, Eigen::Dynamic>& rates, const Axes& axes) {
  const Eigen::MatrixXd both = rates(axes, Eigen::all);
  return std::sqrt(std::max(0.0, (both * both.transpose()).determinant()));
}

// Those that a map without --map is over; where none moves clearly those that move most.
std::optional<Axes> AxesThatMove(const ParallelRobot& robot, const Rigid3& goal) {
  const auto rates = CoordinateRates(robot, goal);
  std::optional<Axes> most;
  double most_area = kNoArea;
  for (int first = 0; first < 6; ++first)
    for (int second = first + 1; second < 6; ++second) {
      const double area = AreaMoved(rates, {first, second});
      if (area >= kClearArea) return Axes{first, second};
      if (area <= most_area) continue;
      most = {first, second};
      most_area = area;
    }
  return most;
}

// Cells within reach and joint ranges that such cells join to the given one, side by side.
std::vector<Eigen::Index> CellsJoinedTo(Eigen::Index start, const ParallelRobot& robot,
                                        const PoseSlice& slice) {
  const Eigen::Index columns = slice.first.size(), rows = slice.second.size();
  std::vector<Eigen::Index> joined = {start};
  std::vector<bool> seen(static_cast<size_t>(slice.CellCount()));
  seen[static_cast<size_t>(start)] = true;
  const auto visit = [&](Eigen::Index column, Eigen::Index row) {
    if (column < 0 || column >= columns || row < 0 || row >= rows) return;
    const Eigen::Index cell = row * columns + column;
    if (seen[static_cast<size_t>(cell)]) return;
    seen[static_cast<size_t>(cell)] = true;
    const auto pose = PoseOfCell(robot, slice, cell);
    if (pose && StateOfCell(robot, *pose) == CellState::kFine) joined.push_back(cell);
  };
  for (size_t next = 0; next < joined.size(); ++next) {
    const Eigen::Index column = joined[next] % columns, row = joined[next] / columns;
    visit(column - 1, row);
    visit(column + 1, row);
    visit(column, row - 1);
    visit(column, row + 1);
  }
  return joined;
}

// As far as the robot reaches from the goal, and a cell of the search more on every side.
PoseSlice WithinReach(const ParallelRobot& robot, const Rigid3& goal, const Axes& axes) {
  PoseSlice slice;
  slice.axes = axes;
  slice.held = CoordinatesOf(goal);
  const auto around = [&](int coordinate) {
    const double far = coordinate < 3 ? kFarthestOfSize * SizeOf_m(robot, goal) : kFarthestTurn_rad;
    return Spaced({slice.held[coordinate] - far, slice.held[coordinate] + far}, kSearchPoints);
  };
  slice.first = around(axes[0]);
  slice.second = around(axes[1]);
  Eigen::Array2d low(slice.held[axes[0]], slice.held[axes[1]]), high = low;
  for (const Eigen::Index cell : CellsJoinedTo(slice.CellCount() / 2, robot, slice)) {
    const Eigen::Array2d place(slice.first[cell % kSearchPoints], slice.second[cell / kSearchPoints]);
    low = low.min(place);
    high = high.max(place);
  }
  const Eigen::Array2d margin(slice.first[1] - slice.first[0], slice.second[1] - slice.second[0]);
  low -= margin;
  high += margin;
  slice.first = Spaced({low[0], high[0]}, kMapPoints);
  slice.second = Spaced({low[1], high[1]}, kMapPoints);
  return slice;
}

void DemandMotion(const LegsSettings& settings, const ParallelRobot& robot, const Rigid3& goal,
                  const Axes& axes) {
  const auto rates = CoordinateRates(robot, goal);
  if (AreaMoved(rates, axes) > kNoArea) return;
  std::vector<std::string> moved;
  for (int coordinate = 0; coordinate < 6; ++coordinate)
    if (rates.row(coordinate).norm() > kNoArea)
      moved.push_back(CoordinateNames()[static_cast<size_t>(coordinate)]);
  throw InputError(settings.model, 0,
                   fmt::format("has a platform that does not move along both coordinates of --map at the "
                               "goal, but along {}",
                               fmt::join(moved, ", ")),
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

std::optional<PoseSlice> SliceOf(const LegsSettings& settings, const ParallelRobot& robot,
                                 const Rigid3& goal) {
  if (!settings.map) {
    const std::optional<Axes> axes = AxesThatMove(robot, goal);
    return axes ? std::optional(WithinReach(robot, goal, *axes)) : std::nullopt;
  }
  PoseSlice slice;
  slice.held = CoordinatesOf(goal);
  const auto& [first, first_range] = *settings.map->begin();
  const auto& [second, second_range] = *settings.map->rbegin();
  slice.axes = {first, second};
  slice.first = Spaced(first_range, kMapPoints);
  slice.second = Spaced(second_range, kMapPoints);
  DemandMotion(settings, robot, goal, slice.axes);
  return slice;
}

SliceMap MapLegSets(const LegsSettings& settings, const ParallelRobot& robot, const PoseSlice& slice,
                    const std::vector<std::vector<int>>& leg_sets, ProgressLine& progress) {
  return MapSlice(robot, slice, leg_sets, settings.noise_rad, [&](int cells, int of) {
    progress.Show(StageText("mapping the slice, point", cells, of));
  });
}

}  // namespace legible
