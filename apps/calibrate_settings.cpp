#include "apps/calibrate_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "datasets/text.h"

namespace legible {
namespace {

template <typename Value>
using Names = std::vector<std::pair<std::string, Value>>;

const Names<LensModel> kLenses = {{"pinhole", LensModel::kPinhole},
                                  {"brown-conrady", LensModel::kBrownConrady},
                                  {"rational", LensModel::kRational},
                                  {"fisheye", LensModel::kFisheye}};

template <typename Value>
std::vector<std::string> NamesOf(const Names<Value>& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.push_back(name);
  return names;
}

template <typename Value>
std::optional<Value> Find(const Names<Value>& table, const std::string& name) {
  const auto entry = std::find_if(table.begin(), table.end(), [&](const auto& e) { return e.first == name; });
  return entry == table.end() ? std::nullopt : std::optional<Value>(entry->second);
}

constexpr char kCameraKnown[] = "camera";  // what a board told of it; can only be forgotten

HeldParameters HeldBy(const CalibrateSettings& settings) {
  HeldParameters held;
  for (const std::string& name : settings.hold) held.*Find(kHoldFields, name).value() = true;
  return held;
}

bool UsesReadings(const CalibrateSettings& settings) { return settings.use_readings && !settings.free_legs; }

// Whether something but the readings says how large the robot is.
bool KnowsASize(const CalibrateSettings& settings, const PriorKnowledge& known) {
  const HeldParameters held = HeldBy(settings);
  return !settings.tags.empty() || known.radius_m || known.base_joint_m || known.platform_joint_m ||
         held.radii || held.base_joints || held.platform_joints;
}

}  // namespace

std::vector<std::string> LensNames() { return NamesOf(kLenses); }
std::vector<std::string> HoldNames() { return NamesOf(kHoldFields); }
std::vector<std::string> KnownNames() {
  std::vector<std::string> names = NamesOf(kKnownFields);
  names.emplace_back(kCameraKnown);
  return names;
}
std::optional<LensModel> LensFromName(const std::string& name) { return Find(kLenses, name); }

std::string LensName(LensModel lens) {
  for (const auto& [name, value] : kLenses)
    if (value == lens) return name;
  throw std::invalid_argument("LensName: not a lens model");
}

std::pair<std::string, std::optional<double>> ParseKnown(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (name == kCameraKnown) {
    if (text.substr(std::min(equals, text.size() - 1) + 1) == "none") return {name, std::nullopt};
    throw std::invalid_argument("camera can only be none: how well a board told it stands in its file");
  }
  if (!Find(kKnownFields, name))
    throw std::invalid_argument(fmt::format("\"{}\" is none of {}", name, fmt::join(KnownNames(), ", ")));
  if (equals == std::string::npos)
    throw std::invalid_argument(
        fmt::format("\"{}\" has no value: give {}=SIGMA or {}=none", text, name, name));
  const std::string value = text.substr(equals + 1);
  if (value == "none") return {name, std::nullopt};
  const std::optional<double> sigma = ParseFinite(value);
  if (!sigma || *sigma < kLeastKnownSigma)
    throw std::invalid_argument(fmt::format(
        "{} is \"{}\", which is neither a number from {} nor none (what is known exactly is held with "
        "--hold)",
        name, value, kLeastKnownSigma));
  return {name, sigma};
}

bool ForgetsCamera(const std::vector<std::pair<std::string, std::optional<double>>>& known) {
  return std::any_of(known.begin(), known.end(), [](const auto& one) { return one.first == kCameraKnown; });
}

PriorKnowledge WithSettings(const PriorKnowledge& session, const CalibrateSettings& settings) {
  PriorKnowledge known = settings.free_legs ? PriorKnowledge{} : session;
  if (ForgetsCamera(settings.known)) known.camera_information.resize(0, 0);
  for (const auto& [name, sigma] : settings.known)
    if (const auto field = Find(kKnownFields, name)) known.** field = sigma;
  return known;
}

std::vector<std::pair<std::string, double>> NamedKnowledge(const PriorKnowledge& known) {
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [name, field] : kKnownFields)
    if (known.*field) named.emplace_back(name, *(known.*field));
  return named;
}

