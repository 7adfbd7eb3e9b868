// Cameras in the formats of other tools, read by those tools.
#include "tests/datasets/camera_formats/camera_formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "datasets/camera_formats/camera_export.h"
#include "tests/datasets/camera_formats/visp_camera.h"
#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/datasets/other_program.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

using testing::HasSubstr;

constexpr char kPython[] = "/usr/bin/python3";  // Debian's, which has Debian's modules
const std::vector<CameraFormat> kFormats = {CameraFormat::kRos, CameraFormat::kOpenCv, CameraFormat::kKalibr,
                                            CameraFormat::kVisp, CameraFormat::kMrcal};

double LargestError(const ExportedCamera& exported) {
  double largest = 0;
  for (const ConversionError& error : exported.errors) largest = std::max(largest, error.max_px);
  return largest;
}

// Whether Python has the module.
bool PythonHas(const std::string& module) {
  return RunShell(fmt::format("{} -c 'import {}'", kPython, module)).exit_code == 0;
}

// The pixels that a Python program prints, "u v" a line.
std::vector<Eigen::Vector2d> PixelsByPython(const TemporaryFolder& folder, const std::string& program) {
  const auto script = folder.Write("project.py", program);
  const ProgramOutput run = RunShell(fmt::format("{} {}", kPython, script.string()));
  EXPECT_EQ(run.exit_code, 0) << run.out;
  std::istringstream numbers(run.out);
  std::vector<Eigen::Vector2d> pixels;
  for (Eigen::Vector2d pixel; numbers >> pixel[0] >> pixel[1];) pixels.push_back(pixel);
  return pixels;
}

std::string PythonList(const std::vector<Eigen::Vector2d>& points) {
  std::string list = "[";
  for (const Eigen::Vector2d& x : points) list += fmt::format("[{}, {}, 1.0], ", x[0], x[1]);
  return list + "]";
}

void ExpectSamePixels(const Camera& camera, const std::vector<Eigen::Vector2d>& points,
                      const std::vector<Eigen::Vector2d>& pixels, double tolerance_px) {
  ASSERT_EQ(pixels.size(), points.size());
  for (size_t i = 0; i < points.size(); ++i)
    EXPECT_TRUE(AreNear(ProjectNormalised(camera, points[i]), pixels[i], tolerance_px));
}

// --- All formats alike. ----------------------------------------------------------------------------------

TEST(CameraFormats, WhatIsWrittenIsRecognisedAndReadsBackAsTheSameBits) {
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens())
    for (const CameraFormat format : kFormats)
      for (const OpenCvText text : {OpenCvText::kYaml, OpenCvText::kXml}) {
        const ExportedCamera exported = ExportCamera({camera, {}}, format, text);
        EXPECT_EQ(RecogniseCameraFormat(exported.text), format) << exported.text;
        const CameraFile again = ReadCamera(folder.Write("any.name", exported.text));
        Camera expected = exported.camera;
        // A pinhole is written as a lens of zeros where the format has no better word for it.
        if (expected.lens == LensModel::kPinhole) expected.lens = again.camera.lens;
        ExpectSame(again.camera, expected);
        EXPECT_FALSE(again.camera_from_base.has_value());
      }
}

TEST(CameraFormats, AreRecognisedByKeysAndNotByWordsInComments) {
  const TemporaryFolder folder;
  const Camera camera = CamerasOfEveryLens().front();
  for (const std::string comment : {"camera_model: pinhole", "camera_matrix: !!opencv-matrix"}) {
    const std::string text = CameraInfoText({camera, {}}) + "# once " + comment + "\n";
    EXPECT_EQ(RecogniseCameraFormat(text), CameraFormat::kRos) << comment;
    ExpectSame(ReadCamera(folder.Write("camera.yaml", text)).camera, camera);
  }
}

TEST(CameraFormats, AreExactWhereTheyHaveTheLens) {
  for (const Camera& camera : CamerasOfEveryLens()) {
    for (const CameraFormat format : {CameraFormat::kRos, CameraFormat::kOpenCv})
      EXPECT_TRUE(ExportCamera({camera, {}}, format).errors.empty());
    const bool is_fisheye = camera.lens == LensModel::kFisheye;
    EXPECT_EQ(ExportCamera({camera, {}}, CameraFormat::kMrcal).errors.empty(), !is_fisheye);
    EXPECT_EQ(ExportCamera({camera, {}}, CameraFormat::kKalibr).errors.empty(),
              is_fisheye || camera.distortion.tail<4>().isZero());
    EXPECT_EQ(ExportCamera({camera, {}}, CameraFormat::kVisp).errors.empty(),
              is_fisheye || camera.lens == LensModel::kPinhole);
  }
}

