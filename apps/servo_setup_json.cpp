#include "apps/servo_setup_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "apps/calibrate_settings.h"
#include "apps/json_text.h"
#include "apps/program.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

// ---- Values both ways.

ordered_json ToJson(double value) { return value; }
ordered_json ToJson(bool value) { return value; }
template <int N>
ordered_json ToJson(const Eigen::Matrix<double, N, 1>& value) {
  return List(value);
}
ordered_json ToJson(const std::array<double, 2>& value) { return value; }
ordered_json ToJson(const Eigen::Matrix3d& value) {
  return std::vector<double>(value.data(), value.data() + value.size());  // by columns
}
ordered_json ToJson(const Rigid3& value) {
  return {{"rotation_xyzw", List(value.rotation.coeffs())}, {"translation_m", List(value.translation)}};
}

void FromJson(const ordered_json& json, double& value) { value = json.get<double>(); }
void FromJson(const ordered_json& json, bool& value) { value = json.get<bool>(); }
void FromJson(const ordered_json& json, std::array<double, 2>& value) {
  value = json.get<std::array<double, 2>>();
}
void FromNumbers(const ordered_json& json, double* values, Eigen::Index count) {
  const auto numbers = json.get<std::vector<double>>();
  if (numbers.size() != static_cast<size_t>(count)) throw std::invalid_argument("a list of another length");
  std::copy(numbers.begin(), numbers.end(), values);
}
template <int N>
void FromJson(const ordered_json& json, Eigen::Matrix<double, N, 1>& value) {
  FromNumbers(json, value.data(), value.size());
}
void FromJson(const ordered_json& json, Eigen::Matrix3d& value) {
  FromNumbers(json, value.data(), value.size());
}
void FromJson(const ordered_json& json, Rigid3& value) {
  FromNumbers(json.at("rotation_xyzw"), value.rotation.coeffs().data(), 4);
  FromNumbers(json.at("translation_m"), value.translation.data(), 3);
}

// ---- Structs by the names of their members, for writing and reading alike.

class Writer {
 public:
  template <typename T>
  void operator()(const char* name, const T& value) {
    json[name] = ToJson(value);
  }
  ordered_json json = ordered_json::object();
};

class Reader {
 public:
  explicit Reader(const ordered_json& from) : json_(from) {}
  template <typename T>
  void operator()(const char* name, T& value) {
    FromJson(json_.at(name), value);
  }

 private:
  const ordered_json& json_;
};

template <typename Visitor, typename T>
void VisitLeg(Visitor& visit, T& leg) {
  visit("base_joint_m", leg.base_joint_m);
  visit("platform_joint_m", leg.platform_joint_m);
  visit("radius_m", leg.radius_m);
  visit("joint_offset_m", leg.joint_offset_m);
  visit("joint_range_m", leg.joint_range_m);
}

template <typename Visitor, typename T>
void VisitCamera(Visitor& visit, T& camera) {
  visit("fx_px", camera.fx_px);
  visit("fy_px", camera.fy_px);
  visit("cx_px", camera.cx_px);
  visit("cy_px", camera.cy_px);
  visit("distortion", camera.distortion);
}

template <typename Visitor, typename T>
void VisitEdge(Visitor& visit, T& edge) {
  visit("normal", edge.normal);
  visit("normal_covariance", edge.normal_covariance);
  visit("begin", edge.ends[0]);
  visit("end", edge.ends[1]);
}

