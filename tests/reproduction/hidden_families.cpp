#include "tests/reproduction/hidden_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/hidden/assembly_modes.h"
#include "core/hidden/controllability.h"
#include "core/hidden/hidden_leg.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

constexpr unsigned kSeed = 2016;
constexpr int kRobots = 2000;

using Robots = std::function<RobotAtPose(std::mt19937_64& random)>;

struct Family {
  std::string name;
  std::string published;  // most assembly modes
  Robots make;
  std::vector<int> legs;  // seen, from 0
};

std::vector<std::string> Times(int count, const std::string& chain) {
  return std::vector<std::string>(static_cast<size_t>(count), chain);
}

Robots Planar(int legs, const std::string& chain) {
  return [=](std::mt19937_64& random) { return RandomPlanarRobot(random, Times(legs, chain)); };
}

std::vector<Family> Families() {
  std::vector<Family> families;
  for (const char* chain : {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR", "P_RR"}) {
    const std::string name = std::string("2-") + chain;
    families.push_back({name + ", point of the plane", "2", Planar(2, chain), {0, 1}});
  }
  for (const char* chain : {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR", "P_RR"}) {
    const bool has_circles =
        std::string(chain).find("RRR") != std::string::npos || std::string(chain) == "R_RR";
    families.push_back({std::string("3-") + chain, has_circles ? "6" : "2", Planar(3, chain), {0, 1, 2}});
  }
  const auto spatial = [](std::mt19937_64& random) { return RandomSpatialRobot(random, Times(6, "U_PS")); };
  families.push_back({"6-U_PS, legs 1, 2, 3", "8", spatial, {0, 1, 2}});
  const auto rps = [](std::mt19937_64& random) { return RandomSpatialRobot(random, Times(3, "R_PS")); };
  families.push_back({"3-R_PS", "", rps, {0, 1, 2}});
  const auto rus = [](std::mt19937_64& random) { return RandomSpatialRobot(random, Times(6, "_RUS")); };
  families.push_back({"6-_RUS, legs 1, 2, 3", "", rus, {0, 1, 2}});
  for (const char* chain : {"U_PU", "_R-{2-US}", "_P-{2-US}"}) {
    const auto translation = [chain](std::mt19937_64& random) {
      return RandomTranslationRobot(random, Times(3, chain));
    };
    families.push_back({std::string("3-") + chain + ", legs 1, 2", "", translation, {0, 1}});
  }
  const auto quattro = [](std::mt19937_64& random) { return RandomSchoenfliesRobot(random, "_R-{2-US}"); };
  families.push_back({"4-_R-{2-US}, articulated platform, legs 1, 3", "8", quattro, {0, 2}});
  return families;
}

struct Counts {
  int most = 0, complete = 0, bound = 0;
};

Counts CountModes(const Family& family) {
  std::mt19937_64 random(kSeed);
  Counts counts;
  for (int i = 0; i < kRobots; ++i) {
    const RobotAtPose it = family.make(random);
    const AssemblyModes modes = AssemblyModesOf(it.robot, family.legs, it.pose);
    counts.most = std::max(counts.most, static_cast<int>(modes.modes.size()));
    counts.bound = std::max(counts.bound, modes.most_possible);
    if (modes.status == AssemblyModesStatus::kComplete) ++counts.complete;
  }
  return counts;
}

std::string ChainCell(const LegChain& chain) { return chain.empty() ? "none" : "`" + ToText(chain) + "`"; }

// A robot of section 4.3 and the like, at a pose.
struct Example {
  std::string name;
  RobotAtPose it;
};

RobotAtPose WithParallelRails(RobotAtPose it) {
  for (RobotLeg& leg : it.robot.legs) leg.first_axis = it.robot.legs.front().first_axis;
  return it;
}

// Parallel rails may put the pose out of reach: as many robots are drawn as it takes.
RobotAtPose Reaching(const Robots& make, std::mt19937_64& random) {
  for (;;) {
    RobotAtPose it = make(random);
    if (ControllabilityOf(it.robot, AllLegs(it.robot), it.pose, SeenFeature::kDirections).status !=
        ControllabilityStatus::kUnreachable)
      return it;
  }
}

std::vector<Example> Examples() {
  std::mt19937_64 random(kSeed);
  const auto draw = [&](const Robots& make) { return Reaching(make, random); };
  std::vector<Example> examples;
  for (const char* chain : {"_PPR", "P_PR", "_PRP", "_RRP", "R_RP", "_RRR", "_PRR"})
    examples.push_back({std::string("3-") + chain, draw(Planar(3, chain))});
  examples.push_back({"PRRRP, rails parallel", draw([](std::mt19937_64& g) {
                        return WithParallelRails(RandomPlanarRobot(g, Times(2, "_PRR")));
                      })});
  examples.push_back({"Delta by P joints, rails parallel (UraneSX)", draw([](std::mt19937_64& g) {
                        return WithParallelRails(RandomTranslationRobot(g, Times(3, "_P-{2-US}")));
                      })});
  examples.push_back({"four legs by P joints, rails parallel (I4L)", draw([](std::mt19937_64& g) {
                        return WithParallelRails(RandomSchoenfliesRobot(g, "_P-{2-US}"));
                      })});
  examples.push_back({"Delta by P joints, rails not parallel (Orthoglide)", draw([](std::mt19937_64& g) {
                        return RandomTranslationRobot(g, Times(3, "_P-{2-US}"));
                      })});
  examples.push_back(
      {"6-U_PS", draw([](std::mt19937_64& g) { return RandomSpatialRobot(g, Times(6, "U_PS")); })});
  return examples;
}

std::string Verdict(const Controllability& it) {
  if (it.status == ControllabilityStatus::kControllable) return "yes";
  return fmt::format("no, {} of {}: {}", it.seen_freedoms, it.freedoms, it.why);
}

}  // namespace

std::string HiddenLegsTable() {
  struct Row {
    const char* chain;
    PlatformMotion motion;
    const char* published;
  };
  using enum PlatformMotion;
  const std::vector<Row> rows = {{"_RRR", kPlanar, "ΠRR"},
                                 {"R_RR", kPlanar, "ΠRR"},
                                 {"_RPR", kPlanar, "RPR"},
                                 {"R_PR", kPlanar, "RPR"},
                                 {"_PRR", kPlanar, "PRR"},
                                 {"P_RR", kPlanar, "PRR"},
                                 {"_PPR", kPlanar, "none"},
                                 {"P_PR", kPlanar, "none"},
                                 {"_PRP", kPlanar, "PRP, not controllable"},
                                 {"_RRP", kPlanar, "ΠRRP, not controllable"},
                                 {"U_PS", kSpatial, "UPS"},
                                 {"U_PU", kTranslation, "UPU"},
                                 {"R_PS", kSpatial, "RPS"},
                                 {"_R-{2-US}", kSchoenflies, "Π-{2-US} or Π-{2-UU}"},
                                 {"_RUU", kTranslation, "ΠUU"},
                                 {"_RUS", kSpatial, "ΠUS"},
                                 {"_P-{2-US}", kTranslation, "P-{2-US} or P-{2-UU}"},
                                 {"_PUU", kTranslation, "PUU"},
                                 {"_PUS", kSpatial, "PUS"}};
  std::string text = "| leg | hidden leg, published | hidden leg, here | |\n| --- | --- | --- | --- |\n";
  for (const Row& row : rows) {
    const HiddenLeg hidden = HiddenLegOf(ChainFromText(row.chain), row.motion);
    text += fmt::format("| `{}` | {} | {} | {} |\n", row.chain, row.published, ChainCell(hidden.chain),
                        hidden.why_not_controllable);
  }
  return text;
}

std::string ModeCountsTable() {
  std::string text = fmt::format(
      "| robot | most, published | most possible | most found in {} | proved complete |\n| --- | --- | --- | "
      "--- | --- |\n",
      kRobots);
  for (const Family& family : Families()) {
    const Counts counts = CountModes(family);
    text += fmt::format("| {} | {} | {} | {} | {} |\n", family.name, family.published, counts.bound,
                        counts.most, counts.complete);
  }
  return text;
}

std::string ControllabilityTable() {
  std::string text = "| robot | by directions | by lines |\n| --- | --- | --- |\n";
  for (const Example& example : Examples()) {
    const std::vector<int> legs = AllLegs(example.it.robot);
    text += fmt::format(
        "| {} | {} | {} |\n", example.name,
        Verdict(ControllabilityOf(example.it.robot, legs, example.it.pose, SeenFeature::kDirections)),
        Verdict(ControllabilityOf(example.it.robot, legs, example.it.pose, SeenFeature::kLines)));
  }
  return text;
}

}  // namespace legible
