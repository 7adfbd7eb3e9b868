// `legible legs`, run as a user runs it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "datasets/model_file.h"
#include "datasets/synthetic_session.h"
#include "tests/apps/program_fixture.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kRobots = std::string(LEGIBLE_SOURCE_DIR) + "/datasets/robots/";
const std::string kQuattro = kRobots + "quattro.yaml";
const std::string kHexapod = std::string(LEGIBLE_SOURCE_DIR) + "/datasets/hexapod/robot.yaml";
const std::string kStart = "0 0 -0.75 0 0 0", kGoal = "-0.2 0 -0.56 0 0 0";

ProgramRun Legs(std::vector<std::string> options) {
  options.insert(options.begin(), "legs");
  return RunLegible(options);
}

json Document(std::vector<std::string> options) {
  options.insert(options.end(), {"--format", "json"});
  const ProgramRun run = Legs(options);
  EXPECT_NE(run.exit_code, kExitBadInput) << run.err;
  return json::parse(run.out);
}

json SetOf(const json& document, const std::vector<int>& legs) {
  for (const json& set : document.at("sets"))
    if (set.at("legs") == legs) return set;
  ADD_FAILURE() << "no such set";
  return {};
}

// Briot et al. (2016), section 5.1.3: legs {1, 4} lead the Quattro to (-0.2, 0, -0.909), {2, 3} to the goal.
TEST(LegsCommand, SaysOfTheQuattroWhatThePaperFound) {
  const json document = Document({kQuattro, "--from", kStart, "--to", kGoal});
  const json misled = SetOf(document, {1, 4}), good = SetOf(document, {2, 3});
  EXPECT_EQ(misled["verdict"], "other-aspect");
  EXPECT_EQ(good["verdict"], "possible");
  EXPECT_EQ(good["path"]["verdict"], "free");
  for (const json& set : {misled, good}) {
    EXPECT_EQ(set["assembly_modes"]["status"], "complete");
    EXPECT_EQ(set["assembly_modes"]["modes"].size(), 4U);
  }
  const json position = misled["assembly_modes"]["modes"][1]["base_from_platform"]["translation_m"];
  EXPECT_NEAR(position[0].get<double>(), -0.2, 0.002);
  EXPECT_NEAR(position[2].get<double>(), -0.909, 0.002);
  EXPECT_EQ(SetOf(document, {1, 2})["verdict"], "uncontrollable");
  EXPECT_EQ(document["legs"][0]["hidden_chain"], "Π-_{2-UU}");
  EXPECT_EQ(document["sets"][0]["legs"], document["choice"]);
  EXPECT_LT(document["sets"][0]["simulation"]["position_from_goal_m"].get<double>(), 1e-4);
}

TEST(LegsCommand, JudgesTheSetsThatItIsAskedFor) {
  const json document = Document({kQuattro, "--to", kGoal, "--legs", "1,4", "--legs", "2,3"});
  EXPECT_EQ(document["sets"].size(), 2U);
}

TEST(LegsCommand, JudgesASetOnceInWhateverOrderItsLegsAreNamed) {
  const json sets =
      Document({kQuattro, "--to", kGoal, "--legs", "3,2", "--legs", "1,4", "--legs", "2,3"})["sets"];
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_NE(sets[0]["legs"], sets[1]["legs"]);
}

TEST(LegsCommand, PrintsATableForPeople) {
  const ProgramRun run = Legs({kQuattro, "--from", kStart, "--to", kGoal});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  for (const char* words :
       {"other-aspect", "largest error at goal", "Watch legs ", "Where else the seen legs point"})
    EXPECT_THAT(run.out, HasSubstr(words));
}

// What stands behind `opening` on its line.
std::string LineAfter(const std::string& text, const std::string& opening) {
  const size_t start = text.find(opening);
  if (start == std::string::npos) {
    ADD_FAILURE() << "no \"" << opening << "\" in " << text;
    return {};
  }
  const size_t end = text.find('\n', start);
  return text.substr(start + opening.size(), end - start - opening.size());
}

