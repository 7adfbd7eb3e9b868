// `legible accuracy` run in process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/apps/program_fixture.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kMerlet = LEGIBLE_SOURCE_DIR "/datasets/merlet-gough/robot.yaml";
const std::string kMerletPoses = LEGIBLE_SOURCE_DIR "/datasets/merlet-gough/poses.csv";
const std::string kSeoul = LEGIBLE_SOURCE_DIR "/datasets/seoul-3upu/robot.yaml";
const std::string kHexapod = LEGIBLE_SOURCE_DIR "/datasets/hexapod";

ProgramRun RunAccuracyOn(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "accuracy");
  return RunLegible(arguments);
}

json Document(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--format", "json"});
  const ProgramRun run = RunAccuracyOn(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return json::parse(run.out);
}

// --- Merlet's tables from the program.

// One unit of the last digit of a number as printed.
void ExpectPrinted(const json& found, const std::string& printed, const std::string& what) {
  const size_t point = printed.find('.');
  const double digits = point == std::string::npos ? 0 : static_cast<double>(printed.size() - point - 1);
  EXPECT_NEAR(found.get<double>(), std::stod(printed), std::pow(10, -digits)) << what;
}

TEST(AccuracyCommand, PrintsAll45EntriesOfMerletsTwoTables) {
  const json poses = Document({kMerlet, "--poses", kMerletPoses, "--length-unit", "cm", "--angle-unit", "deg",
                               "--characteristic-length", "0.53", "--joint-error", "1e-4"})["poses"];
  const std::vector<std::vector<std::string>> errors = {
      {"0.1184", "0.1268", "0.010087", "0.1185", "0.1184", "0.697"},
      {"0.1189", "0.1274", "0.01266", "0.1333", "0.1429", "0.808"},
      {"0.123", "0.1309", "0.0372", "0.15", "0.1663", "0.7208"}};
  const std::vector<std::vector<std::string>> indices = {{"-29.22", "75.14", "63.9", "152.8", "70.2"},
                                                         {"-24.64", "75.16", "73.8", "154", "80.9"},
                                                         {"-23.93", "80.65", "68.4", "158.3", "74.7"}};
  const std::vector<std::vector<std::string>> ranges = {{"9.55", "55.47", "258.8", "3204.9"},
                                                        {"9.62", "43.84", "218.8", "2383.6"},
                                                        {"10.06", "58.95", "286.5", "3618"}};
  const std::vector<std::string> names = {"x", "y", "z", "rx", "ry", "rz"};
  const std::vector<std::string> conditions = {"two", "two_normalized", "frobenius", "frobenius_normalized"};
  int entries = 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 6; ++k, ++entries)
      ExpectPrinted(poses[i]["max_error"][names[k]], errors[i][k], poses[i]["name"]);
    ExpectPrinted(poses[i]["determinant"], indices[i][0], "determinant");
    ++entries;
    for (size_t k = 0; k < 4; ++k, ++entries)
      ExpectPrinted(poses[i]["condition"][conditions[k]], indices[i][k + 1], conditions[k]);
    for (size_t k = 0; k < 4; ++k, ++entries)
      ExpectPrinted(poses[i]["condition"][k < 2 ? "two_three_point" : "frobenius_three_point"][k % 2],
                    ranges[i][k], "three points");
  }
  EXPECT_EQ(entries, 45);
}

// --- Units and conventions.