TEST(CameraFormats, StateHowFarPixelsMove) {
  for (const Camera& camera : CamerasOfEveryLens())
    for (const CameraFormat format : kFormats) {
      const ExportedCamera exported = ExportCamera({camera, {}}, format);
      double largest = 0;
      for (const Eigen::Vector2d& x : PointsInSight(camera))
        largest =
            std::max(largest, (ProjectNormalised(exported.camera, x) - ProjectNormalised(camera, x)).norm());
      const double stated = exported.errors.empty() ? 0 : exported.errors[0].max_px;
      EXPECT_LE(largest, stated + 1e-11);
      EXPECT_GE(largest, 0.99 * stated);  // the corners are among the points
    }
}

TEST(CameraFormats, OnlySomeHoldWhereTheCameraStands) {
  const TemporaryFolder folder;
  for (const CameraFormat format : kFormats) {
    const CameraFile placed = PlacedCamera(DesktopCamera(true));
    const ExportedCamera exported = ExportCamera(placed, format);
    const CameraFile again = ReadCamera(folder.Write("camera", exported.text));
    const bool is_held = format == CameraFormat::kRos || format == CameraFormat::kMrcal;
    EXPECT_EQ(again.camera_from_base.has_value(), is_held);
    EXPECT_EQ(exported.left_behind.empty(), is_held);
    if (!is_held) continue;
    EXPECT_TRUE(AreNear(again.camera_from_base->rotation.toRotationMatrix(),
                        placed.camera_from_base->rotation.toRotationMatrix(), 1e-15));
    EXPECT_EQ(again.camera_from_base->translation, placed.camera_from_base->translation);
  }
}

// --- OpenCV's FileStorage. -------------------------------------------------------------------------------

std::vector<Eigen::Vector2d> PixelsByOpenCv(const cv::Mat& k, const cv::Mat& coefficients, bool is_fisheye,
                                            const std::vector<Eigen::Vector2d>& points) {
  std::vector<cv::Point3d> in_camera;
  in_camera.reserve(points.size());
  for (const Eigen::Vector2d& x : points) in_camera.emplace_back(x[0], x[1], 1);
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d zero(0, 0, 0);
  if (is_fisheye)
    cv::fisheye::projectPoints(in_camera, pixels, zero, zero, k, coefficients);
  else
    cv::projectPoints(in_camera, zero, zero, k, coefficients, pixels);
  std::vector<Eigen::Vector2d> result;
  result.reserve(pixels.size());
  for (const cv::Point2d& pixel : pixels) result.emplace_back(pixel.x, pixel.y);
  return result;
}

TEST(OpenCvCamera, FileStorageReadsWhatIsWrittenAndProjectsAsWeDo) {
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens())
    for (const OpenCvText text : {OpenCvText::kYaml, OpenCvText::kXml}) {
      const auto file = folder.Write(text == OpenCvText::kXml ? "camera.xml" : "camera.yml",
                                     ExportCamera({camera, {}}, CameraFormat::kOpenCv, text).text);
      const cv::FileStorage storage(file, cv::FileStorage::READ);
      const cv::Mat k = storage["camera_matrix"].mat();
      const cv::Mat coefficients = storage["distortion_coefficients"].mat();
      EXPECT_EQ(static_cast<int>(storage["image_width"]), camera.width_px);
      EXPECT_EQ(static_cast<int>(storage["image_height"]), camera.height_px);
      EXPECT_EQ(k.at<double>(0, 0), camera.fx_px);
      EXPECT_EQ(k.at<double>(1, 2), camera.cy_px);
      const bool is_fisheye = static_cast<int>(storage["fisheye_model"]) != 0;
      EXPECT_EQ(is_fisheye, camera.lens == LensModel::kFisheye);
      const auto points = PointsInSight(camera);
      ExpectSamePixels(camera, points, PixelsByOpenCv(k, coefficients, is_fisheye, points), 1e-9);
    }
}

