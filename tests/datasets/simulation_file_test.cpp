#include "datasets/simulation_file.h"

#include "datasets/camera_file.h"
#include "datasets/model_file.h"
#include "datasets/robot_file.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

CalibratedModel DesktopModel() {
  CalibratedModel model;
  model.robot = DesktopHexapod();
  model.camera = DesktopCamera(true);
  model.camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
  return model;
}

// A truth whose section `simulation` is `section`; the section begins at `line` of the file.
struct TruthFile {
  std::filesystem::path file;
  int line = 0;
};
TruthFile WriteSection(const TemporaryFolder& folder, const std::string& section) {
  const std::string start = ModelToYaml(DesktopModel());
  return {folder.Write("truth.yaml", start + section),
          static_cast<int>(std::count(start.begin(), start.end(), '\n')) + 1};
}

template <typename Options>
void DrawNumbers(std::mt19937_64& generator, const std::vector<NumberField<Options>>& fields,
                 Options& options) {
  for (const auto& field : fields) options.*field.value = Uniform(generator, field.lowest, field.highest);
}

template <typename Options>
void ExpectSameNumbers(const Options& found, const Options& expected,
                       const std::vector<NumberField<Options>>& fields) {
  for (const auto& field : fields) EXPECT_EQ(found.*field.value, expected.*field.value) << field.name;
}

SimulationOptions SomeOptions(std::mt19937_64& generator) {
  SimulationOptions options;
  DrawNumbers(generator, kSimulationFields, options);
  DrawNumbers(generator, kDriveFields, options.drives);
  options.drives.sliding_loss_m_per_s = options.drives.breakaway_speed_m_per_s / 3;
  DrawNumbers(generator, kSceneFields, options.scene);
  options.scene.light_in_camera = UniformVector(generator, -1, 1);
  options.seed = generator();
  options.start = DesktopHexapod().home;
  options.start->translation += UniformVector(generator, -0.01, 0.01);
  options.start->rotation = RotationFromVector(UniformVector(generator, -0.05, 0.05));
  for (const auto& [kind, name] : kFaultNames) {
    Fault fault{kind, Uniform(generator, 0, 5), Uniform(generator, 5, 10)};
    if (kind == FaultKind::kLegCovered) fault.leg = 5;
    if (kind == FaultKind::kFramesLate) fault.delay_s = Uniform(generator, 0, 1);
    options.faults.push_back(fault);
  }
  return options;
}

void ExpectSame(const SimulationOptions& found, const SimulationOptions& expected) {
  ExpectSameNumbers(found, expected, kSimulationFields);
  ExpectSameNumbers(found.drives, expected.drives, kDriveFields);
  ExpectSameNumbers(found.scene, expected.scene, kSceneFields);
  EXPECT_EQ(found.scene.light_in_camera, expected.scene.light_in_camera);
  EXPECT_EQ(found.seed, expected.seed);
  ASSERT_EQ(found.start.has_value(), expected.start.has_value());
  if (expected.start) ExpectSame(*found.start, *expected.start);
  ASSERT_EQ(found.faults.size(), expected.faults.size());
  for (size_t i = 0; i < found.faults.size(); ++i) {
    EXPECT_EQ(found.faults[i].kind, expected.faults[i].kind);
    EXPECT_EQ(found.faults[i].leg, expected.faults[i].leg);
    ExpectSameNumbers(found.faults[i], expected.faults[i], kFaultFields);
  }
}