TEST(AccuracyCommand, ALengthUnitChangesWhatHasLengthsInItAndNothingElse) {
  const json m = Document({kMerlet, "--pose", "0.05 0.02 0.53 0.05 0.1 0.2"})["poses"][0];
  const json mm =
      Document({kMerlet, "--pose", "0.05 0.02 0.53 0.05 0.1 0.2", "--length-unit", "mm"})["poses"][0];
  const auto ratio = [&](const json::json_pointer& at) {
    return mm.at(at).get<double>() / m.at(at).get<double>();
  };
  using Pointer = json::json_pointer;
  for (const char* at :
       {"/max_error/x", "/max_error/position", "/pose/0", "/joint_readings/3", "/together/value_95/position",
        "/nonlinear/position_difference", "/inverse_jacobian/0/4",
        "/condition/characteristic_length/frobenius", "/ellipsoid/position/semi_axes/0"})
    EXPECT_NEAR(ratio(Pointer(at)), 1e3, 1e-3) << at;
  EXPECT_NEAR(ratio(Pointer("/polyhedron/position/volume")), 1e9, 1e3);
  EXPECT_NEAR(ratio(Pointer("/determinant")), 1e9, 1e3);
  EXPECT_NEAR(ratio(Pointer("/manipulability")), 1e-9, 1e-15);
  for (const char* at :
       {"/max_error/rx", "/max_error/rotation", "/pose/3", "/inverse_jacobian/0/1",
        "/condition/two_normalized", "/condition/frobenius_normalized", "/condition/infinity_normalized",
        "/condition/two_three_point/0", "/condition/frobenius_three_point/1", "/nonlinear/relative",
        "/together/value_95/rotation"})
    EXPECT_NEAR(ratio(Pointer(at)), 1, 1e-6) << at;
  EXPECT_GT(std::abs(ratio(Pointer("/condition/two")) - 1), 0.1);
  EXPECT_GT(std::abs(ratio(Pointer("/condition/frobenius")) - 1), 0.1);
}

TEST(AccuracyCommand, AnAngleUnitChangesRotationErrorsOnlyAndIndicesStayPerRadian) {
  const json rad = Document({kMerlet})["poses"][0];
  const json deg = Document({kMerlet, "--angle-unit", "deg"})["poses"][0];
  const double degrees = 180 / std::numbers::pi;
  EXPECT_NEAR(deg["max_error"]["rz"].get<double>() / rad["max_error"]["rz"].get<double>(), degrees, 1e-9);
  EXPECT_EQ(deg["max_error"]["x"], rad["max_error"]["x"]);
  EXPECT_EQ(deg["determinant"], rad["determinant"]);
  EXPECT_EQ(deg["inverse_jacobian"], rad["inverse_jacobian"]);
}

TEST(AccuracyCommand, EulerAnglesAreTheRotationTheyName) {
  const auto errors = [&](const std::string& pose, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {kMerlet, "--pose", pose};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return Document(arguments);
  };
  const json vector = errors("0 0 0.53 0 0 0.3", {});
  EXPECT_THAT(vector["conventions"]["orientation"].get<std::string>(), HasSubstr("rotation vector"));
  const json zyx = errors("0 0 0.53 0.3 0 0", {"--euler", "ZYX"});
  EXPECT_THAT(zyx["conventions"]["orientation"].get<std::string>(), HasSubstr("ZYX"));
  EXPECT_NEAR(zyx["poses"][0]["max_error"]["rx"], vector["poses"][0]["max_error"]["rx"], 1e-15);
  // Moving ZYX angles are fixed xyz angles in reverse.
  const json moving = errors("0 0 0.53 0.3 0.1 0.05", {"--euler", "ZYX"});
  const json fixed = errors("0 0 0.53 0.05 0.1 0.3", {"--euler", "xyz"});
  EXPECT_NEAR(moving["poses"][0]["max_error"]["z"], fixed["poses"][0]["max_error"]["z"], 1e-15);
}

// --- Rows, statuses, exit codes.

TEST(AccuracyCommand, APoseOutOfReachIsAStatusInItsRowWhereOthersAreGood) {
  const TemporaryFolder folder;
  const auto file = folder.Write("poses.csv", "name,x,y,z,rx,ry,rz\ngood,0,0,0.53,0,0,0\nfar,0,0,3,0,0,0\n");
  const json document = Document({kMerlet, "--poses", file});
  EXPECT_EQ(document["poses"][0]["status"], "regular");
  EXPECT_EQ(document["poses"][1]["status"], "out_of_reach");
  EXPECT_THAT(document["poses"][1]["message"].get<std::string>(), HasSubstr("leg 1 would read"));
  EXPECT_TRUE(document["poses"][1]["max_error"]["x"].is_null());
}