TEST(OpenCvCamera, ReadsWhatFileStorageWritesUnderTheNamesOfItsPrograms) {
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens())
    for (const std::string name :
         {"calibration.yml", "calibration.xml", "interactive.xml", "interactive.yml"}) {
      const bool is_interactive = name.starts_with("interactive");
      const cv::Mat1d k =
          (cv::Mat1d(3, 3) << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
      cv::Mat1d coefficients(1, static_cast<int>(camera.lens));
      for (int i = 0; i < coefficients.cols; ++i) coefficients(0, i) = camera.distortion[i];
      {
        cv::FileStorage storage(folder.path() / name, cv::FileStorage::WRITE);
        storage << "calibrationDate"
                << "Sun Nov 29 2026";
        if (is_interactive)
          storage << "cameraResolution" << cv::Size(camera.width_px, camera.height_px) << "cameraMatrix" << k;
        else
          storage << "image_width" << camera.width_px << "image_height" << camera.height_px << "camera_matrix"
                  << k;
        storage << (is_interactive ? "dist_coeffs" : "distortion_coefficients") << coefficients;
        storage << "fisheye_model" << (camera.lens == LensModel::kFisheye ? 1 : 0);
        storage << "avg_reprojection_error" << 0.25;
      }
      ExpectSame(ReadCamera(folder.path() / name).camera, camera);
    }
}

TEST(OpenCvCamera, WhatIsWrongIsNamed) {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& old_part, const std::string& new_part) {
    const auto text = ExportCamera({DesktopCamera(true), {}}, CameraFormat::kOpenCv).text;
    const auto file = folder.Write("camera.yml", Replaced(text, old_part, new_part));
    return InputErrorOf([&] { ReadCamera(file); });
  };
  const auto file = folder.path() / "camera.yml";
  EXPECT_EQ(
      complaint("image_width", "image_breadth"),
      Complaint(file, 0,
                "is OpenCV's, and has no \"image_width\" or \"image_Width\"; add it, or name another file"));
  EXPECT_EQ(
      complaint("1246.83, 0,", "1246.83, 3,"),
      Complaint(file, 6,
                "camera_matrix is not of the form [fx, 0, cx, 0, fy, cy, 0, 0, 1]; give one without skew"));
  EXPECT_THAT(complaint("1246.83", "12.4683"),
              HasSubstr(":6: camera_matrix has fx 12.4683 px for an image 1280"));
  EXPECT_THAT(complaint("[ -0.18, 0.06, 0.0007, -0.0004, 0 ]", "[ 1, 2, 3 ]"),
              HasSubstr(":11: distortion_coefficients has 3 values; give 4, 5 or 8"));
  EXPECT_THAT(complaint("[ -0.18, 0.06, 0.0007, -0.0004, 0 ]", "[ 0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0, 0, 0 ]"),
              HasSubstr("thin prism"));
  EXPECT_THAT(complaint("fisheye_model: 0", "fisheye_model: 1"),
              HasSubstr("has 5 values, and a fisheye has 4"));
}

// --- ViSP's XML. -----------------------------------------------------------------------------------------

VispLens VispLensOf(const Camera& camera) {
  if (camera.lens == LensModel::kFisheye) return VispLens::kFisheye;
  return camera.distortion.isZero() ? VispLens::kPinhole : VispLens::kRadial;
}

TEST(VispCamera, ItsParserReadsWhatIsWrittenAndItProjectsAsIsSaid) {
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens()) {
    const ExportedCamera exported = ExportCamera({camera, {}}, CameraFormat::kVisp);
    const auto file = folder.Write("camera.xml", exported.text);
    const legible::VispCamera found = ReadByVisp(file, VispLensOf(camera), camera.width_px, camera.height_px);
    const auto points = PointsInSight(camera);
    double way_back = 0;
    for (const Eigen::Vector2d& x : points) {
      const auto [u, v] = ToPixelByVisp(found, x[0], x[1]);
      EXPECT_TRUE(AreNear(ProjectNormalised(exported.camera, x), Eigen::Vector2d(u, v), 1e-9));
      const Eigen::Vector2d pixel = ProjectNormalised(camera, x);
      const auto [back_x, back_y] = ToMetreByVisp(found, pixel[0], pixel[1]);
      way_back = std::max(way_back, (ProjectNormalised(camera, {back_x, back_y}) - pixel).norm());
    }
    if (found.lens != VispLens::kRadial) continue;
    ASSERT_EQ(exported.errors.size(), 2u);
    EXPECT_NEAR(way_back, exported.errors[1].max_px, 0.01 * way_back);
    std::cout << "kud " << found.values[4] << " kdu " << found.values[5] << ": projection "
              << exported.errors[0].rms_px << " px rms, " << exported.errors[0].max_px << " at most; back "
              << exported.errors[1].rms_px << ", " << exported.errors[1].max_px << std::endl;
  }
}

