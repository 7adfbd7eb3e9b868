#include "apps/servo_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/program.h"
#include "apps/report_pictures.h"
#include "servo/image_errors.h"

namespace legible {
namespace {

using nlohmann::json;

json Numbers(const Eigen::Ref<const Eigen::VectorXd>& values) { return List(values); }

json OrNull(double value) { return std::isfinite(value) ? json(value) : json(); }

json PoseJson(const Rigid3& pose) {
  return {{"rotation_xyzw", List(pose.rotation.coeffs())}, {"translation_m", List(pose.translation)}};
}

json RobotJson(const GoughStewart& robot, double speed_limit_m_per_s) {
  json legs = json::array();
  for (const Leg& leg : robot.legs)
    legs.push_back({{"base_joint_m", List(leg.base_joint_m)},
                    {"platform_joint_m", List(leg.platform_joint_m)},
                    {"radius_m", leg.radius_m},
                    {"joint_range_m", leg.joint_range_m}});
  return {{"legs", legs}, {"speed_limit_m_per_s", speed_limit_m_per_s}};
}

// Null where either is missing.
json EdgeErrorJson(const ServoModel& model, const std::optional<SeenEdge>& seen,
                   const std::optional<SeenEdge>& goal) {
  if (!seen || !goal) return nullptr;
  return std::sqrt(EdgeError(model, *seen, *goal).squares);
}

json DirectionErrorJson(const ServoGoal& goal, size_t leg,
                        const std::array<std::optional<SeenEdge>, 2>& seen) {
  if (!seen[0] || !seen[1] || !goal.directions[leg]) return nullptr;
  return std::sqrt(DirectionError(goal, *seen[0], *seen[1]).squares);
}

// Columns of numbers, one entry a cycle.
class CycleColumns {
 public:
  CycleColumns(const ServoSetup& setup, double start_s) : setup_(setup), start_s_(start_s) {}

  void Add(const LoggedCycle& logged) {
    AddNumbers(logged.cycle);
    const EdgesByLeg seen = ByLeg(logged.cycle.input.seen);
    json edges = json::array(), directions = json::array();
    for (size_t leg = 0; leg < kLegCount; ++leg) {
      for (size_t edge = 0; edge < 2; ++edge)
        edges.push_back(EdgeErrorJson(setup_.model, seen[leg][edge], setup_.goal.edges[leg][edge]));
      directions.push_back(DirectionErrorJson(setup_.goal, leg, seen[leg]));
    }
    columns["edge_errors_px"].push_back(edges);
    columns["direction_errors_rad"].push_back(directions);
    columns["poses"].push_back(PoseJson(logged.cycle.output.step.law.base_from_platform));
    if (logged.true_base_from_platform)
      columns["true_poses"].push_back(PoseJson(*logged.true_base_from_platform));
  }

  json columns = json::object();

 private:
  void AddNumbers(const ServoCycle& cycle) {
    const ServoStep& step = cycle.output.step;
    const auto add = [this](const char* name, double value) { columns[name].push_back(OrNull(value)); };
    add("time_s", cycle.input.time_s - start_s_);
    add("error", step.law.error);
    add("tolerance", cycle.output.verdict.tolerance);
    add("edge_error_px", step.law.edge_error_px);
    add("direction_error_rad", step.law.direction_error_rad);
    add("gain_per_s", step.gain_per_s);
    add("conditioning", step.law.Conditioning());
    add("motion_sigma_m", step.law.motion_sigma_m);
    add("robot_conditioning", step.law.robot_conditioning);
    add("speed_factor", step.speed_factor);
    add("singularity_factor", step.singularity_factor);
    add("look_s", cycle.look_s);
    add("law_s", cycle.law_s);
    columns["edges"].push_back(cycle.input.seen.edges.size());
    columns["limits"].push_back(DescribeLimits(step));
    columns["joint_speeds_m_per_s"].push_back(Numbers(cycle.output.joint_speeds_m_per_s));
    columns["joint_readings_m"].push_back(Numbers(cycle.input.readings.joint_readings_m));
  }

