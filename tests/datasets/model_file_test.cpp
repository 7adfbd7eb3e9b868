#include "datasets/model_file.h"

#include "datasets/robot_file.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

CalibratedModel SomeModel(std::mt19937_64& generator, int parameter_count) {
  CalibratedModel model;
  model.robot = DesktopHexapod(generator, 0.002);
  model.camera = DesktopCamera(true);
  model.camera_from_base = Rigid3{UniformRotation(generator), UniformVector(generator, -1, 1)};
  for (int i = 0; i < parameter_count; ++i)
    model.parameter_names.push_back("legs[" + std::to_string(i + 1) + "].x");
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(parameter_count, parameter_count,
                                                            [&] { return Uniform(generator, -1e-3, 1e-3); });
  model.covariance = (root * root.transpose()).selfadjointView<Eigen::Lower>();
  model.provenance = {
      {"session", "/data/a \"b\""}, {"content_hash", "00ff"}, {"options", "--lens rational\n--seed 1"}};
  return model;
}

void ExpectSame(const CalibratedModel& found, const CalibratedModel& expected) {
  ExpectSame(found.robot, expected.robot);
  ASSERT_EQ(found.camera.has_value(), expected.camera.has_value());
  if (expected.camera) ExpectSame(*found.camera, *expected.camera);
  ASSERT_EQ(found.camera_from_base.has_value(), expected.camera_from_base.has_value());
  if (expected.camera_from_base) ExpectSame(*found.camera_from_base, *expected.camera_from_base);
  EXPECT_EQ(found.parameter_names, expected.parameter_names);
  EXPECT_EQ(found.covariance, expected.covariance);
  EXPECT_EQ(found.provenance, expected.provenance);
}

// A model file that ends with `covariance`, whose first line is number `line` of the file.
struct CovarianceFile {
  std::filesystem::path file;
  int line = 0;
};
CovarianceFile WriteCovariance(const TemporaryFolder& folder, const std::string& covariance) {
  const auto file = folder.path() / "model.yaml";
  CalibratedModel model;
  model.robot = DesktopHexapod();
  WriteModel(file, model);
  const std::string start = Bytes(file);
  folder.Write("model.yaml", start + covariance);
  return {file, static_cast<int>(std::count(start.begin(), start.end(), '\n')) + 1};
}

TEST(ModelFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  for (const int parameter_count : {1, 2, 57}) {
    const CalibratedModel model = SomeModel(generator, parameter_count);
    WriteModel(folder.path() / "model.yaml", model);
    ExpectSame(ReadModel(folder.path() / "model.yaml"), model);
  }
}

TEST(ModelFile, EverythingButTheRobotMayBeLeftOut) {
  const TemporaryFolder folder;
  CalibratedModel model;
  model.robot = DesktopHexapod();
  WriteModel(folder.path() / "model.yaml", model);
  ExpectSame(ReadModel(folder.path() / "model.yaml"), model);
}

TEST(ModelFile, ARobotFileIsAModelWithoutCameraAndCovariance) {
  const TemporaryFolder folder;
  CalibratedModel model;
  model.robot = DesktopHexapod();
  WriteRobot(folder.path() / "robot.yaml", model.robot);
  ExpectSame(ReadModel(folder.path() / "robot.yaml"), model);
}

TEST(ModelFile, ASimulationSectionIsPassedOver) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(ReadModel(WriteCovariance(folder, "simulation: {noise_px: 0.1}\n").file));
}

TEST(ModelFile, WholeCovarianceRowsReadAsTheLowerTriangle) {
  const TemporaryFolder folder;
  const auto whole =
      WriteCovariance(folder, "covariance:\n  parameters: [a, b]\n  rows: [[1, 0.5], [0.5, 2]]\n").file;
  const Eigen::MatrixXd expected = (Eigen::Matrix2d() << 1, 0.5, 0.5, 2).finished();
  EXPECT_EQ(ReadModel(whole).covariance, expected);
  const auto triangle =
      WriteCovariance(folder, "covariance:\n  parameters: [a, b]\n  rows: [[1], [0.5, 2]]\n").file;
  EXPECT_EQ(ReadModel(triangle).covariance, expected);
}

TEST(ModelFile, CovariancesThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& rows, const std::string& message) {
    const auto [file, line] = WriteCovariance(folder, "covariance:\n  parameters: [a, b]\n  rows:\n" + rows);
    const std::string complaint = InputErrorOf([&, path = file] { ReadModel(path); });
    EXPECT_EQ(complaint, Complaint(file, line + 4, message));
  };
  check("    - [1, 0.5]\n    - [0.4, 2]\n",
        "covariance.rows[2] has 0.4 in column 1, and row 1 has 0.5 in column 2; "
        "give a symmetric matrix or its lower triangle");
  check("    - [1]\n    - [0.5, -2]\n", "covariance.rows[2] has the variance -2; give 0 or more");
  check("    - [1]\n    - [0.5]\n", "covariance.rows[2] has 1 values; give 2");
  check("    - [1]\n    - [0.5, inf]\n",
        "covariance.rows[2][2] is \"inf\", not a finite number; give a number in m, rad or px");
}

TEST(ModelFile, ParameterNamesAndRowsAgree) {
  const TemporaryFolder folder;
  const auto [file, line] =
      WriteCovariance(folder, "covariance:\n  parameters: [a, b, c]\n  rows:\n    - [1]\n    - [0.5, 2]\n");
  const std::string complaint = InputErrorOf([path = file] { ReadModel(path); });
  EXPECT_EQ(complaint, Complaint(file, line + 3, "covariance.rows has 2 values; give 3"));
  const auto [again, again_line] =
      WriteCovariance(folder, "covariance:\n  parameters: [a, a]\n  rows:\n    - [1]\n    - [0.5, 2]\n");
  const std::string again_complaint = InputErrorOf([path = again] { ReadModel(path); });
  EXPECT_EQ(again_complaint,
            Complaint(again, again_line + 1, "covariance.parameters[2] is \"a\" again; name it once"));
}

TEST(ModelFile, ErrorsInASectionNameItsPath) {
  const TemporaryFolder folder;
  const auto [file, line] = WriteCovariance(folder, "");
  const std::string text = Bytes(file);
  const size_t radius = text.find("radius_m: 0.01");
  folder.Write("model.yaml", std::string(text).replace(radius, 14, "radius_m: -1.0"));
  EXPECT_EQ(InputErrorOf([path = file] { ReadModel(path); }),
            Complaint(file, 7, "robot.legs[1].radius_m is -1; give a number greater than 0"));
}

TEST(ModelFile, ACovarianceOfAnotherSizeThanItsNamesIsNotWritten) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  CalibratedModel model = SomeModel(generator, 3);
  model.parameter_names.pop_back();
  EXPECT_THROW(WriteModel(folder.path() / "model.yaml", model), std::invalid_argument);
  EXPECT_THAT(folder.Names(), testing::IsEmpty());
}

}  // namespace
}  // namespace legible