TEST(VispCamera, ReadsWhatVispWrites) {
  const TemporaryFolder folder;
  const std::vector<legible::VispCamera> cameras = {
      {VispLens::kPinhole, {1246.83, 1249.57, 654.12, 467.63}},
      {VispLens::kRadial, {1246.83, 1249.57, 654.12, 467.63, -0.1771, 0.1893}},
      {VispLens::kFisheye, {668.31, 669.77, 654.12, 467.63, -0.021, 0.012, -0.009, 0.0021, 0}}};
  for (const legible::VispCamera& written : cameras) {
    const std::string file = folder.path() / fmt::format("{}.xml", written.values.size());
    WriteByVisp(file, written, 1280, 960);
    const Camera found = ReadCamera(file).camera;
    EXPECT_EQ(found.width_px, 1280);
    EXPECT_EQ(found.height_px, 960);
    for (const Eigen::Vector2d& x : PointsInSight(found)) {
      const auto [u, v] = ToPixelByVisp(written, x[0], x[1]);
      EXPECT_TRUE(AreNear(ProjectNormalised(found, x), Eigen::Vector2d(u, v), 1e-9));
    }
  }
}

TEST(VispCamera, TakesTheLensWithDistortionOfBothAndAsksWhichCameraIsMeant) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "camera.xml";
  WriteByVisp(file, {VispLens::kPinhole, {1246.83, 1249.57, 654.12, 467.63}}, 1280, 960);
  WriteByVisp(file, {VispLens::kRadial, {1250, 1249.57, 654.12, 467.63, -0.2, 0.2}}, 1280, 960);
  EXPECT_EQ(ReadCamera(file).camera.fx_px, 1250);
  WriteByVisp(file, {VispLens::kPinhole, {623, 624, 327, 233}}, 640, 480);
  EXPECT_THAT(
      InputErrorOf([&] { ReadCamera(file); }),
      HasSubstr("is another camera: camera of 1280 x 960 px beside camera of 640 x 480 px; keep the one"));
}

// --- mrcal. ----------------------------------------------------------------------------------------------

TEST(MrcalCamera, MrcalReadsWhatIsWrittenAndProjectsAsWeDo) {
  if (!PythonHas("mrcal")) GTEST_SKIP() << "Debian's python3-mrcal is not installed";
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens()) {
    const ExportedCamera exported = ExportCamera(PlacedCamera(camera), CameraFormat::kMrcal);
    const auto file = folder.Write("ours.cameramodel", exported.text);
    const auto points = PointsInSight(exported.camera);
    const auto pixels = PixelsByPython(
        folder,
        fmt::format(
            "import mrcal, numpy\n"
            "m = mrcal.cameramodel('{}')\n"
            "assert tuple(m.imagersize()) == ({}, {})\n"
            "for q in mrcal.project(numpy.array({}), *m.intrinsics()): print(*map(repr, map(float, q)))\n",
            file.string(), camera.width_px, camera.height_px, PythonList(points)));
    ExpectSamePixels(exported.camera, points, pixels, 1e-9);
  }
}

// Where the camera stands, by a point of the base frame.
TEST(MrcalCamera, ItsReferenceFrameIsTheBase) {
  if (!PythonHas("mrcal")) GTEST_SKIP() << "Debian's python3-mrcal is not installed";
  const TemporaryFolder folder;
  const CameraFile placed = PlacedCamera(DesktopCamera(true));
  const auto file = folder.Write("ours.cameramodel", ExportCamera(placed, CameraFormat::kMrcal).text);
  const auto pixels = PixelsByPython(
      folder,
      fmt::format("import mrcal, numpy\n"
                  "m = mrcal.cameramodel('{}')\n"
                  "p = mrcal.transform_point_rt(m.extrinsics_rt_fromref(), numpy.array([0.1, -0.05, 0.2]))\n"
                  "print(*map(repr, map(float, mrcal.project(p, *m.intrinsics()))))\n",
                  file.string()));
  ASSERT_EQ(pixels.size(), 1u);
  EXPECT_TRUE(AreNear(Project(placed.camera, *placed.camera_from_base * Eigen::Vector3d(0.1, -0.05, 0.2)),
                      pixels[0], 1e-9));
}

