#include "apps/servo_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "servo/path_shape.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

// Nearest rank; NaN of nothing.
double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

template <typename F>
std::vector<double> OfCycles(const ServoLog& log, F value) {
  std::vector<double> values;
  values.reserve(log.cycles.size());
  for (const LoggedCycle& logged : log.cycles) values.push_back(value(logged.cycle));
  return values;
}

ordered_json TimesJson(const std::vector<double>& times_s) {
  return {{"median", Percentile(times_s, 0.5)}, {"p99", Percentile(times_s, 0.99)}};
}

using LawNumber = double (*)(const LawResult& law);
using Choice = double (*)(double a, double b);

// The one that `choose` leaves of the cycles that have a number.
ordered_json Chosen(const ServoLog& log, Choice choose, LawNumber number) {
  std::optional<double> chosen;
  for (const LoggedCycle& logged : log.cycles) {
    const double of_cycle = number(logged.cycle.output.step.law);
    if (std::isfinite(of_cycle)) chosen = choose(chosen.value_or(of_cycle), of_cycle);
  }
  return chosen ? ordered_json(*chosen) : ordered_json();
}
ordered_json Least(const ServoLog& log, LawNumber number) {
  return Chosen(
      log, [](double a, double b) { return std::min(a, b); }, number);
}
ordered_json Largest(const ServoLog& log, LawNumber number) {
  return Chosen(
      log, [](double a, double b) { return std::max(a, b); }, number);
}

// Of the last cycle; null where there was none.
template <typename F>
ordered_json Last(const ServoLog& log, F value) {
  return log.cycles.empty() ? ordered_json() : ordered_json(value(log.cycles.back().cycle.output));
}

ordered_json MissingJson(const FinishedServo& finished) {
  ordered_json missing = ordered_json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (size_t edge = 0; edge < 2; ++edge)
      if (!finished.missing[leg][edge].empty())
        missing.push_back({{"leg", leg + 1}, {"edge", edge + 1}, {"reason", finished.missing[leg][edge]}});
  return missing;
}

ordered_json PoseErrorJson(const PreparedServo& prepared, const FinishedServo& finished) {
  if (!prepared.true_goal || !finished.true_end) return nullptr;
  const Vector6d error = Displacement(*finished.true_end, *prepared.true_goal);
  return {{"position_m", error.head<3>().norm()}, {"rotation_rad", error.tail<3>().norm()}};
}

ordered_json PathJson(const PreparedServo& prepared, const FinishedServo& finished) {
  std::vector<Eigen::Vector3d> places;
  for (const LoggedCycle& logged : finished.log.cycles)
    places.push_back(
        logged.true_base_from_platform.value_or(logged.cycle.output.step.law.base_from_platform).translation);
  if (places.empty()) return nullptr;
  const auto& goal = prepared.setup.goal.base_from_platform;
  const PathShape shape = ShapeOfPath(places, goal ? goal->translation : places.back());
  return {{"length_m", shape.length_m}, {"deviation_m", shape.deviation_m}};
}

ordered_json LegsJson(const std::bitset<kLegCount>& legs) {
  ordered_json numbers = ordered_json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg)
    if (legs[leg]) numbers.push_back(leg + 1);
  return numbers;
}

}  // namespace

ordered_json ServoJson(const PreparedServo& prepared, const FinishedServo& finished) {
  const ServoLog& log = finished.log;
  const ControlLawOptions& options = prepared.setup.options.step.law;
  const auto speeds = OfCycles(
      log, [](const ServoCycle& cycle) { return cycle.output.joint_speeds_m_per_s.cwiseAbs().maxCoeff(); });
  return {
      {"status", ToString(finished.run.end)},
      {"reason", finished.run.reason},
      {"mode", ToString(options.mode)},
      {"unit", UnitOf(options.mode)},
      {"legs", LegsJson(options.legs)},
      {"iterations", finished.run.cycles},
      {"time_s", finished.run.time_s},
      {"final_error", Last(log, [](const CycleOutput& last) { return last.step.law.error; })},
      {"tolerance", Last(log, [](const CycleOutput& last) { return last.verdict.tolerance; })},
      {"final_edge_error_px", Last(log, [](const CycleOutput& last) { return last.step.law.edge_error_px; })},
      {"final_direction_error_rad",
       Last(log, [](const CycleOutput& last) { return last.step.law.direction_error_rad; })},
      {"final_pose_error", PoseErrorJson(prepared, finished)},
      {"path", PathJson(prepared, finished)},
      {"max_joint_speed_m_per_s", Percentile(speeds, 1)},
      {"min_singular_value", Least(log, [](const LawResult& law) { return law.singular_values[5]; })},
      {"max_motion_sigma_m", Largest(log, [](const LawResult& law) { return law.motion_sigma_m; })},
      {"min_conditioning", Least(log, [](const LawResult& law) { return law.Conditioning(); })},
      {"min_robot_conditioning", Least(log, [](const LawResult& law) { return law.robot_conditioning; })},
      {"compute_time_s", TimesJson(OfCycles(log, [](const ServoCycle& cycle) { return cycle.law_s; }))},
      {"look_time_s", TimesJson(OfCycles(log, [](const ServoCycle& cycle) { return cycle.look_s; }))},
      {"not_seen", MissingJson(finished)},
      {"warnings", prepared.warnings}};
}

}  // namespace legible
