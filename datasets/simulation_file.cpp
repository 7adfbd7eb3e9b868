#include "datasets/simulation_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "datasets/atomic_file.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

template <typename Options>
void ReadNumbers(const YamlValue& section, const std::vector<NumberField<Options>>& fields,
                 Options& options) {
  for (const NumberField<Options>& field : fields) {
    const std::optional<YamlValue> value = section.Find(field.name);
    if (!value) continue;
    const double number = value->Number();
    if (number < field.lowest || number > field.highest)
      value->Fail(fmt::format("is {}", number),
                  fmt::format("give a number from {} to {}", field.lowest, field.highest));
    options.*field.value = number;
  }
}

template <typename Options>
std::vector<std::string> NamesOf(const std::vector<NumberField<Options>>& fields) {
  std::vector<std::string> names;
  names.reserve(fields.size());
  for (const NumberField<Options>& field : fields) names.push_back(field.name);
  return names;
}

DriveOptions DrivesFromYaml(const YamlValue& section) {
  section.AllowKeys(NamesOf(kDriveFields));
  DriveOptions drives;
  ReadNumbers(section, kDriveFields, drives);
  if (drives.sliding_loss_m_per_s > drives.breakaway_speed_m_per_s)
    section.Get("sliding_loss_m_per_s")
        .Fail(fmt::format("is {}, and breakaway_speed_m_per_s is {}", drives.sliding_loss_m_per_s,
                          drives.breakaway_speed_m_per_s),
              "give a breakaway speed that is not less than what sliding loses");
  return drives;
}

SceneOptions SceneFromYaml(const YamlValue& section) {
  std::vector<std::string> keys = NamesOf(kSceneFields);
  keys.emplace_back("light_in_camera");
  section.AllowKeys(keys);
  SceneOptions scene;
  ReadNumbers(section, kSceneFields, scene);
  if (const auto light = section.Find("light_in_camera")) {
    scene.light_in_camera = light->Vector3();
    if (!(scene.light_in_camera.norm() > 0))
      light->Fail("has no direction", "give a vector that points to the light");
  }
  return scene;
}

FaultKind FaultKindFromYaml(const YamlValue& value) {
  const std::string text = value.Text();
  std::vector<std::string> names;
  for (const auto& [kind, name] : kFaultNames) {
    if (name == text) return kind;
    names.push_back(name);
  }
  value.Fail(fmt::format("is \"{}\", a fault not known here", text),
             fmt::format("the nearest known one is \"{}\"", NearestName(text, names)));
}

const std::string& NameOf(FaultKind kind) {
  return std::find_if(kFaultNames.begin(), kFaultNames.end(),
                      [&](const auto& entry) { return entry.first == kind; })
      ->second;
}

void AllowOnlyFor(FaultKind owner, const char* key, FaultKind kind, const YamlValue& section) {
  const std::optional<YamlValue> value = section.Find(key);
  if (kind == owner || !value) return;
  value->Fail("has no meaning for " + NameOf(kind), "only " + NameOf(owner) + " has it: take it out");
}

Fault FaultFromYaml(const YamlValue& section) {
  section.AllowKeys({"kind", "from_s", "until_s", "leg", "delay_s"});
  Fault fault;
  fault.kind = FaultKindFromYaml(section.Get("kind"));
  AllowOnlyFor(FaultKind::kLegCovered, "leg", fault.kind, section);
  AllowOnlyFor(FaultKind::kFramesLate, "delay_s", fault.kind, section);
  ReadNumbers(section, kFaultFields, fault);
  if (fault.from_s >= fault.until_s)
    section.Fail(fmt::format("lasts from {} s until {} s", fault.from_s, fault.until_s),
                 "give an until_s later than from_s");
  if (fault.kind != FaultKind::kLegCovered) return fault;
  const YamlValue leg = section.Get("leg");
  fault.leg = leg.Integer() - 1;
  if (fault.leg < 0 || fault.leg >= kLegCount)
    leg.Fail(fmt::format("is {}", leg.Integer()), fmt::format("give 1 to {}", kLegCount));
  return fault;
}

std::uint64_t SeedFromYaml(const YamlValue& value) {
  const std::string text = value.Text();
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    value.Fail(fmt::format("is \"{}\"", text), "give a whole number from 0 to 2^64 - 1");
  return seed;
}

SimulationOptions OptionsFromYaml(const YamlValue& section) {
  std::vector<std::string> keys = NamesOf(kSimulationFields);
  keys.insert(keys.end(), {"seed", "start", "drives", "scene", "faults", "drawing"});
  section.AllowKeys(keys);
  SimulationOptions options;
  ReadNumbers(section, kSimulationFields, options);
  if (const auto seed = section.Find("seed")) options.seed = SeedFromYaml(*seed);
  if (const auto start = section.Find("start")) options.start = start->Rigid();
  if (const auto drives = section.Find("drives")) options.drives = DrivesFromYaml(*drives);
  if (const auto scene = section.Find("scene")) options.scene = SceneFromYaml(*scene);
  if (const auto faults = section.Find("faults"))
    for (const YamlValue& fault : faults->List()) options.faults.push_back(FaultFromYaml(fault));
  return options;
}