TEST(MrcalCamera, ReadsWhatMrcalWrites) {
  if (!PythonHas("mrcal")) GTEST_SKIP() << "Debian's python3-mrcal is not installed";
  const TemporaryFolder folder;
  const std::string values =
      "1246.83, 1249.57, 654.12, 467.63, -0.18, 0.06, 0.0007, -0.0004, -0.01, 0.02, 0.01, 0.001";
  for (const auto& [name, count] : std::vector<std::pair<std::string, int>>{
           {"PINHOLE", 4}, {"OPENCV4", 8}, {"OPENCV5", 9}, {"OPENCV8", 12}}) {
    const auto file = folder.path() / (name + ".cameramodel");
    const auto pixels = PixelsByPython(
        folder,
        fmt::format(
            "import mrcal, numpy\n"
            "m = mrcal.cameramodel(intrinsics=('LENSMODEL_{}', numpy.array([{}][:{}])),\n"
            "  imagersize=(1280, 960), extrinsics_rt_fromref=numpy.array([.1, .2, -.3, 1, 2, 3.]))\n"
            "m.write('{}', note='with a (note)')\n"
            "print(*map(repr, map(float, mrcal.project(numpy.array([.2, -.1, 1]), *m.intrinsics()))))\n",
            name, values, count, file.string()));
    const CameraFile found = ReadCamera(file);
    ASSERT_EQ(pixels.size(), 1u);
    EXPECT_TRUE(AreNear(ProjectNormalised(found.camera, {0.2, -0.1}), pixels[0], 1e-9)) << name;
    EXPECT_TRUE(AreNear(found.camera_from_base->translation, Eigen::Vector3d(1, 2, 3), 0));
    EXPECT_TRUE(
        AreNear(VectorFromRotation(found.camera_from_base->rotation), Eigen::Vector3d(.1, .2, -.3), 1e-15));
  }
}

constexpr char kMrcalOfManyKeys[] = R"(# made by hand
{ 'lens_model':  'LENSMODEL_OPENCV4',
  'intrinsics': ( 1246.83, 1249.57, 654.12, 467.63, -0.18, 0.06, 0.0007, -0.0004, ),
  'valid_intrinsics_region': [ [ 0, 0 ], [ 0, 959 ], ],# not looked at
  'rt_cam_ref': [ 0, 0, 0, 0, 0, 0, ],
  'imagersize': [ 1280, 960, ],
  'icam_intrinsics': 0,
  'optimization_inputs': b'P)h>@6aWAK2mnY{r(#&}Ax#]!;{[%',
}
)";

TEST(MrcalCamera, ReadsPythonsLiterals) {
  const TemporaryFolder folder;
  const CameraFile found = ReadCamera(folder.Write("m.cameramodel", kMrcalOfManyKeys));
  ExpectSame(found.camera, DesktopCamera(true));
  EXPECT_FALSE(found.camera_from_base.has_value());
}

// The reference may be another camera, of which the file says nothing.
TEST(MrcalCamera, APlaceIsTakenWithAWarning) {
  const TemporaryFolder folder;
  EXPECT_TRUE(ReadCamera(folder.Write("m.cameramodel", kMrcalOfManyKeys)).warnings.empty());
  const std::string placed = Replaced(kMrcalOfManyKeys, "[ 0, 0, 0, 0, 0, 0, ]", "[ 0, 0, 0, 0.1, 0, 0 ]");
  const CameraFile found = ReadCamera(folder.Write("m.cameramodel", placed));
  EXPECT_EQ(found.camera_from_base->translation, Eigen::Vector3d(0.1, 0, 0));
  ASSERT_EQ(found.warnings.size(), 1);
  EXPECT_NE(found.warnings[0].find("where the reference is another camera"), std::string::npos);
}

TEST(MrcalCamera, OtherLensesAreRefusedByName) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "m.cameramodel";
  for (const std::string lens : {"LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=30_Ny=20_fov_x_deg=170",
                                 "LENSMODEL_CAHVOR", "LENSMODEL_OPENCV12"}) {
    folder.Write("m.cameramodel", Replaced(kMrcalOfManyKeys, "LENSMODEL_OPENCV4", lens));
    EXPECT_EQ(InputErrorOf([&] { ReadCamera(file); }),
              Complaint(file, 2,
                        fmt::format("lens_model is \"{}\", a lens model not known here; convert it with "
                                    "`mrcal-convert-lensmodel LENSMODEL_OPENCV8`",
                                    lens)));
  }
}