TEST(SimulationFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  const auto file = folder.path() / "truth.yaml";
  WriteRobot(folder.path() / "robot.yaml", DesktopHexapod());
  std::filesystem::create_directory(folder.path() / "paper");
  WriteCamera(folder.path() / "paper" / "camera.yaml", DesktopCamera(false));
  const CalibratedModel model = DesktopModel();
  for (int i = 0; i < 20; ++i) {
    SimulatedTruth simulated{{model.robot, *model.camera, *model.camera_from_base}, {}, {}, {}};
    if (i > 0) {
      simulated.options = SomeOptions(generator);
      simulated.drawing_robot = folder.path() / "robot.yaml";
      simulated.drawing_camera = folder.path() / "paper" / "camera.yaml";
    }
    WriteTruth(file, simulated);
    const SimulatedTruth found = ReadTruth(file);
    ExpectSame(found.truth.robot, simulated.truth.robot);
    ExpectSame(found.truth.camera, simulated.truth.camera);
    ExpectSame(found.truth.camera_from_base, simulated.truth.camera_from_base);
    ExpectSame(found.options, simulated.options);
    EXPECT_EQ(found.drawing_robot, simulated.drawing_robot);
    EXPECT_EQ(found.drawing_camera, simulated.drawing_camera);
    ExpectSame(ReadModel(file).robot, model.robot);
  }
  EXPECT_THAT(Bytes(file),
              testing::HasSubstr("    robot: \"robot.yaml\"\n    camera: \"paper/camera.yaml\"\n"));
}

TEST(SimulationFile, WhatIsLeftOutIsAsTheOptionsHaveIt) {
  const TemporaryFolder folder;
  ExpectSame(ReadTruth(WriteSection(folder, "").file).options, {});
  ExpectSame(ReadTruth(WriteSection(folder, "simulation: {}\n").file).options, {});
  const SimulationOptions found = ReadTruth(WriteSection(folder,
                                                         "simulation:\n"
                                                         "  seed: 18446744073709551615\n"
                                                         "  drives: {lag_s: 0.05}\n"
                                                         "  faults:\n"
                                                         "    - {kind: leg-covered, leg: 3, from_s: 2}\n"
                                                         "    - {kind: frames-late}\n")
                                                .file)
                                      .options;
  SimulationOptions expected;
  expected.seed = 18446744073709551615U;
  expected.drives.lag_s = 0.05;
  expected.faults = {{FaultKind::kLegCovered, 2, 1e9, 2}, {FaultKind::kFramesLate}};
  ExpectSame(found, expected);
}

// Of a section whose line `place` (0: its first) is at fault.
void ExpectComplaint(const TemporaryFolder& folder, const std::string& section, int place,
                     const std::string& message) {
  const TruthFile truth = WriteSection(folder, section);
  EXPECT_EQ(InputErrorOf([&] { ReadTruth(truth.file); }), Complaint(truth.file, truth.line + place, message));
}

TEST(SimulationFile, UnknownKeysAreRefusedWithTheNearestKnownOne) {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& line, const std::string& path, const std::string& key,
                         const std::string& nearest) {
    ExpectComplaint(folder, "simulation:\n  " + line + "\n", 1,
                    path + " has the unknown key \"" + key + "\"; the nearest known key is \"" + nearest +
                        "\": rename it or take it out");
  };
  check("perod_s: 0.02", "simulation", "perod_s", "period_s");
  check("drives: {lag: 0.02}", "simulation.drives", "lag", "lag_s");
  check("scene: {light: [1, 1, 1]}", "simulation.scene", "light", "ambient");
  check("faults: [{kind: frames-late, delay: 1}]", "simulation.faults[1]", "delay", "delay_s");
  check("drawing: {robots: robot.yaml}", "simulation.drawing", "robots", "robot");
}