void DemandInRange(const YamlValue& pose, const GoughStewart& robot, const Rigid3& base_from_platform) {
  const Vector6d readings_m = InverseKinematics(robot, base_from_platform);
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] >= shortest_m && readings_m[i] <= longest_m) continue;
    pose.Fail(fmt::format("has joint {} at {:.6g} m, outside its range of {} to {} m", i + 1, readings_m[i],
                          shortest_m, longest_m),
              "give a pose that the robot can take, for the rig starts there");
  }
}

void DemandStartInRange(const YamlValue& root, const SimulatedTruth& simulated) {
  const GoughStewart& robot = simulated.truth.robot;
  if (simulated.options.start)
    DemandInRange(root.Get("simulation").Get("start"), robot, *simulated.options.start);
  else
    DemandInRange(root.Get("robot").Get("home"), robot, robot.home);
}

std::optional<std::filesystem::path> DrawingFromYaml(const YamlValue& drawing, const std::string& key,
                                                     const std::filesystem::path& folder) {
  const std::optional<YamlValue> value = drawing.Find(key);
  if (!value) return std::nullopt;
  std::filesystem::path file = folder / value->Text();
  if (!std::filesystem::is_regular_file(file))
    value->Fail(fmt::format("is \"{}\", which is no file", value->Text()),
                "give a path relative to this file's folder");
  return file;
}

template <typename Options>
std::string NumbersToYaml(const Options& options, const std::vector<NumberField<Options>>& fields) {
  std::string text;
  for (const NumberField<Options>& field : fields)
    text += fmt::format("{}: {}\n", field.name, NumberText(options.*field.value));
  return text;
}

std::string FaultToYaml(const Fault& fault) {
  std::string text = fmt::format("- {{kind: {}, from_s: {}, until_s: {}", NameOf(fault.kind),
                                 NumberText(fault.from_s), NumberText(fault.until_s));
  if (fault.kind == FaultKind::kLegCovered) text += fmt::format(", leg: {}", fault.leg + 1);
  if (fault.kind == FaultKind::kFramesLate) text += fmt::format(", delay_s: {}", NumberText(fault.delay_s));
  return text + "}\n";
}

std::string DrawingToYaml(const SimulatedTruth& simulated, const std::filesystem::path& folder) {
  std::string text;
  const auto add = [&](const char* key, const std::optional<std::filesystem::path>& file) {
    if (!file) return;
    const auto relative = std::filesystem::absolute(*file).lexically_proximate(folder);
    text += fmt::format("{}: {}\n", key, QuotedText(relative.string()));
  };
  add("robot", simulated.drawing_robot);
  add("camera", simulated.drawing_camera);
  return text.empty() ? text : "drawing:\n" + Indented(text);
}

std::string OptionsToYaml(const SimulationOptions& options) {
  std::string text = NumbersToYaml(options, kSimulationFields) + fmt::format("seed: {}\n", options.seed);
  if (options.start) text += fmt::format("start: {}\n", RigidText(*options.start));
  text += "drives:\n" + Indented(NumbersToYaml(options.drives, kDriveFields));
  text +=
      "scene:\n" + Indented(NumbersToYaml(options.scene, kSceneFields) +
                            fmt::format("light_in_camera: {}\n", ListText(options.scene.light_in_camera)));
  if (options.faults.empty()) return text;
  text += "faults:\n";
  for (const Fault& fault : options.faults) text += Indented(FaultToYaml(fault));
  return text;
}

}  // namespace

SimulatedTruth ReadTruth(const std::filesystem::path& file) {
  const CalibratedModel model = ReadModel(file);
  if (!model.camera || !model.camera_from_base)
    throw InputError(file, 0, fmt::format("has no \"{}\"", model.camera ? "camera_from_base" : "camera"),
                     "give a model.yaml with camera and camera_from_base, for a simulated rig has both");
  SimulatedTruth simulated;
  simulated.truth = {model.robot, *model.camera, *model.camera_from_base};
  const YamlValue root = YamlValue::LoadFile(file);
  if (const auto section = root.Find("simulation")) {
    simulated.options = OptionsFromYaml(*section);
    if (const auto drawing = section->Find("drawing")) {
      drawing->AllowKeys({"robot", "camera"});
      simulated.drawing_robot = DrawingFromYaml(*drawing, "robot", file.parent_path());
      simulated.drawing_camera = DrawingFromYaml(*drawing, "camera", file.parent_path());
    }
  }
  DemandStartInRange(root, simulated);
  return simulated;
}

void WriteTruth(const std::filesystem::path& file, const SimulatedTruth& simulated) {
  simulated.options.Check();
  CalibratedModel model;
  model.robot = simulated.truth.robot;
  model.camera = simulated.truth.camera;
  model.camera_from_base = simulated.truth.camera_from_base;
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  WriteFileAtomically(file,
                      ModelToYaml(model) + "simulation:\n" +
                          Indented(OptionsToYaml(simulated.options) + DrawingToYaml(simulated, folder)));
}

}  // namespace legible