// --- Kalibr. ---------------------------------------------------------------------------------------------

// What kalibr_common's ConfigReader demands of a camera, and aslam's two distortions.
constexpr char kKalibrReader[] = R"(
import math, yaml
c = yaml.safe_load(open('{}'))['cam0']
assert c['camera_model'] == 'pinhole' and len(c['intrinsics']) == 4
assert all(isinstance(x, float) and x >= 0 for x in c['intrinsics'])
assert len(c['distortion_coeffs']) == 4 and all(isinstance(x, float) for x in c['distortion_coeffs'])
assert c['resolution'] == [{}, {}] and all(isinstance(n, int) for n in c['resolution'])
assert isinstance(c['rostopic'], str)
fu, fv, pu, pv = c['intrinsics']
k1, k2, p1, p2 = c['distortion_coeffs']
for x, y, z in {}:
    r2 = x * x + y * y
    if c['distortion_model'] == 'radtan':
        rad = k1 * r2 + k2 * r2 * r2
        u, v = x + x * rad + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y + y * rad + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)
    else:
        assert c['distortion_model'] == 'equidistant'
        r = math.sqrt(r2)
        t = math.atan(r)
        s = t * (1 + k1 * t**2 + k2 * t**4 + p1 * t**6 + p2 * t**8) / r if r > 1e-8 else 1.0
        u, v = x * s, y * s
    print(repr(fu * u + pu), repr(fv * v + pv))
)";

TEST(KalibrCamera, ItsReaderTakesWhatIsWrittenAndItsModelsProjectAsWeDo) {
  if (!PythonHas("yaml")) GTEST_SKIP() << "Debian's python3-yaml is not installed";
  const TemporaryFolder folder;
  for (const Camera& camera : CamerasOfEveryLens()) {
    const ExportedCamera exported = ExportCamera({camera, {}}, CameraFormat::kKalibr);
    const auto file = folder.Write("camchain.yaml", exported.text);
    const auto points = PointsInSight(camera);
    ExpectSamePixels(exported.camera, points,
                     PixelsByPython(folder, fmt::format(kKalibrReader, file.string(), camera.width_px,
                                                        camera.height_px, PythonList(points))),
                     1e-9);
    std::cout << static_cast<int>(camera.lens) << " coefficients: " << LargestError(exported)
              << " px at most\n";
  }
}

constexpr char kCamchain[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.18, 0.06, 0.0007, -0.0004]
  distortion_model: radtan
  intrinsics: [1246.83, 1249.57, 654.12, 467.63]
  resolution: [1280, 960]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: 0.001
)";

TEST(KalibrCamera, ReadsACamchain) {
  const TemporaryFolder folder;
  ExpectSame(ReadCamera(folder.Write("camchain.yaml", kCamchain)).camera, DesktopCamera(true));
}

TEST(KalibrCamera, OtherModelsAndSeveralCamerasAreRefusedByName) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camchain.yaml";
  const auto complaint = [&](const std::string& old_part, const std::string& new_part) {
    folder.Write("camchain.yaml", Replaced(kCamchain, old_part, new_part));
    return InputErrorOf([&] { ReadCamera(file); });
  };
  for (const std::string model : {"omni", "eucm", "ds"})
    EXPECT_EQ(
        complaint("pinhole", model),
        Complaint(file, 3,
                  fmt::format("cam0.camera_model is \"{}\", a camera model not known here; calibrate with "
                              "pinhole-radtan or pinhole-equi",
                              model)));
  EXPECT_THAT(complaint("radtan", "fov"),
              HasSubstr(":5: cam0.distortion_model is \"fov\", a lens model not known"));
  EXPECT_THAT(complaint("rostopic: /cam0/image_raw\n",
                        std::string("rostopic: /cam0/image_raw\ncam1:\n  camera_model: ds\n")),
              HasSubstr("is Kalibr's, and holds 2 cameras (cam0, cam1); keep the one that is meant"));
  EXPECT_THAT(complaint("1246.83", "12"), HasSubstr(":6: cam0.intrinsics has fx 12 px"));
}

}  // namespace
}  // namespace legible