bool AssumesRigidPlatform(const CalibrateSettings& settings, const PriorKnowledge& known) {
  return UsesReadings(settings) || (!settings.free_legs && KnowsASize(settings, known));
}

std::string AssumptionText(const CalibrateSettings& settings, const PriorKnowledge& known) {
  if (UsesReadings(settings)) return "The joint readings and one rigid platform tie the legs together.";
  if (AssumesRigidPlatform(settings, known))
    return "The joint readings are left out; one rigid platform ties the legs together.";
  const std::string edges_only =
      "Edges only: nothing ties the legs together, each one's direction is free in each image";
  return edges_only +
         (settings.free_legs ? "." : ", for without joint readings nothing known sets their scale.");
}

std::set<std::string> TagGroupsOf(const CalibrateSettings& settings, const Session& session) {
  if (settings.tags.empty()) return {};
  if (!session.tags || session.tags->groups.empty()) throw std::invalid_argument("the session has no tags");
  std::vector<std::string> names;
  std::set<std::string> usable, chosen;
  for (const TagGroup& group : session.tags->groups) {
    names.push_back(group.name);
    if (!settings.free_legs || group.carrier == TagCarrier::kBase) usable.insert(group.name);
  }
  for (const std::string& name : settings.tags) {
    if (name == "all") {
      chosen.insert(usable.begin(), usable.end());
    } else if (usable.contains(name)) {
      chosen.insert(name);
    } else if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw std::invalid_argument(
          fmt::format("\"{}\" is on the platform, which with --free-legs is not taken to be rigid", name));
    } else {
      throw std::invalid_argument(
          fmt::format("\"{}\" is none of the session's groups {}", name, fmt::join(names, ", ")));
    }
  }
  if (chosen.empty())
    throw std::invalid_argument("with --free-legs only tags on the base count, and it has none there");
  return chosen;
}

SessionCalibrationOptions ToOptions(const CalibrateSettings& settings, const Session& session) {
  SessionCalibrationOptions options;
  const PriorKnowledge& known = session.known;
  options.tag_groups = TagGroupsOf(settings, session);
  options.estimation.use_joint_readings = UsesReadings(settings);
  options.estimation.rigid_platform = AssumesRigidPlatform(settings, known);
  options.estimation.hold = HeldBy(settings);
  options.estimation.threads = settings.threads;
  options.lens = settings.lens;
  options.folds = settings.folds;
  options.seed = settings.seed;
  options.threads = settings.threads;
  return options;
}

std::string OptionsText(const CalibrateSettings& settings) {
  std::vector<std::string> words;
  if (settings.lens) words.push_back("--lens " + LensName(*settings.lens));
  if (!settings.hold.empty()) words.push_back(fmt::format("--hold {}", fmt::join(settings.hold, ",")));
  for (const auto& [name, sigma] : settings.known)
    words.push_back(fmt::format("--known {}={}", name, sigma ? fmt::to_string(*sigma) : "none"));
  if (!settings.tags.empty()) words.push_back(fmt::format("--tags {}", fmt::join(settings.tags, ",")));
  if (settings.board) {
    std::string images = "--with-board";
    for (const std::filesystem::path& path : settings.board_images) images += " " + path.string();
    words.push_back(fmt::format("{} --board {}", images, settings.board->string()));
    for (const std::string& word : OptionWords(settings.board_fit)) words.push_back(word);
  }
  if (!settings.use_readings) words.push_back("--no-readings");
  if (settings.free_legs) words.push_back("--free-legs");
  if (settings.folds != CalibrateSettings().folds) words.push_back(fmt::format("--folds {}", settings.folds));
  if (settings.seed) words.push_back(fmt::format("--seed {}", *settings.seed));
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, " "));
}

}  // namespace legible
