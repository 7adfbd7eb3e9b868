#include "datasets/camera_file.h"

#include <fmt/format.h>

#include "datasets/camera_formats/camera_export.h"
#include "datasets/synthetic_session.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

// As ROS's camera_calibration writes it.
constexpr char kRos[] = R"(image_width: 1280
image_height: 960
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [1246.83, 0.     , 654.12,
           0.   , 1249.57, 467.63,
           0.   ,    0.   ,   1.  ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.18, 0.06, 0.0007, -0.0004, 0.000000]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1., 0., 0., 0., 1., 0., 0., 0., 1.]
projection_matrix:
  rows: 3
  cols: 4
  data: [1200., 0., 654., 0., 0., 1200., 467., 0., 0., 0., 1., 0.]
)";

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& old_part,
                          const std::string& new_part) {
  const auto file = folder.Write("camera.yaml", Replaced(kRos, old_part, new_part));
  return InputErrorOf([&] { ReadCamera(file); });
}

TEST(CameraFile, ReadsWhatRosWrites) {
  const TemporaryFolder folder;
  const CameraFile file = ReadCamera(folder.Write("camera.yaml", kRos));
  Camera expected = DesktopCamera(true);
  ExpectSame(file.camera, expected);
  EXPECT_FALSE(file.camera_from_base.has_value());
}

TEST(CameraFile, RoundTripIsExactForEveryLens) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "camera.yaml";
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens :
       {LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady, LensModel::kRational}) {
    Camera camera = DesktopCamera(false);
    camera.lens = lens;
    camera.fx_px = Uniform(generator, 1000, 2000);
    camera.cy_px = Uniform(generator, -10, 1000);
    for (int i = 0; i < static_cast<int>(lens); ++i) camera.distortion[i] = Uniform(generator, -1, 1);
    const Rigid3 placement = {UniformRotation(generator), UniformVector(generator, -1, 1)};
    WriteCamera(path, camera, placement);
    const CameraFile file = ReadCamera(path);
    ExpectSame(file.camera, camera);
    ASSERT_TRUE(file.camera_from_base.has_value());
    ExpectSame(*file.camera_from_base, placement);
    WriteCamera(path, camera);
    EXPECT_FALSE(ReadCamera(path).camera_from_base.has_value());
  }
}

// 4 + 5 square, of a random covariance; of rank 7 where `rank` says so.
Eigen::MatrixXd SomeInformation(std::mt19937_64& generator, Eigen::Index rank) {
  Eigen::MatrixXd root(rank, 9);
  for (double& value : root.reshaped()) value = Uniform(generator, -1, 1);
  const Eigen::MatrixXd information = root.transpose() * root;
  return information.selfadjointView<Eigen::Lower>();
}

TEST(CameraFile, KeepsTheInformationOfABoardToTheBit) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  for (const Eigen::Index rank : {9, 7}) {
    const CameraFile file{DesktopCamera(true), std::nullopt, SomeInformation(generator, rank)};
    const CameraFile again = ReadCamera(folder.Write("camera.yaml", CameraInfoText(file)));
    EXPECT_EQ(again.information, file.information);
  }
}

TEST(CameraFile, RefusesAnInformationThatIsNone) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  CameraFile file{DesktopCamera(true), std::nullopt, SomeInformation(generator, 9)};
  const auto complaint = [&] {
    const auto path = folder.Write("camera.yaml", CameraInfoText(file));
    return InputErrorOf([&] { ReadCamera(path); });
  };
  file.information(1, 0) = file.information(0, 1) =
      2 * std::sqrt(file.information(0, 0) * file.information(1, 1));
  EXPECT_THAT(complaint(), testing::HasSubstr("information is no inverse covariance"));
  file.information.conservativeResize(8, 8);
  EXPECT_THAT(complaint(), testing::HasSubstr("information"));
}

TEST(CameraFile, RefusesAnInformationWithWhichNothingCanBeComputed) {
  const TemporaryFolder folder;
  for (const double absurd : {1e25, 1e300}) {
    CameraFile file{DesktopCamera(true), std::nullopt, Eigen::MatrixXd::Identity(9, 9)};
    file.information(4, 4) = absurd;
    const auto path = folder.Write("camera.yaml", CameraInfoText(file));
    EXPECT_THAT(InputErrorOf([&] { ReadCamera(path); }),
                testing::AllOf(testing::HasSubstr("information has 1e+"), testing::HasSubstr("for k1, ")));
  }
  // Nothing known of a parameter that goes together with another.
  CameraFile file{DesktopCamera(true), std::nullopt, Eigen::MatrixXd::Identity(9, 9)};
  file.information(0, 0) = 0;
  file.information(1, 0) = file.information(0, 1) = 1e300;
  const auto path = folder.Write("camera.yaml", CameraInfoText(file));
  EXPECT_THAT(InputErrorOf([&] { ReadCamera(path); }), testing::HasSubstr("information is no inverse"));
}

// In every format: by the reader of the file or by the one for all.
TEST(CameraFile, RefusesACoefficientThatNoLensHasByItsName) {
  const TemporaryFolder folder;
  for (const double absurd : {1e300, -1e300, 1e9}) {
    Camera camera = DesktopCamera(true);
    camera.distortion[2] = absurd;
    for (const CameraFormat format : {CameraFormat::kRos, CameraFormat::kOpenCv}) {
      const auto path = folder.Write("camera", ExportCamera({camera, {}}, format).text);
      EXPECT_THAT(InputErrorOf([&] { ReadCamera(path); }),
                  testing::HasSubstr(fmt::format("has p1 {:g}, which is no lens's", absurd)));
    }
  }
}