TEST(LegsCommand, PrintsOtherModesAsPosesThatToTakes) {
  const std::vector<std::string> both = {kQuattro, "--to", kGoal, "--legs", "1,4"};
  const std::string table = Legs(both).out;
  const std::string pose = LineAfter(table.substr(table.find("Where else")), "  1,4: ");
  const json mode = Document(both)["sets"][0]["assembly_modes"]["modes"][1]["base_from_platform"];
  const json taken = Document({kQuattro, "--to", pose, "--legs", "1,4"})["to"];
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(taken["translation_m"][i].get<double>(), mode["translation_m"][i].get<double>(), 1e-9);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(taken["rotation_xyzw"][i].get<double>(), mode["rotation_xyzw"][i].get<double>(), 1e-9);
}

// At its home this robot has multiple roots.
TEST(LegsCommand, SaysWhyThereMayBeMoreModesOfASetThatIsNotTheChoiceToo) {
  const ProgramRun run = Legs({kRobots + "planar-3rrr.yaml", "--from", "0 0 0 0 0 1", "--legs", "1,2,3"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.out, HasSubstr("1 or more"));
  EXPECT_THAT(LineAfter(run.out, "1,2,3: other modes may not be all: "), HasSubstr("roots are multiple"));
}

// Section 4.3: parallel P joints cannot be controlled by directions; lines show the motion along them.
TEST(LegsCommand, EndsWithoutAChoiceWhereNoSetCanBeControlledAndSaysWhy) {
  const ProgramRun run = Legs({kRobots + "prrrp-parallel.yaml", "--format", "json"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_EQ(run.err, "legible: no set of legs leads to the goal\n");
  const json both = SetOf(json::parse(run.out), {1, 2});
  EXPECT_THAT(both["why"].get<std::string>(), HasSubstr("rails of the P joints are parallel"));
  EXPECT_EQ(both["by_lines"]["status"], "controllable");
}

// What the page of a run embeds.
json PageData(const std::string& page) {
  const std::string opening = R"(<script type="application/json" id="data">)";
  const size_t start = page.find(opening) + opening.size();
  return json::parse(page.substr(start, page.find("</script", start) - start));
}

Eigen::Vector3d SegmentOf(const json& place) {
  const auto start = place.at("start_m").get<std::vector<double>>();
  const auto end = place.at("platform_joint_m").get<std::vector<double>>();
  return Eigen::Vector3d(end[0], end[1], end[2]) - Eigen::Vector3d(start[0], start[1], start[2]);
}

// The rods are 0.825 m long, and in another mode those that are seen are parallel to where they are at the
// goal, also past a stretched leg.
TEST(LegsCommand, ThePageDrawsSeenLegsOfEveryModeAsAtTheGoal) {
  const ProgramRun run = Legs({kQuattro, "--from", kStart, "--to", kGoal, "--format", "html"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  const json data = PageData(run.out);
  json without_maps = data["document"];
  EXPECT_FALSE(without_maps["maps"]["sets"].empty());
  without_maps["maps"] = nullptr;
  EXPECT_EQ(without_maps, Document({kQuattro, "--from", kStart, "--to", kGoal}));
  const double digits_m = 2e-3;  // of a picture
  int modes_drawn = 0;
  for (size_t i = 0; i < data["document"]["sets"].size(); ++i) {
    if (data["places"]["modes"][i].is_null()) continue;
    for (const json& places : data["places"]["modes"][i])
      for (const int leg : data["document"]["sets"][i]["legs"]) {
        const size_t place = static_cast<size_t>(leg) - 1;
        const Eigen::Vector3d rod = SegmentOf(places[place]);
        EXPECT_NEAR(rod.norm(), 0.825, digits_m);
        EXPECT_LT((rod - SegmentOf(data["places"]["to"][place])).norm(), digits_m) << "set " << i;
        ++modes_drawn;
      }
  }
  EXPECT_GT(modes_drawn, 20);
}

TEST(LegsCommand, ThePagesCurvesBeginAtTheStartAndEndWhereTheSimulationDoes) {
  const json data = PageData(Legs({kQuattro, "--from", kStart, "--to", kGoal, "--format", "html"}).out);
  const json& curves = data["simulations"][0];
  const json& end = data["document"]["sets"][0]["simulation"];
  ASSERT_FALSE(curves.is_null());
  EXPECT_LE(curves["time_s"].size(), 300U);
  EXPECT_NEAR(curves["position_from_goal_m"].front().get<double>(), std::hypot(0.2, 0.19), 1e-4);
  EXPECT_NEAR(curves["time_s"].back().get<double>(), end["time_s"].get<double>(), 5e-3);
  EXPECT_NEAR(curves["position_from_goal_m"].back().get<double>(), end["position_from_goal_m"].get<double>(),
              1e-7);
  EXPECT_EQ(curves["errors_rad"].size(), data["document"]["choice"].size());
  for (const json& errors : curves["errors_rad"]) EXPECT_EQ(errors.size(), curves["time_s"].size());
}

// It rises and tilts; level it stays on its axis.
TEST(LegsCommand, MapsARobotOfRpsLegsOverCoordinatesThatItMovesIn) {
  const std::string rps = kRobots + "3-rps.yaml";
  const json maps = PageData(Legs({rps, "--format", "html"}).out)["document"]["maps"];
  EXPECT_EQ(maps["x"]["coordinate"], "z");
  EXPECT_EQ(maps["y"]["coordinate"], "rx");
  std::set<double> errors_m;
  for (const json& row : maps["sets"][0]["position_error_m"])
    for (const json& error : row)
      if (error.is_number()) errors_m.insert(error.get<double>());
  EXPECT_GT(errors_m.size(), 500U);  // a cell is a pose of its own
  // Legs of 0.4 to 0.65 m whose ends are 0.1 m apart sideways: z up to 0.642 m.
  EXPECT_LT(maps["x"]["values"].front().get<double>(), 0.4);
  EXPECT_GT(maps["x"]["values"].front().get<double>(), 0.3);
  EXPECT_GT(maps["x"]["values"].back().get<double>(), 0.642);
  EXPECT_LT(maps["x"]["values"].back().get<double>(), 0.75);
  for (const char* map : {"x=-0.1:0.1,y=-0.1:0.1", "z=0.4:0.6,rz=-0.1:0.1"}) {
    const ProgramRun refused = Legs({rps, "--map", map, "--format", "json"});
    EXPECT_EQ(refused.exit_code, kExitBadInput);
    EXPECT_THAT(refused.err, HasSubstr("but along z, rx, ry; "));
  }
}

TEST(LegsCommand, SaysWhichPoseRpsLegsAllowNearTheOneGivenAndTakesThatAsItIs) {
  const std::string rps = kRobots + "3-rps.yaml";
  const ProgramRun run = Legs({rps, "--to", "0 0 0.5 0 0.1 0"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  const std::string pose = LineAfter(
      run.err, "legible: warning: the RPS legs do not allow the pose of --to; one near to it is taken: ");
  EXPECT_EQ(Legs({rps, "--to", pose}).err, "");
  const json document = Document({rps, "--from", "0 0 0.5 0 0.1 0", "--to", pose});
  EXPECT_EQ(document["warnings"].size(), 1U);
  EXPECT_THAT(document["warnings"][0].get<std::string>(), HasSubstr("the pose of --from"));
  // Tilted about y alone, the platform joints at (-0.1, +-0.1 sqrt 3) m keep to the planes y = -+sqrt 3 x.
  const double x_m = document["to"]["translation_m"][0];
  const double ry_rad = 2 * std::asin(document["to"]["rotation_xyzw"][1].get<double>());
  EXPECT_NEAR(x_m, -0.1 * (1 - std::cos(ry_rad)), 1e-9);
  EXPECT_NEAR(ry_rad, 0.1, 1e-3);
}

std::string NineLeggedRobot() {
  std::string text =
      "robot: parallel\nname: Nine\nplatform: spatial\n"
      "home: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0.5]}\nlegs:\n";
  for (int leg = 0; leg < 9; ++leg) {
    const double base_rad = 0.7 * leg, platform_rad = base_rad + (leg % 2 == 0 ? 0.3 : -0.2);
    text += fmt::format(
        "  - {{chain: \"U_PS\", base_joint_m: [{}, {}, 0], platform_joint_m: [{}, {}, 0], radius_m: 0.01}}\n",
        0.3 * std::cos(base_rad), 0.3 * std::sin(base_rad), 0.2 * std::cos(platform_rad),
        0.2 * std::sin(platform_rad));
  }
  return text;
}

TEST(LegsCommand, AsksForSetsOfARobotWithMoreLegsThanItTriesEverySetOf) {
  const TemporaryFolder folder;
  const std::string nine = folder.Write("robot.yaml", NineLeggedRobot()).string();
  const ProgramRun all = Legs({nine});
  EXPECT_EQ(all.exit_code, kExitBadInput);
  EXPECT_THAT(all.err, AllOf(HasSubstr("has 9 legs"), HasSubstr("--legs")));
  EXPECT_EQ(Document({nine, "--legs", "1,5,9"})["sets"].size(), 1U);
}

TEST(LegsCommand, SaysInWhichUnitAJointWouldReadBeyondItsRange) {
  EXPECT_THAT(Legs({kRobots + "3-rps.yaml", "--to", "0 0 0.7 0 0 0"}).err,
              HasSubstr("would read 0.7071 m at the pose of --to"));  // 0.7 up, 0.1 sideways
  const TemporaryFolder folder;
  const std::string text = Replaced(Bytes(kRobots + "planar-3rrr.yaml"), "platform_joint_m: [0, 0.12, 0]",
                                    "platform_joint_m: [0, 0.12, 0], joint_range_rad: [-1e-3, 1e-3]");
  EXPECT_THAT(Legs({folder.Write("robot.yaml", text).string()}).err, HasSubstr(" rad at the pose of --from"));
}

TEST(LegsCommand, LeavesOutLegsThatTheModelsCameraDoesNotSee) {
  const TemporaryFolder folder;
  CalibratedModel model;
  model.robot = DesktopHexapod();
  model.camera = DesktopCamera(false);
  model.camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 5, 0.13});  // past the robot
  WriteModel(folder.path() / "model.yaml", model);
  const json document = Document({(folder.path() / "model.yaml").string(), "--legs", "1,3,5"});
  EXPECT_EQ(document["sets"][0]["verdict"], "invisible");
}

TEST(LegsCommand, RefusesBadInputInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{kRobots + "nothing.yaml"}, "nothing.yaml"},
      {{kQuattro, "--to", "1 2 3"}, "six"},
      {{kQuattro, "--to", "0 0 -0.7 0.1 0 0"},
       "cannot take the pose of --to: from its home it moves x, y, z, rz;"},
      {{kQuattro, "--from", "0 0 -3 0 0 0"}, "does not reach the pose of --from"},
      {{kQuattro, "--legs", "1,5"}, "no leg 5"},
      {{kQuattro, "--noise", "0"}, "not more than 0"},
      {{kQuattro, "--noise", "21"}, "more than 20 degrees"},
      {{kQuattro, "--gain", "1e4"}, "not from 0.001 to 1000 per second"},
      {{kQuattro, "--gain", "1e-4"}, "not from 0.001 to 1000 per second"},
      {{kQuattro, "--format", "yaml"}, "--format"}};
  for (const auto& [options, words] : cases) {
    const ProgramRun run = Legs(options);
    EXPECT_EQ(run.exit_code, kExitBadInput) << testing::PrintToString(options);
    EXPECT_THAT(run.err, AllOf(StartsWith("legible: "), HasSubstr(words)));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
    EXPECT_EQ(run.out, "");
  }
}

// Figure 19 of Briot et al. (2016): the singularities of legs {2, 3} cross the slice at z = -0.7 m, where
// errors are large.
TEST(LegsCommand, MapsErrorsThatGrowTowardsTheLineWhereTheHiddenRobotsSignChanges) {
  const json document =
      Document({kQuattro, "--to", "0.1 0 -0.7 0 0 0", "--legs", "2,3", "--map", "x=-0.4:0.4,y=-0.4:0.4"});
  const json& maps = document["maps"];
  ASSERT_EQ(maps["sets"].size(), 1U);
  EXPECT_EQ(maps["x"]["coordinate"], "x");
  EXPECT_DOUBLE_EQ(maps["y"]["values"].back().get<double>(), 0.4);
  EXPECT_DOUBLE_EQ(maps["held"]["z"].get<double>(), -0.7);
  const json &conditions = maps["sets"][0]["type_2_geometric"], &errors = maps["sets"][0]["position_error_m"];
  std::vector<double> at_line, all;
  for (size_t y = 0; y < conditions.size(); ++y)
    for (size_t x = 0; x + 1 < conditions[y].size(); ++x) {
      if (errors[y][x].is_null() || errors[y][x + 1].is_null()) continue;
      all.push_back(errors[y][x]);
      const bool is_crossed = conditions[y][x].get<double>() * conditions[y][x + 1].get<double>() < 0;
      if (is_crossed) at_line.push_back(std::max(errors[y][x].get<double>(), errors[y][x + 1].get<double>()));
    }
  ASSERT_FALSE(at_line.empty());
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  const double median_m = all[all.size() / 2];
  for (const double error_m : at_line) EXPECT_GT(error_m, 3 * median_m);
}

TEST(LegsCommand, RefusesMapsThatItCannotDraw) {
  EXPECT_THAT(Legs({kQuattro, "--map", "x=0:1"}).err, HasSubstr("a map is over two coordinates"));
  EXPECT_THAT(Legs({kQuattro, "--map", "x=0:1,y=1:1"}).err, HasSubstr("the range of y is empty"));
  EXPECT_THAT(Legs({kQuattro, "--map", "x=0:1,w=0:1"}).err,
              HasSubstr("\"w\" is none of x, y, z, rx, ry, rz"));
  // The second is not tilted in its corners, which are whole turns away.
  for (const char* map : {"x=0:1,rx=0:1", "x=-0.1:0.1,rx=-6.283185307179586:6.283185307179586"}) {
    const ProgramRun tilted = Legs({kQuattro, "--map", map, "--format", "json"});
    EXPECT_EQ(tilted.exit_code, kExitBadInput);
    EXPECT_THAT(tilted.err, HasSubstr("does not move along both coordinates of --map"));
    EXPECT_THAT(tilted.err, HasSubstr("but along x, y, z, rz; "));
  }
}

TEST(LegsCommand, ShowsTheHexapodsOwnAssemblyModesAndWhichModesItsJointsCanReach) {
  const json document = Document({kHexapod, "--legs", "1,2,6"});
  EXPECT_EQ(document["robot_modes"]["most_possible"], 40);
  ASSERT_FALSE(document["robot_modes"]["modes"].empty());
  EXPECT_LT(document["robot_modes"]["modes"][0]["position_from_goal_m"].get<double>(), 1e-9);
  for (const json& mode : document["sets"][0]["assembly_modes"]["modes"])
    EXPECT_TRUE(mode["within_joint_ranges"].is_boolean());
  EXPECT_TRUE(document["sets"][0]["assembly_modes"]["modes"][0]["within_joint_ranges"]);
}

// The 3-UPS hidden in a hexapod is cuspidal: in one aspect, with the straight path proved free, the servo of
// these legs ends 53 mm off with all errors at zero.
TEST(LegsCommand, DoesNotTakeOneAspectForTheGoal) {
  const json document = Document({kHexapod, "--from", "-0.0152 0.0370 0.3798 -0.0776 -0.0720 0.7629", "--to",
                                  "-0.0113 0.0402 0.3666 0.1338 -0.2654 0.8578", "--legs", "2,3,6"});
  const json& set = document["sets"][0];
  EXPECT_EQ(set["path"]["verdict"], "free");
  EXPECT_EQ(set["verdict"], "misled");
  EXPECT_EQ(set["simulation"]["end"], "converged");
  EXPECT_NEAR(set["simulation"]["position_from_goal_m"].get<double>(), 0.053, 1e-3);
  EXPECT_TRUE(document["choice"].is_null());
  EXPECT_EQ(document["why_no_choice"], "no set of legs leads to the goal");
}

// Half way leg 6 would be shorter than it can be.
TEST(LegsCommand, FollowsJointRangesAllAlongTheSimulatedWay) {
  const json document = Document({kHexapod, "--from", "-0.1056 -0.0376 0.3243 -0.0379 -0.1171 1.2434", "--to",
                                  "0.0791 -0.0151 0.3333 -0.0379 -0.1171 1.2434", "--legs", "1,2,3,4,5,6"});
  EXPECT_EQ(document["sets"][0]["verdict"], "out-of-reach");
  EXPECT_EQ(document["sets"][0]["why"], "leg 6 leaves its joint range on the simulated way");
}

}  // namespace
}  // namespace legible