template <typename Visitor, typename T>
void VisitOptions(Visitor& visit, T& options) {
  visit("is_weighted", options.step.law.is_weighted);
  visit("truncation", options.step.law.inverse.truncation);
  visit("damping", options.step.law.inverse.damping);
  visit("most_motion_sigma", options.step.law.most_motion_sigma);
  visit("least_conditioning", options.step.law.least_conditioning);
  visit("least_robot_conditioning", options.step.law.least_robot_conditioning);
  visit("gain_at_zero_per_s", options.step.gain.at_zero_per_s);
  visit("gain_at_infinity_per_s", options.step.gain.at_infinity_per_s);
  visit("gain_slope_at_zero", options.step.gain.slope_at_zero);
  visit("speed_limit_m_per_s", options.step.limits.speed_limit_m_per_s);
  visit("range_margin_m", options.step.limits.range_margin_m);
  visit("look_ahead_s", options.step.limits.look_ahead_s);
  visit("slow_conditioning", options.step.slow_conditioning);
  visit("tolerance", options.supervision.tolerance);
  visit("tolerance_in_noise", options.supervision.tolerance_in_noise);
  visit("dwell_s", options.supervision.dwell_s);
  visit("stale_s", options.supervision.stale_s);
  visit("unusable_s", options.supervision.unusable_s);
  visit("unanswered_m", options.supervision.unanswered_m);
  visit("growth_factor", options.supervision.growth_factor);
  visit("growth_tolerances", options.supervision.growth_tolerances);
  visit("growth_s", options.supervision.growth_s);
  visit("stall_s", options.supervision.stall_s);
  visit("stall_share", options.supervision.stall_share);
  visit("timeout_s", options.supervision.timeout_s);
}

// ---- Enumerators by their names.

template <typename E>
struct NamedValue {
  E value;
  const char* name;
};
const std::vector<NamedValue<ControlMode>> kModes = {{ControlMode::kEdges, "edges"},
                                                     {ControlMode::kDirections, "directions"},
                                                     {ControlMode::kPose, "pose"},
                                                     {ControlMode::kJoints, "joints"}};
const std::vector<NamedValue<PoseSource>> kPoseSources = {{PoseSource::kReadings, "readings"},
                                                          {PoseSource::kEdges, "edges"}};
const std::vector<NamedValue<DirectionSource>> kDirectionSources = {{DirectionSource::kEdges, "edges"},
                                                                    {DirectionSource::kModel, "model"}};

template <typename E>
std::string NameOf(const std::vector<NamedValue<E>>& names, E value) {
  for (const NamedValue<E>& named : names)
    if (named.value == value) return named.name;
  throw std::invalid_argument("NameOf: an enumerator without a name");
}

template <typename E>
E ValueOf(const std::vector<NamedValue<E>>& names, const ordered_json& json) {
  const auto name = json.get<std::string>();
  for (const NamedValue<E>& named : names)
    if (named.name == name) return named.value;
  throw std::invalid_argument("\"" + name + "\" is not known");
}

ordered_json OptionsToJson(const ServoOptions& options) {
  Writer write;
  const ControlLawOptions& law = options.step.law;
  write.json["mode"] = NameOf(kModes, law.mode);
  write.json["pose_source"] = NameOf(kPoseSources, law.pose_source);
  write.json["direction_source"] = NameOf(kDirectionSources, law.direction_source);
  write.json["legs"] = ordered_json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg)
    if (law.legs[leg]) write.json["legs"].push_back(leg + 1);
  VisitOptions(write, options);
  return write.json;
}

ServoOptions OptionsFromJson(const ordered_json& json) {
  ServoOptions options;
  ControlLawOptions& law = options.step.law;
  law.mode = ValueOf(kModes, json.at("mode"));
  law.pose_source = ValueOf(kPoseSources, json.at("pose_source"));
  law.direction_source = ValueOf(kDirectionSources, json.at("direction_source"));
  law.legs.reset();
  for (const ordered_json& leg : json.at("legs")) {
    if (leg.get<int>() < 1 || leg.get<int>() > kLegCount)
      throw std::invalid_argument("legs count from 1 to 6");
    law.legs.set(leg.get<size_t>() - 1);
  }
  Reader read(json);
  VisitOptions(read, options);
  options.Check();
  return options;
}

ordered_json ModelToJson(const ServoModel& model) {
  ordered_json legs = ordered_json::array();
  for (const Leg& leg : model.robot.legs) {
    Writer write;
    VisitLeg(write, leg);
    legs.push_back(write.json);
  }
  Writer camera;
  VisitCamera(camera, model.camera);
  camera.json["width_px"] = model.camera.width_px;
  camera.json["height_px"] = model.camera.height_px;
  camera.json["lens"] = LensName(model.camera.lens);
  return {{"robot", {{"name", model.robot.name}, {"home", ToJson(model.robot.home)}, {"legs", legs}}},
          {"camera", camera.json},
          {"camera_from_base", ToJson(model.camera_from_base)}};
}