TEST(CameraFile, NoneOrNothingIsThePinhole) {
  const TemporaryFolder folder;
  const std::string ros = Replaced(Replaced(kRos, "  cols: 5\n", "  cols: 0\n"),
                                   "[-0.18, 0.06, 0.0007, -0.0004, 0.000000]", "[]");
  for (const std::string model : {"none", "\"\"", ""}) {
    const auto file = folder.Write("camera.yaml", Replaced(ros, "plumb_bob", model));
    EXPECT_EQ(ReadCamera(file).camera.lens, LensModel::kPinhole) << model;
  }
  const std::string without = std::string(kRos).substr(0, std::string(kRos).find("distortion_model"));
  EXPECT_EQ(ReadCamera(folder.Write("camera.yaml", without + "distortion_model: none\n")).camera.lens,
            LensModel::kPinhole);
}

TEST(CameraFile, AFocalLengthThatContradictsTheImageSizeIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  const std::string mend = "; give the focal length in pixels, between 0.2 and 50 times that size";
  EXPECT_EQ(
      ReadComplaint(folder, "1246.83", "100"),
      Complaint(file, 5,
                "camera_matrix has fx 100 px for an image 1280 px wide, which means a field of view of 162 "
                "degrees" +
                    mend));
  EXPECT_EQ(
      ReadComplaint(folder, "1249.57", "96000"),
      Complaint(
          file, 5,
          "camera_matrix has fy 96000 px for an image 960 px high, which means a field of view of 0.573 "
          "degrees" +
              mend));
  EXPECT_EQ(ReadComplaint(folder, "1246.83", "-1246.83"),
            Complaint(file, 5, "camera_matrix has fx -1246.83 px; give a number greater than 0"));
}

TEST(CameraFile, PrincipalPointLiesInTheImage) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadComplaint(folder, "654.12", "6541.2"),
            Complaint(folder.path() / "camera.yaml", 5,
                      "camera_matrix has cx 6541.2 px for an image 1280 px wide; give the principal point in "
                      "pixels, in the image or near it"));
}

TEST(CameraFile, MatricesHaveTheirForm) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  EXPECT_EQ(
      ReadComplaint(folder, "[1246.83, 0.     ,", "[1246.83, 0.5,"),
      Complaint(file, 5,
                "camera_matrix is not of the form [fx, 0, cx, 0, fy, cy, 0, 0, 1]; give one without skew"));
  EXPECT_EQ(
      ReadComplaint(folder, "           0.   ,    0.   ,   1.  ]", "           0. ]"),
      Complaint(file, 5, "camera_matrix has 7 values for 3 rows and 3 cols; give rows times cols values"));
  EXPECT_EQ(ReadComplaint(folder, "  cols: 3\n  data: [1246.83, 0.     , 654.12,",
                          "  cols: 4\n  data: [0, 0, 0, 1246.83, 0.     , 654.12,"),
            Complaint(file, 5, "camera_matrix has 12 values; give the 9 of a 3 x 3 matrix"));
  EXPECT_EQ(
      ReadComplaint(folder, "654.12", "nan"),
      Complaint(file, 7,
                "camera_matrix.data[3] is \"nan\", not a finite number; give a number in m, rad or px"));
}

TEST(CameraFile, DistortionHasTheCoefficientsOfItsModel) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  EXPECT_EQ(ReadComplaint(folder, "plumb_bob", "rational_polynomial"),
            Complaint(file, 12,
                      "distortion_coefficients has 5 values, and rational_polynomial has 8; "
                      "give as many as the model has, or name another distortion_model"));
  EXPECT_EQ(ReadComplaint(folder, "plumb_bob", "omnidirectional"),
            Complaint(file, 10,
                      "distortion_model is \"omnidirectional\", a lens model not known here; "
                      "give plumb_bob, rational_polynomial, equidistant or none"));
}

TEST(CameraFile, SizesAreWholeAndPositive) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  EXPECT_EQ(ReadComplaint(folder, "image_width: 1280", "image_width: 1280.5"),
            Complaint(file, 1, "image_width is \"1280.5\", not a whole number; give a whole number"));
  EXPECT_EQ(ReadComplaint(folder, "image_height: 960", "image_height: 0"),
            Complaint(file, 2, "image_height is 0; give a whole number greater than 0"));
}

TEST(CameraFile, KeysNotOfCameraInfoAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadComplaint(folder, "camera_name: narrow_stereo",
                          "camera_from_bas: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}"),
            Complaint(folder.path() / "camera.yaml", 3,
                      "the file has the unknown key \"camera_from_bas\"; "
                      "the nearest known key is \"camera_from_base\": rename it or take it out"));
}

TEST(CameraFile, BinningAndRegionsMustLeaveTheWholeImage) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  const std::string whole =
      "roi: {x_offset: 0, y_offset: 0, width: 1280, height: 0, do_rectify: false}\nbinning_x: 1";
  EXPECT_NO_THROW(
      ReadCamera(folder.Write("camera.yaml", Replaced(kRos, "camera_name: narrow_stereo", whole))));
  EXPECT_EQ(ReadComplaint(folder, "camera_name: narrow_stereo", "binning_y: 2"),
            Complaint(file, 3, "binning_y is 2; give the camera of the images as they are, unbinned"));
  EXPECT_EQ(ReadComplaint(folder, "camera_name: narrow_stereo", "roi: {x_offset: 8}"),
            Complaint(file, 3, "roi.x_offset is 8; give the camera of the images as they are, without roi"));
}

}  // namespace
}  // namespace legible