  const ServoSetup& setup_;
  double start_s_;
};

// The image of an edge between its ends, through the lens.
json EdgeCurveJson(const Camera& camera, const SeenEdge& edge) {
  constexpr int kPoints = 9;
  json points = json::array();
  for (int i = 0; i < kPoints; ++i) {
    const double share = static_cast<double>(i) / (kPoints - 1);
    Eigen::Vector2d x = edge.ends[0] + share * (edge.ends[1] - edge.ends[0]);
    const Eigen::Vector2d line = edge.normal.head<2>();
    x -= line * edge.normal.dot(x.homogeneous()) / line.squaredNorm();
    points.push_back(Numbers(ProjectNormalised(camera, x)));
  }
  return {{"leg", edge.leg + 1}, {"edge", edge.edge + 1}, {"points", points}};
}

json PictureJson(const PreparedServo& prepared, const FinishedServo& finished, const RunPicture& picture) {
  const Camera& camera = prepared.setup.model.camera;
  const CycleInput& input = finished.log.cycles[picture.cycle].cycle.input;
  json current = json::array(), desired = json::array();
  for (const SeenEdge& edge : input.seen.edges) current.push_back(EdgeCurveJson(camera, edge));
  for (const auto& leg : prepared.setup.goal.edges)
    for (const auto& edge : leg)
      if (edge) desired.push_back(EdgeCurveJson(camera, *edge));
  return {{"label", picture.label},
          {"time_s", input.seen.time_s - finished.log.cycles.front().cycle.input.time_s},
          {"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"image", picture.image ? json(EmbedPicture(*picture.image)) : json()},
          {"current", current},
          {"desired", desired}};
}

std::string GainText(const AdaptiveGain& gain) {
  if (gain.at_zero_per_s == gain.at_infinity_per_s) return fmt::format("{:g} 1/s", gain.at_zero_per_s);
  return fmt::format("{:g} 1/s at the goal, {:g} 1/s from afar, slope {:g} 1/s per m", gain.at_zero_per_s,
                     gain.at_infinity_per_s, gain.slope_at_zero);
}

json SettingsJson(const PreparedServo& prepared) {
  const ServoOptions& options = prepared.setup.options;
  const ControlLawOptions& law = options.step.law;
  return {{"mode", ToString(law.mode)},
          {"legs", LegList(law.legs)},
          {"pose from", law.pose_source == PoseSource::kEdges ? "edges" : "joint readings"},
          {"directions from", law.direction_source == DirectionSource::kEdges ? "edges" : "model"},
          {"weights", law.is_weighted ? "each edge's covariance" : "all alike"},
          {"damping", fmt::format("{:g}", law.inverse.damping)},
          {"truncation", fmt::format("{:g}", law.inverse.truncation)},
          {"gain", GainText(options.step.gain)},
          {"speed limit", fmt::format("{:g} mm/s", 1e3 * options.step.limits.speed_limit_m_per_s)},
          {"margin of the joint ranges", fmt::format("{:g} mm", 1e3 * options.step.limits.range_margin_m)},
          {"oldest image and readings", fmt::format("{:g} s", options.supervision.stale_s)},
          {"time limit", fmt::format("{:g} s", options.supervision.timeout_s)},
          {"period", fmt::format("{:g} s", prepared.setup.period_s)},
          {"edges", prepared.settings.is_image_free ? "simulated without images" : "from images"}};
}

}  // namespace

json ServoReportData(const PreparedServo& prepared, const FinishedServo& finished,
                     const nlohmann::ordered_json& document) {
  const ServoGoal& goal = prepared.setup.goal;
  const auto& cycles = finished.log.cycles;
  CycleColumns columns(prepared.setup, cycles.empty() ? 0 : cycles.front().cycle.input.time_s);
  for (const LoggedCycle& logged : cycles) columns.Add(logged);
  json pictures = json::array();
  for (const RunPicture& picture : finished.pictures)
    pictures.push_back(PictureJson(prepared, finished, picture));
  return {{"title", fmt::format("Servo by {}", ToString(prepared.setup.options.step.law.mode))},
          {"program_version", ProgramVersion()},
          {"model", prepared.settings.model.string()},
          {"rig", prepared.settings.rig},
          {"log", prepared.settings.log.string()},
          {"document", document},
          {"settings", SettingsJson(prepared)},
          {"robot",
           RobotJson(prepared.setup.model.robot, prepared.setup.options.step.limits.speed_limit_m_per_s)},
          {"goal",
           {{"base_from_platform", goal.base_from_platform ? PoseJson(*goal.base_from_platform) : json()},
            {"joint_readings_m", goal.joint_readings_m ? json(List(*goal.joint_readings_m)) : json()}}},
          {"cycles", columns.columns},
          {"pictures", pictures}};
}

}  // namespace legible
