// A session and images of a calibration board by the same camera: solved together, and one after the other.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/vision/gray_image.h"
#include "datasets/image_folder.h"
#include "datasets/model_file.h"
#include "datasets/session_file.h"
#include "tests/apps/program_fixture.h"
#include "tests/testing/board_of_camera.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

constexpr char kBoardYaml[] =
    "board: tags\nfamily: tag36h11\ncolumns: 6\nrows: 6\ntag_size_m: 0.03\nspacing_m: 0.009\n";
constexpr int kViews = 12;

// The shipped session, and beside it images of a board through its true camera.
class BoardAndSession : public HexapodSession {
 protected:
  BoardAndSession() {
    folder_.Write("board/board.yaml", kBoardYaml);
    for (int i = 0; i < kViews; ++i)
      folder_.Write(fmt::format("board/images/{:03}.png", i), Pngs().at(static_cast<size_t>(i)));
  }

  static const Camera& TrueCamera() {
    static const Camera camera = ReadRenderedTruth(LEGIBLE_SOURCE_DIR "/datasets/hexapod/truth.json").camera;
    return camera;
  }

  std::filesystem::path board() const { return folder_.path() / "board/board.yaml"; }
  std::filesystem::path views() const { return folder_.path() / "board/images"; }

  // Of the board first, then of its images.
  std::vector<std::filesystem::path> BoardFiles() const {
    std::vector<std::filesystem::path> files = {board()};
    for (const std::string& name : ImagesIn(views())) files.push_back(views() / name);
    return files;
  }

  ProgramRun Together(std::vector<std::string> options) const {
    options.insert(options.begin(), {"--with-board", views().string(), "--board", board().string(), "--folds",
                                     "0", "--no-pictures"});
    return RunOnIt(options);
  }

  json Found() const { return json::parse(Bytes(out() / "calibration.json")); }

 private:
  // Rendered once for all tests.
  static const std::vector<std::string>& Pngs() {
    static const std::vector<std::string> pngs = [] {
      std::vector<std::string> list;
      for (const GrayImage& image : RenderViewsOfBoard(TrueCamera(), kViews))
        list.push_back(EncodePng(image));
      return list;
    }();
    return pngs;
  }
};

TEST_F(BoardAndSession, SolvedTogetherLeadToTheTrueCameraAndAModelThatNamesBoth) {
  const ProgramRun run = Together({});
  ASSERT_EQ(run.exit_code, kExitSuccess) << run.err;
  const json found = Found();
  EXPECT_EQ(found["status"], "converged");
  EXPECT_EQ(found["board"]["views_used"], kViews);
  const json& camera = found["camera"];
  const std::vector<std::pair<const char*, double>> truth = {{"fx", TrueCamera().fx_px},
                                                             {"fy", TrueCamera().fy_px},
                                                             {"cx", TrueCamera().cx_px},
                                                             {"cy", TrueCamera().cy_px}};
  for (const auto& [name, value] : truth) {
    const double sigma_px = camera["sigma"][name];
    EXPECT_LT(sigma_px, 0.5) << name;
    EXPECT_NEAR(camera[name], value, 4 * sigma_px) << name;
  }
  const CalibratedModel model = ReadModel(out() / "model.yaml");
  EXPECT_EQ(model.provenance.at("content_hash"), ContentHash(ReadSession(session()), BoardFiles()));
  EXPECT_EQ(model.provenance.at("options"),
            fmt::format("--with-board {} --board {} --folds 0", views().string(), board().string()));
  EXPECT_THAT(Bytes(out() / "report.html"), HasSubstr("solved together"));
}

TEST_F(BoardAndSession, TakeTheOptionsOfTheBoardAsIntrinsicsDoes) {
  const ProgramRun run = Together({"--board-warp", "--all-corners"});
  ASSERT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_THAT(Found()["options"].get<std::string>(), HasSubstr("--board-warp --all-corners"));
}

TEST_F(BoardAndSession, SayWhichLensToTakeWhereTheBoardsCoefficientsAreNotToldApart) {
  const std::filesystem::path camera = folder_.path() / "camera";
  const ProgramRun intrinsics = RunLegible({"intrinsics", views().string(), "--board", board().string(),
                                            "--lens", "rational", "--out", camera.string(), "--no-pictures"});
  ASSERT_EQ(intrinsics.exit_code, kExitSuccess) << intrinsics.err;
  EXPECT_THAT(intrinsics.err, HasSubstr("the coefficients of the rational lens are not told apart"));
  std::filesystem::copy(camera / "camera.yaml", session() / "camera.yaml",
                        std::filesystem::copy_options::overwrite_existing);
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.err, AllOf(HasSubstr("combination of camera.k"),
                             HasSubstr("calibrate the camera with a lens model of fewer")));
}

}  // namespace
}  // namespace legible
