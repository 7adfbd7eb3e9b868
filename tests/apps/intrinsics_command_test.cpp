// `legible intrinsics` on rendered images of boards and on corners that a real camera saw.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/vision/gray_image.h"
#include "datasets/camera_file.h"
#include "tests/apps/program_fixture.h"
#include "tests/testing/random.h"
#include "tests/testing/render_board.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// 640 x 480, a little barrel distortion.
Camera TrueCamera() {
  Camera camera{640, 480, 610, 608, 322, 236, LensModel::kBrownConrady, Distortion::Zero()};
  camera.distortion.head<2>() << -0.2, 0.06;
  return camera;
}

constexpr char kBoardYaml[] =
    "board: tags\nfamily: tag36h11\ncolumns: 4\nrows: 3\ntag_size_m: 0.04\nspacing_m: 0.012\n";

// A folder with images of a board of 4 x 3 tags in `images`, and its board.yaml, for a test to break.
class BoardImages : public testing::Test {
 protected:
  static constexpr int kImages = 12;

  BoardImages() {
    folder_.Write("board.yaml", kBoardYaml);
    for (int i = 0; i < kImages; ++i)
      folder_.Write(fmt::format("images/{:03}.png", i), Pngs().at(static_cast<size_t>(i)));
  }

  std::filesystem::path images() const { return folder_.path() / "images"; }
  std::filesystem::path board() const { return folder_.path() / "board.yaml"; }
  std::filesystem::path out() const { return folder_.path() / "out"; }

  ProgramRun RunOnIt(std::vector<std::string> options = {}) const {
    options.insert(options.begin(),
                   {"intrinsics", images().string(), "--board", board().string(), "--out", out().string()});
    return RunLegible(options);
  }

  void ExpectRefusal(const ProgramRun& run, int exit_code,
                     const testing::Matcher<const std::string&>& line) const {
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_THAT(run.err, line);
    EXPECT_THAT(run.err, testing::StartsWith("legible: "));
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(out()));
  }

  void KeepImages(int count) const {
    for (int i = count; i < kImages; ++i) std::filesystem::remove(images() / fmt::format("{:03}.png", i));
  }

  TemporaryFolder folder_;

 private:
  // Rendered once for all tests.
  static const std::vector<std::string>& Pngs() {
    static const std::vector<std::string> pngs = [] {
      std::mt19937_64 generator(20);
      std::normal_distribution<double> normal;
      const Board board{"board", TagGrid("tag36h11", 4, 3, 0.04, 0.012), std::nullopt};
      std::vector<std::string> list;
      for (int i = 0; i < kImages; ++i) {
        const Rigid3 pose = BoardPose(i % 4 == 0 ? 0.05 : 0.6, 2.4 * i, 0.3 * normal(generator),
                                      {0.05 * (i % 3 - 1), 0.04 * (i % 5 - 2), 0.27 + 0.01 * (i % 4)});
        list.push_back(EncodePng(WithNoise(RenderBoard(board, TrueCamera(), pose), 2, generator)));
      }
      return list;
    }();
    return pngs;
  }
};

json ReadJson(const std::filesystem::path& file) { return json::parse(Bytes(file)); }

TEST_F(BoardImages, LeadToTheTrueCameraWithinItsOwnUncertainty) {
  const ProgramRun run = RunOnIt();
  ASSERT_EQ(run.exit_code, kExitSuccess) << run.err;
  const json found = ReadJson(out() / "intrinsics.json");
  EXPECT_EQ(found["status"], "converged");
  const json& camera = found["camera"];
  const Camera truth = TrueCamera();
  EXPECT_NEAR(camera["fx"], truth.fx_px, 4 * camera["sigma"]["fx"].get<double>());
  EXPECT_NEAR(camera["fy"], truth.fy_px, 4 * camera["sigma"]["fy"].get<double>());
  EXPECT_NEAR(camera["cx"], truth.cx_px, 4 * camera["sigma"]["cx"].get<double>());
  EXPECT_NEAR(camera["cy"], truth.cy_px, 4 * camera["sigma"]["cy"].get<double>());
  EXPECT_LT(camera["sigma"]["fx"].get<double>(), 1.0);
  EXPECT_LT(found["noise_px"].get<double>(), 0.05);
  EXPECT_FALSE(found["cross_validation"]["misfit"].get<bool>()) << found["cross_validation"]["sentence"];
  EXPECT_EQ(found["views_used"], kImages);
}