ServoModel ModelFromJson(const ordered_json& json) {
  GoughStewart robot;
  robot.name = json.at("robot").at("name").get<std::string>();
  FromJson(json.at("robot").at("home"), robot.home);
  for (size_t i = 0; i < kLegCount; ++i) {
    Reader read(json.at("robot").at("legs").at(i));
    VisitLeg(read, robot.legs[i]);
  }
  const ordered_json& camera_json = json.at("camera");
  Camera camera;
  Reader read(camera_json);
  VisitCamera(read, camera);
  camera.width_px = camera_json.at("width_px").get<int>();
  camera.height_px = camera_json.at("height_px").get<int>();
  const std::optional<LensModel> lens = LensFromName(camera_json.at("lens").get<std::string>());
  if (!lens) throw std::invalid_argument("a lens model that is not known");
  camera.lens = *lens;
  Rigid3 camera_from_base;
  FromJson(json.at("camera_from_base"), camera_from_base);
  return MakeServoModel(robot, camera, camera_from_base);
}

ordered_json GoalToJson(const ServoGoal& goal) {
  ordered_json edges = ordered_json::array(), directions = ordered_json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    for (size_t edge = 0; edge < 2; ++edge) {
      if (!goal.edges[leg][edge]) continue;
      Writer write;
      write.json["leg"] = leg + 1;
      write.json["edge"] = edge + 1;
      VisitEdge(write, *goal.edges[leg][edge]);
      edges.push_back(write.json);
    }
    directions.push_back(goal.directions[leg] ? ToJson(*goal.directions[leg]) : ordered_json());
  }
  return {{"edges", edges},
          {"directions", directions},
          {"base_from_platform", goal.base_from_platform ? ToJson(*goal.base_from_platform) : ordered_json()},
          {"joint_readings_m", goal.joint_readings_m ? ToJson(*goal.joint_readings_m) : ordered_json()}};
}

template <typename T>
void FromJsonOrNull(const ordered_json& json, std::optional<T>& value) {
  if (!json.is_null()) FromJson(json, value.emplace());
}

ServoGoal GoalFromJson(const ordered_json& json) {
  ServoGoal goal;
  for (const ordered_json& entry : json.at("edges")) {
    SeenEdge edge;
    edge.leg = entry.at("leg").get<int>() - 1;
    edge.edge = entry.at("edge").get<int>() - 1;
    Reader read(entry);
    VisitEdge(read, edge);
    goal.edges.at(static_cast<size_t>(edge.leg)).at(static_cast<size_t>(edge.edge)) = edge;
  }
  for (size_t leg = 0; leg < kLegCount; ++leg)
    FromJsonOrNull(json.at("directions").at(leg), goal.directions[leg]);
  FromJsonOrNull(json.at("base_from_platform"), goal.base_from_platform);
  FromJsonOrNull(json.at("joint_readings_m"), goal.joint_readings_m);
  return goal;
}

}  // namespace

ordered_json SetupToJson(const ServoSetup& setup) {
  return {{"schema", kServoLogSchema},         {"provenance", setup.provenance},
          {"period_s", setup.period_s},        {"options", OptionsToJson(setup.options)},
          {"model", ModelToJson(setup.model)}, {"goal", GoalToJson(setup.goal)}};
}

ServoSetup SetupFromJson(const ordered_json& document) {
  if (const int schema = document.at("schema").get<int>(); schema != kServoLogSchema)
    throw std::invalid_argument(
        fmt::format("schema {}, and this program, {}, knows schema {}: replay it by the "
                    "program that wrote it",
                    schema, ProgramVersion(), kServoLogSchema));
  ServoSetup setup;
  setup.provenance = document.at("provenance").get<std::map<std::string, std::string>>();
  setup.period_s = document.at("period_s").get<double>();
  setup.options = OptionsFromJson(document.at("options"));
  setup.model = ModelFromJson(document.at("model"));
  setup.goal = GoalFromJson(document.at("goal"));
  return setup;
}

}  // namespace legible