TEST(AccuracyCommand, SeoulsRobotIsSingularWithTheRotationThatItLeavesFree) {
  const ProgramRun run = RunAccuracyOn({kSeoul, "--format", "json"});
  EXPECT_EQ(run.exit_code, 1);
  const json pose = json::parse(run.out)["poses"][0];
  EXPECT_EQ(pose["status"], "singular");
  ASSERT_EQ(pose["free_motions"].size(), 2u);
  for (const json& motion : pose["free_motions"]) EXPECT_NEAR(motion[5].get<double>(), 0, 1e-9);
  EXPECT_THAT(pose["message"].get<std::string>(), HasSubstr("can still turn about (1, 0, 0)"));
  EXPECT_TRUE(pose["manipulability"].is_null());  // no infinity
  EXPECT_EQ(run.out.find("inf"), run.out.find("infinity"));
  EXPECT_THAT(run.err, HasSubstr("all are singular"));
}

TEST(AccuracyCommand, ASeoulRobotOffItsAxisHasFiniteErrors) {
  const json pose = Document({kSeoul, "--pose", "0.1 0.05 0.4 0 0 0"})["poses"][0];
  EXPECT_EQ(pose["status"], "regular");
  EXPECT_GT(pose["max_error"]["position"].get<double>(), 0);
  EXPECT_TRUE(pose["nonlinear"].is_null());
}