TEST_F(BoardImages, GiveACameraFileThatKeepsHowWellItIsKnown) {
  ASSERT_EQ(RunOnIt().exit_code, kExitSuccess);
  const CameraFile file = ReadCamera(out() / "camera.yaml");
  const json found = ReadJson(out() / "intrinsics.json");
  EXPECT_EQ(file.camera.fx_px, found["camera"]["fx"].get<double>());
  ASSERT_EQ(file.information.rows(), 9);
  const Eigen::MatrixXd covariance = file.information.inverse();
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), found["camera"]["sigma"]["fx"].get<double>(), 1e-6);
}

// Before any image is looked at: this one could not be read.
TEST_F(BoardImages, OfABoardOfASingleTagAreRefusedBeforeItIsLookedFor) {
  folder_.Write("board.yaml",
                "board: tags\nfamily: tag36h11\ncolumns: 1\nrows: 1\ntag_size_m: 0.04\nspacing_m: 0.012\n");
  folder_.Write("images/000.png", "no image");
  ExpectRefusal(
      RunOnIt(), kExitBadInput,
      HasSubstr("board.yaml: has 4 corners, and a view counts with 6 or more; take a board of several"));
}

TEST_F(BoardImages, PrintOneDocumentAsJson) {
  const ProgramRun run = RunOnIt({"--format", "json"});
  ASSERT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_EQ(json::parse(run.out), ReadJson(out() / "intrinsics.json"));
}

TEST_F(BoardImages, SayForPeopleWhatWasFoundAndWhatToAddNext) {
  const ProgramRun run = RunOnIt();
  EXPECT_THAT(run.out, AllOf(HasSubstr("12 views"), HasSubstr("12 tags of tag36h11"), HasSubstr("fx"),
                             HasSubstr("the lens model fits"), HasSubstr("add a view of the board")));
}

TEST_F(BoardImages, AreDrawnIntoTheReport) {
  ASSERT_EQ(RunOnIt().exit_code, kExitSuccess);
  const std::string page = Bytes(out() / "report.html");
  EXPECT_THAT(
      page, AllOf(HasSubstr("data:image/jpeg;base64"), HasSubstr("011.png"), HasSubstr("left_out_corners")));
}

// --- What is refused: a cause, exit code 2 or 1, nothing written. ----------------------------------------

TEST_F(BoardImages, RefuseToBeOne) {
  KeepImages(1);
  ExpectRefusal(RunOnIt(), kExitNoResult, HasSubstr("1 view of the board cannot determine a camera"));
}