TEST(SimulationFile, ValuesOutOfTheirRangeAreRefused) {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& line, const std::string& message) {
    ExpectComplaint(folder, "simulation:\n  seed: 3\n  " + line + "\n", 2, "simulation." + message);
  };
  check("period_s: 0", "period_s is 0; give a number from 0.001 to 10");
  check("drives: {lag_s: -0.1}", "drives.lag_s is -0.1; give a number from 0 to 10");
  check("drives: {sliding_loss_m_per_s: 0.01}",
        "drives.sliding_loss_m_per_s is 0.01, and breakaway_speed_m_per_s is 0; "
        "give a breakaway speed that is not less than what sliding loses");
  check("scene: {leg_grey: 256}", "scene.leg_grey is 256; give a number from 0 to 255");
  check("scene: {light_in_camera: [0, 0, 0]}",
        "scene.light_in_camera has no direction; give a vector that points to the light");
  check("edge_noise_px: .nan",
        "edge_noise_px is \".nan\", not a finite number; give a number in m, rad or px");
  check("faults: [{kind: frame-dropped}]",
        "faults[1].kind is \"frame-dropped\", a fault not known here; the nearest known one is "
        "\"frames-dropped\"");
  check("faults: [{kind: link-lost, from_s: 2, until_s: 1}]",
        "faults[1] lasts from 2 s until 1 s; give an until_s later than from_s");
  check("faults: [{kind: leg-covered, leg: 0}]", "faults[1].leg is 0; give 1 to 6");
  check("faults: [{kind: leg-covered}]", "faults[1] has no \"leg\"; add it");
  check("faults: [{kind: link-lost, leg: 1}]",
        "faults[1].leg has no meaning for link-lost; only leg-covered has it: take it out");
  check("faults: [{kind: frames-frozen, delay_s: 1}]",
        "faults[1].delay_s has no meaning for frames-frozen; only frames-late has it: take it out");
  check("drawing: {robot: paper.yaml}",
        "drawing.robot is \"paper.yaml\", which is no file; give a path relative to this file's folder");
  check("start: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0.6]}",
        "start has joint 1 at 0.634862 m, outside its range of 0.345 to 0.485 m; "
        "give a pose that the robot can take, for the rig starts there");
}

TEST(SimulationFile, SeedsAreWholeNumbers) {
  const TemporaryFolder folder;
  for (const std::string seed : {"-1", "1.5", "18446744073709551616", "one"})
    ExpectComplaint(folder, "simulation:\n  seed: " + seed + "\n", 1,
                    "simulation.seed is \"" + seed + "\"; give a whole number from 0 to 2^64 - 1");
}

TEST(SimulationFile, ATruthHasACameraAndItsPlace) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "truth.yaml";
  const std::string mend = "give a model.yaml with camera and camera_from_base, for a simulated rig has both";
  CalibratedModel model = DesktopModel();
  model.camera_from_base.reset();
  WriteModel(file, model);
  EXPECT_EQ(InputErrorOf([&] { ReadTruth(file); }),
            Complaint(file, 0, "has no \"camera_from_base\"; " + mend));
  WriteRobot(file, model.robot);
  EXPECT_EQ(InputErrorOf([&] { ReadTruth(file); }), Complaint(file, 0, "has no \"camera\"; " + mend));
}

TEST(SimulationFile, AHomeOutOfRangeIsRefusedWhereTheRigStartsThere) {
  const TemporaryFolder folder;
  CalibratedModel model = DesktopModel();
  model.robot.home.translation.z() = 0.6;
  const auto file = folder.Write("truth.yaml", ModelToYaml(model));
  EXPECT_THAT(InputErrorOf([&] { ReadTruth(file); }),
              testing::HasSubstr("robot.home has joint 1 at 0.634862"));
  folder.Write("truth.yaml", ModelToYaml(model) +
                                 "simulation: {start: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, "
                                 "0.32]}}\n");
  EXPECT_NO_THROW(ReadTruth(file));
}

TEST(SimulationFile, OptionsThatDoNotPassCheckAreNotWritten) {
  const TemporaryFolder folder;
  const CalibratedModel model = DesktopModel();
  SimulatedTruth simulated{{model.robot, *model.camera, *model.camera_from_base}, {}, {}, {}};
  simulated.options.period_s = 0;
  EXPECT_THROW(WriteTruth(folder.path() / "truth.yaml", simulated), std::invalid_argument);
  EXPECT_THAT(folder.Names(), testing::IsEmpty());
}

}  // namespace
}  // namespace legible