// Every line names what is wrong, and nothing comes out or is written.
TEST(AccuracyCommand, BadInputGetsOneLineAndExitCode2) {
  const TemporaryFolder folder;
  const std::string robot = Bytes(kMerlet);
  const size_t last_leg = robot.rfind("  - {");
  const auto five = folder.Write("five.yaml", robot.substr(0, last_leg));
  const auto nan = folder.Write("nan.yaml", Replaced(robot, "[0.03, -0.13, 0]", "[.nan, -0.13, 0]"));
  const auto empty = folder.Write("empty.csv", "x,y,z,rx,ry,rz\n");
  const auto letters = folder.Write("letters.csv", "0,0,0.53,0,0,zero\n");
  const auto twice = folder.Write("twice.csv", "name,x,y,z,rx,ry,rz\na,0,0,0.53,0,0,0\na,0,0,0.5,0,0,0\n");
  const std::string out = folder.path() / "result.json";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{five}, "five.yaml:10: legs has 5 values; give 6"},
      {{nan}, "nan.yaml:"},
      {{folder.path() / "none.yaml"}, "none.yaml: "},
      {{kMerlet, "--pose", "0 0 3 0 0 0"}, "cannot reach pose 1: leg 1 would read 3.0008 m"},
      {{kMerlet, "--pose", "0 0 0.53"}, "has 3 numbers, not the six"},
      {{kMerlet, "--pose", "0 0 0.53 0 0 nan"}, "\"nan\" is not a finite number"},
      {{kMerlet, "--joint-error", "0"}, "--joint-error: 0 is not more than 0"},
      {{kMerlet, "--joint-error", "-1e-4"}, "--joint-error: -1e-4 is not more than 0"},
      {{kMerlet, "--joint-error", "1e-4,1e-4"}, "has 6 joints, and --joint-error gives 2 numbers"},
      {{kMerlet, "--length-unit", "furlong"}, "--length-unit: \"furlong\" is none of m, cm, mm"},
      {{kMerlet, "--angle-unit", "grad"}, "--angle-unit: \"grad\" is none of rad, deg"},
      {{kMerlet, "--poses", empty}, "empty.csv: no pose"},
      {{kMerlet, "--poses", letters}, "letters.csv:1: "},
      {{kMerlet, "--poses", twice}, "twice.csv:3: pose \"a\" is there already, in line 2"},
      {{kMerlet, "--euler", "ZZX"}, "--euler: \"ZZX\" is no order of axes"},
      {{kMerlet, "--box", "w=0:1"}, "--box: \"w\" is none of x, y, z, rx, ry, rz, reachable"},
      {{kMerlet, "--box", "x=1:0"}, "--box: the range 1:0 is reversed"},
      {{kMerlet, "--box", "x=0:0"}, "--box: the box has no range"},
      {{kMerlet, "--sampling", "guess"}, "--sampling: \"guess\" is none of"},
      {{kMerlet, "--samples", "3"}, "--samples: give a whole number from 16"},
      {{kMerlet, "--characteristic-length", "0"}, "--characteristic-length: 0 is not more than 0"},
      {{kMerlet, "--edge-noise", "0.1"}, "has no camera, which --edge-noise needs"},
      {{kMerlet, "--edge-noise", "1", "--legs", "1,7"}, "--legs: \"7\" is no leg"},
      {{kMerlet, "--legs", "1,2"}, "--legs requires --edge-noise"},
      {{kMerlet, "--within-joint-ranges"}, "--within-joint-ranges requires --box"},
      {{kMerlet, "--joint-error", "1e-4,"}, "--joint-error: \"\" is not a finite number"},
      {{kMerlet, "--joint-error", "1e300"}, "is no error of a robot"},
      {{kMerlet, "--box", "x=-1e308:0"}, "is beyond any robot"},
      {{kMerlet, "--box", "x=-.1:.1,y=-.1:.1,z=.5:.6,rx=0:.1,ry=0:.1,rz=0:.1", "--sampling", "gauss"},
       "gauss takes 20 nodes"},
      {{kMerlet, "--samples", "999999999", "--box", "reachable"}, "more than 10000000 samples do not fit"},
      {{kMerlet, "--session", folder.path()}, "session.yaml"},
      {{kMerlet, "--format", "xml"}, "--format: \"xml\" is none of table, json, csv, html"},
      {{kSeoul, "--pose", "0 0 0.4 0.1 0 0"}, "only translates"},
      {{kSeoul, "--geometry-error", "1e-4"}, "is a 3-UPU"},
      {{}, "MODEL"},
  };
  for (auto [arguments, message] : cases) {
    if (!arguments.empty()) arguments.insert(arguments.end(), {"--out", out});
    const ProgramRun run = RunAccuracyOn(arguments);
    EXPECT_EQ(run.exit_code, 2) << message;
    EXPECT_EQ(run.out, "") << message;
    EXPECT_THAT(run.err, StartsWith("legible: "));
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(out)) << message;
  }
}

// --- What else goes in and comes out.

TEST(AccuracyCommand, PosesOfASessionComeFromItsJointReadings) {
  const json document = Document({kHexapod + "/robot.yaml", "--session", kHexapod});
  EXPECT_EQ(document["poses"].size(), 16u);
  EXPECT_EQ(document["poses"][0]["name"], "000.png");
  EXPECT_NEAR(document["poses"][0]["joint_readings"][0].get<double>(), 0.35153308, 1e-9);
  EXPECT_EQ(document["comparison"]["over"], "the 16 poses given");
}