TEST_F(BoardImages, SayInJsonTooThatThereIsNoCamera) {
  KeepImages(2);
  const ProgramRun run = RunOnIt({"--format", "json"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  const json document = json::parse(run.out);
  EXPECT_EQ(document["status"], "too_few_views");
  EXPECT_THAT(document["message"].get<std::string>(), HasSubstr("2 views of the board"));
  EXPECT_FALSE(document.contains("camera"));
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(BoardImages, RefuseToBeTheSameTenTimes) {
  for (int i = 1; i < kImages; ++i) {
    std::filesystem::remove(images() / fmt::format("{:03}.png", i));
    if (i < 10) std::filesystem::copy(images() / "000.png", images() / fmt::format("{:03}.png", i));
  }
  ExpectRefusal(RunOnIt(), kExitNoResult, HasSubstr("10 views show the board in the same place"));
}

TEST_F(BoardImages, RefuseABoardWithARowTooFew) {
  folder_.Write("board.yaml", Replaced(kBoardYaml, "rows: 3", "rows: 2"));
  ExpectRefusal(RunOnIt(), kExitBadInput,
                AllOf(HasSubstr("board.yaml"), HasSubstr("tag 11"), HasSubstr("mend rows")));
}

TEST_F(BoardImages, RefuseABoardWithARowTooMany) {
  folder_.Write("board.yaml", Replaced(kBoardYaml, "rows: 3", "rows: 4"));
  ExpectRefusal(RunOnIt(), kExitBadInput,
                AllOf(HasSubstr("12, 13, 14, 15"), HasSubstr("no image shows any")));
}

TEST_F(BoardImages, RefuseABoardWithWrongColumnsAndSayWhichTheyShow) {
  folder_.Write("board.yaml",
                Replaced(Replaced(kBoardYaml, "columns: 4", "columns: 3"), "rows: 3", "rows: 4"));
  ExpectRefusal(RunOnIt(), kExitBadInput, AllOf(HasSubstr("board.yaml"), HasSubstr("as in 4 columns")));
}

TEST_F(BoardImages, RefuseAWrongTagSizeAndSayByWhichFactor) {
  folder_.Write("board.yaml", Replaced(Replaced(kBoardYaml, "0.04", "0.03"), "0.012", "0.022"));
  ExpectRefusal(RunOnIt(), kExitBadInput,
                AllOf(HasSubstr("board.yaml"), testing::ContainsRegex("1\\.3[34] times as large")));
}

// A centimetre more on the tags with the same space between: 0.97 in the ratio of size and pitch.
TEST_F(BoardImages, RefuseATagSizeThatIsWrongByLittle) {
  folder_.Write("board.yaml", Replaced(kBoardYaml, "0.04", "0.045"));
  ExpectRefusal(RunOnIt(), kExitBadInput,
                testing::ContainsRegex("contradict: they are 0\\.97[0-9] times as large"));
}

TEST_F(BoardImages, CountOnceEachHoweverTheyAreNamed) {
  ExpectRefusal(RunLegible({"intrinsics", images().string(), (images() / "003.png").string(), "--board",
                            board().string(), "--out", out().string()}),
                kExitBadInput, HasSubstr("003.png: is named twice"));
}

TEST_F(BoardImages, RefuseAGuessOfAnotherSizeOrOfNothing) {
  folder_.Write("guess.yaml", CameraInfoText({Camera{1280, 960, 1200, 1200, 640, 480}, std::nullopt, {}}));
  ExpectRefusal(RunOnIt({"--guess", (folder_.path() / "guess.yaml").string()}), kExitBadInput,
                HasSubstr("guess.yaml: is a camera of 1280 x 960 px"));
  ExpectRefusal(RunOnIt({"--guess", "-5"}), kExitBadInput, HasSubstr("--guess"));
}

TEST_F(BoardImages, RefuseAHopelessGuess) {
  ExpectRefusal(RunOnIt({"--guess", "100"}), kExitBadInput,
                AllOf(HasSubstr("focal length of 100 px"), HasSubstr("leave --guess out")));
}

TEST_F(BoardImages, RefuseTwoSizes) {
  GrayImage small{320, 240, std::vector<std::uint8_t>(320 * 240, 100)};
  folder_.Write("images/005.png", EncodePng(small));
  ExpectRefusal(RunOnIt(), kExitBadInput,
                AllOf(HasSubstr("005.png: is 320 x 240 px"), HasSubstr("is 640 x 480 px")));
}

TEST_F(BoardImages, RefuseATruncatedOne) {
  const std::string bytes = Bytes(images() / "003.png");
  folder_.Write("images/003.png", bytes.substr(0, bytes.size() / 2));
  ExpectRefusal(RunOnIt(), kExitBadInput, HasSubstr("003.png: is not an image, or damaged"));
}

TEST_F(BoardImages, RefuseABoardThatNobodySees) {
  folder_.Write("board.yaml", Replaced(kBoardYaml, "tag36h11", "tag25h9"));
  ExpectRefusal(RunOnIt(), kExitNoResult, HasSubstr("no view shows"));
}

TEST_F(BoardImages, ShowWhichTagsTheBoardsFileShouldHaveNamed) {
  folder_.Write("board.yaml", Replaced(kBoardYaml, "tag36h11", "tag25h9"));
  ExpectRefusal(RunOnIt(), kExitNoResult,
                AllOf(HasSubstr("000.png: the board was not found: no tag of tag25h9 was\n"),
                      HasSubstr("  the images show tags of tag36h11: mend the board's file\n")));
  folder_.Write("board.yaml", std::string(kBoardYaml) + "border_bits: 2\n");
  ExpectRefusal(RunOnIt(), kExitNoResult,
                AllOf(HasSubstr("no tag of tag36h11 with borders of 2 bits was\n"),
                      HasSubstr("  the images show tags of tag36h11: mend the board's file\n")));
}

TEST_F(BoardImages, RefuseAChessboardThatNobodySees) {
  folder_.Write("board.yaml", "board: chessboard\ncolumns: 9\nrows: 6\nsquare_m: 0.02\n");
  ExpectRefusal(RunOnIt(), kExitNoResult, HasSubstr("no view shows"));
}

TEST_F(BoardImages, RefuseANameThatIsNotThere) {
  ExpectRefusal(
      RunLegible({"intrinsics", "nowhere.png", "--board", board().string(), "--out", out().string()}),
      kExitBadInput, HasSubstr("nowhere.png: is not there"));
}

// --- Together with the legs. -----------------------------------------------------------------------------

// Its images need not be of the session's camera for that: the sizes are looked at first.
TEST_F(BoardImages, OfAnotherSizeThanTheSessionsAreRefusedByCalibrate) {
  const std::string session = LEGIBLE_SOURCE_DIR "/datasets/hexapod";
  ExpectRefusal(RunLegible({"calibrate", session, "--with-board", images().string(), "--board",
                            board().string(), "--out", out().string()}),
                kExitBadInput, AllOf(HasSubstr("000.png: is 640 x 480 px"), HasSubstr("1280 x 960")));
}

// --- Corners from a file: a real, very wide lens. --------------------------------------------------------

class WideLens : public testing::Test {
 protected:
  std::vector<std::string> Arguments(const std::string& image_size) const {
    const std::filesystem::path data = std::filesystem::path(LEGIBLE_SOURCE_DIR) / "datasets/wide-lens";
    return {"intrinsics",
            "--corners",
            (data / "corners.csv").string(),
            "--image-size",
            image_size,
            "--board",
            (data / "board.yaml").string(),
            "--out",
            (folder_.path() / "out").string(),
            "--format",
            "json"};
  }
  json RunOnIt(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments = Arguments("6016x4016");
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun run = RunLegible(arguments);
    EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
    return json::parse(run.out);
  }
  TemporaryFolder folder_;
};

// Some lie in the lower half of them.
TEST_F(WideLens, RefusesImagesSmallerThanItsCorners) {
  const ProgramRun run = RunLegible(Arguments("6016x2008"));
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_THAT(
      run.err,
      testing::ContainsRegex(
          "corners.csv: has a corner of view [^ ]* at \\([0-9., ]*\\) px, outside an image of 6016 x 2008"));
  EXPECT_EQ(run.out, "");
}

// mrcal and OpenCV find fx = 2070.484 px and 1.391 px a point, from a guess.
TEST_F(WideLens, LeadsToThePublishedCameraFromNoGuess) {
  const json found = RunOnIt({"--lens", "rational", "--all-corners"});
  EXPECT_NEAR(found["camera"]["fx"], 2070.484, 0.001);
  EXPECT_NEAR(found["rms_px"], 1.391, 0.0005);
  EXPECT_EQ(found["corners_used"], 18600);
}

// mrcal's optimum of the same problem: fx = 2251.179, 27.093 px.
TEST_F(WideLens, IsReportedNotToBeOneOfFiveCoefficients) {
  const json found = RunOnIt({"--lens", "brown-conrady", "--all-corners"});
  EXPECT_NEAR(found["camera"]["fx"], 2251.18, 0.01);
  EXPECT_NEAR(found["rms_px"], 27.0933, 0.001);
  EXPECT_TRUE(found["cross_validation"]["misfit"].get<bool>());
  EXPECT_THAT(found["cross_validation"]["sentence"].get<std::string>(),
              HasSubstr("the lens model does not fit"));
}

TEST_F(WideLens, IsReportedNotToBeOneOfFiveCoefficientsWhereOutliersAreLeftOutToo) {
  const json found = RunOnIt({});
  EXPECT_TRUE(found["cross_validation"]["misfit"].get<bool>());
}

// Of the same optimum mrcal's Jacobian gives a focal length of 2251.18 +- 2.78 px by the residuals: 65 sigmas
// from that of eight coefficients. Its two halves of the views, projected into each other, differ by 5.17
// times what that allows.
TEST_F(WideLens, HandsOnNoMoreOfFiveCoefficientsThanTheirHalvesBearOut) {
  const json found = RunOnIt({"--all-corners"});
  const double sigma_px = found["camera"]["sigma"]["fx"];
  const double factor = found["cross_validation"]["sigma_factor"];
  EXPECT_GT(factor, 3);
  constexpr double kMrcalSigma_px = 2.784;  // of the residuals, as mrcal has it for the same corners and lens
  EXPECT_NEAR(sigma_px, factor * kMrcalSigma_px, 0.01 * sigma_px);
  EXPECT_THAT(
      found["cross_validation"]["sentence"].get<std::string>(),
      HasSubstr(fmt::format("the camera's σ are therefore {:.2g} times what the residuals give", factor)));
  const std::filesystem::path camera_yaml = folder_.path() / "out/camera.yaml";
  EXPECT_NEAR(std::sqrt(ReadCamera(camera_yaml).information.inverse()(0, 0)), sigma_px, 1e-6);
  EXPECT_THAT(Bytes(camera_yaml), testing::StartsWith("# The lens model does not fit"));
}

TEST_F(WideLens, LeavesNoCornerOutUncounted) {
  const json found = RunOnIt({"--lens", "rational"});
  EXPECT_GT(found["corners_left_out"].get<int>(), 0);
  EXPECT_EQ(found["corners_left_out"].get<int>() + found["corners_used"].get<int>() +
                found["corners_not_measured"].get<int>(),
            18600);
  EXPECT_EQ(found["corners_not_measured"], 3);  // marked in the file
  EXPECT_NEAR(found["camera"]["fx"], 2070.484, 3);
}

}  // namespace
}  // namespace legible