TEST(AccuracyCommand, ModelsCovarianceAndEdgeNoiseAreSourcesAndAddUp) {
  const TemporaryFolder folder;
  std::string model = "robot:\n";
  std::istringstream lines(Bytes(kHexapod + "/robot.yaml"));
  for (std::string line; std::getline(lines, line);) model += "  " + line + "\n";
  std::istringstream camera(Bytes(kHexapod + "/camera.yaml"));
  std::string camera_text = "camera:\n", placement;
  for (std::string line; std::getline(camera, line);) {
    if (line.starts_with("camera_from_base") || !placement.empty())
      placement += line + "\n";
    else
      camera_text += "  " + line + "\n";
  }
  model += camera_text + placement +
           "covariance:\n  parameters: [\"legs[2].joint_offset_m\", \"legs[4].base_joint_m.z\"]\n"
           "  rows:\n    - [1e-8]\n    - [0, 1e-10]\n";
  const auto file = folder.Write("model.yaml", model);
  const json pose = Document({file, "--edge-noise", "0.1", "--legs", "1,2,3,4", "--legs", "1,2"})["poses"][0];
  ASSERT_EQ(pose["sources"].size(), 4u);
  EXPECT_EQ(pose["sources"][0]["name"], "joints");
  EXPECT_EQ(pose["sources"][1]["name"], "geometry");
  EXPECT_EQ(pose["sources"][1]["contributions"][0]["name"], "legs[2].joint_offset_m");
  EXPECT_EQ(pose["sources"][2]["name"], "vision, legs 1 2 3 4");
  EXPECT_TRUE(pose["sources"][3]["bound"].is_null());  // two legs do not determine a pose
  EXPECT_EQ(pose["together"]["of"], "joints + geometry + vision, legs 1 2 3 4");
  double squares = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double sigma = pose["sources"][i]["value_95"]["z"].get<double>() / 1.959963984540054;
    squares += sigma * sigma;
  }
  EXPECT_NEAR(pose["together"]["value_95"]["z"].get<double>(), 1.959963984540054 * std::sqrt(squares), 1e-12);
  EXPECT_NEAR(pose["region_95"]["covariance"][2][2].get<double>(), squares, 1e-15);
}

TEST(AccuracyCommand, CsvHasARowAPoseWithTheNumbersOfTheDocument) {
  const json document = Document({kMerlet, "--poses", kMerletPoses});
  const ProgramRun run = RunAccuracyOn({kMerlet, "--poses", kMerletPoses, "--format", "csv"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 4);
  EXPECT_THAT(run.out, StartsWith("name,status,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad,max_error_x_m,"));
  std::istringstream row(run.out.substr(run.out.find("P2,")));
  std::vector<std::string> fields;
  for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
  EXPECT_EQ(std::stod(fields[8]), document["poses"][1]["max_error"]["x"].get<double>());
  EXPECT_EQ(std::stod(fields[15]), document["poses"][1]["max_error"]["rotation"].get<double>());
}

TEST(AccuracyCommand, WorkspaceHasStatisticsWithTheirUncertaintyAndTheSingularityIsNamed) {
  const json good =
      Document({kMerlet, "--box", "x=-0.1:0.1,y=-0.1:0.1,z=0.5:0.55", "--samples", "4096"})["workspace"];
  EXPECT_EQ(good["samples"], 4096);
  EXPECT_EQ(good["crosses_singularity"], false);
  EXPECT_TRUE(good["warnings"].empty());
  const json& x = good["statistics"][0];
  EXPECT_EQ(x["of"], "x");
  EXPECT_GT(x["mean"]["value"].get<double>(), 0);
  EXPECT_GT(x["mean"]["half_width"].get<double>(), 0);
  EXPECT_LT(x["mean"]["half_width"].get<double>(), 1e-3 * x["mean"]["value"].get<double>());
  EXPECT_GT(good["global_conditioning_index"]["value"].get<double>(), 0);

  const json crossed = Document({kMerlet, "--box", "rz=1:2", "--samples", "4096"})["workspace"];
  EXPECT_EQ(crossed["crosses_singularity"], true);
  EXPECT_THAT(crossed["warnings"][0].get<std::string>(), HasSubstr("a singularity crosses the box"));
}

TEST(AccuracyCommand, ABoxLiesAboutTheFirstPoseThatCanBeReached) {
  const json workspace = Document({kMerlet, "--pose", "0 0 5 0 0 0", "--pose", "0 0 0.53 0 0 0", "--box",
                                   "x=-0.01:0.01", "--samples", "1024"})["workspace"];
  EXPECT_EQ(workspace["box"]["z"], json({0.53, 0.53}));
  EXPECT_THAT(workspace["over"].get<std::string>(), HasSubstr("about pose 2"));
}

TEST(AccuracyCommand, SmallEulerAnglesOfHomeStaySmall) {
  const TemporaryFolder folder;
  // Home turned by -10 degrees about the vertical.
  const auto robot = folder.Write("robot.yaml", Replaced(Bytes(kMerlet), "rotation_xyzw: [0, 0, 0, 1]",
                                                         "rotation_xyzw: [0, 0, -0.08715574, 0.9961947]"));
  const json pose = Document({robot, "--euler", "ZYX"})["poses"][0]["pose"];
  EXPECT_NEAR(pose[3].get<double>(), -10 * std::numbers::pi / 180, 1e-7);
  EXPECT_NEAR(pose[4].get<double>(), 0, 1e-12);
  EXPECT_NEAR(pose[5].get<double>(), 0, 1e-12);
}

TEST(AccuracyCommand, TheModelIsNotOverwrittenByItsResult) {
  const TemporaryFolder folder;
  const auto robot = folder.Write("robot.yaml", Bytes(kMerlet));
  const ProgramRun run = RunAccuracyOn({robot, "--out", robot});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is what is read, and would be overwritten"));
  EXPECT_EQ(Bytes(robot), Bytes(kMerlet));
}

TEST(AccuracyCommand, A3UpuHasUnitsOfItsOwnNoRegionAndASingularLineThatIsSeen) {
  const json document = Document({kSeoul, "--pose", "0.1 0.05 0.4 0 0 0", "--box", "x=-0.1:0.1,y=-0.1:0.1"});
  EXPECT_EQ(document["units"]["determinant"], "1/rad^3");
  EXPECT_TRUE(document["poses"][0]["region_95"].is_null());
  EXPECT_EQ(document["workspace"]["crosses_singularity"], true);
  EXPECT_THAT(document["comparison"]["verdict"][0].get<std::string>(), HasSubstr("by position errors"));
}

TEST(AccuracyCommand, SamplingRulesAgreeWithinWhatTheySay) {
  const auto mean = [&](const std::string& rule) {
    return Document({kMerlet, "--box", "x=-0.1:0.1,y=-0.1:0.1", "--samples", "16384", "--sampling",
                     rule})["workspace"]["statistics"][6]["mean"];
  };
  const json truth = mean("gauss");
  for (const std::string rule : {"sobol", "monte-carlo", "grid"}) {
    const json found = mean(rule);
    EXPECT_NEAR(found["value"].get<double>(), truth["value"].get<double>(),
                2 * found["half_width"].get<double>() + truth["half_width"].get<double>())
        << rule;
  }
}

TEST(AccuracyCommand, TablesSayUnitsConventionAndVerdict) {
  const ProgramRun run = RunAccuracyOn({kMerlet, "--box", "reachable", "--samples", "8192"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* part : {"Largest errors, mm and deg", "rotation vector", "Where errors come from",
                           "Indices against errors", "Over the workspace", "global conditioning index"})
    EXPECT_THAT(run.out, HasSubstr(part));
  EXPECT_THAT(run.err, HasSubstr("joint errors of up to 1e-4 m were assumed"));
}

TEST(AccuracyCommand, ThePageHoldsTheDocumentAndIsWrittenWhole) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "accuracy.html";
  const ProgramRun run = RunAccuracyOn({kMerlet, "--poses", kMerletPoses, "--format", "html", "--out", out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const std::string page = Bytes(out);
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  const std::string opening = R"(<script type="application/json" id="data">)";
  const size_t start = page.find(opening) + opening.size();
  const json data = json::parse(page.substr(start, page.find("</script", start) - start));
  EXPECT_EQ(data["document"],
            Document({kMerlet, "--poses", kMerletPoses, "--length-unit", "mm", "--angle-unit", "deg"}));
  EXPECT_FALSE(data["maps"].is_null());
  EXPECT_EQ(data["scatter"]["names"].size(), 3u);
  EXPECT_EQ(folder.Names().size(), 1u);  // nothing half-written beside it
}

}  // namespace
}  // namespace legible
