// Files damaged at random: a reader takes them or says what is wrong, and does nothing else.
#include <functional>

#include "datasets/model_file.h"
#include "datasets/parallel_robot_file.h"
#include "datasets/session_file.h"
#include "datasets/tag_file.h"
#include "tests/datasets/session_fixture.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kDamages = 600;

// A stretch of up to 12 bytes is taken out, doubled, or overwritten by bytes that YAML and CSV give a
// meaning.
std::string Damaged(const std::string& text, std::mt19937_64& generator) {
  const std::string bytes("\n\t #:,-[]{}\"'&*!|>%@`?.0eEnN\\\0\xff", 31);
  const auto below = [&](size_t limit) { return generator() % limit; };
  const size_t place = below(text.size());
  const size_t size = std::min<size_t>(1 + below(12), text.size() - place);
  std::string piece = text.substr(place, size);
  const size_t kind = below(3);
  if (kind == 0) piece.clear();
  if (kind == 1) piece += piece;
  if (kind == 2) piece = std::string(1 + below(2), bytes[below(bytes.size())]);
  return text.substr(0, place) + piece + text.substr(place + size);
}

void ExpectReadingOrInputError(const TemporaryFolder& folder, const std::string& name,
                               const std::function<void()>& read) {
  std::mt19937_64 generator = TestGenerator();
  const std::string text = Bytes(folder.path() / name);
  ASSERT_FALSE(text.empty());
  int refused = 0;
  for (int i = 0; i < kDamages; ++i) {
    const std::string damaged = Damaged(text, generator);
    folder.Write(name, damaged);
    try {
      read();
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "not one line: " << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\nfor\n" << damaged;
    }
  }
  EXPECT_GT(refused, kDamages / 4);
  folder.Write(name, text);
  EXPECT_NO_THROW(read());
}

using Damage = SessionOnDisk;

TEST_F(Damage, OfASessionIsTakenOrNamed) {
  const auto& path = folder_.path();
  ExpectReadingOrInputError(folder_, "session.yaml", [&] { ReadSession(path); });
  ExpectReadingOrInputError(folder_, "robot.yaml", [&] { ReadRobot(path / "robot.yaml"); });
  ExpectReadingOrInputError(folder_, "camera.yaml", [&] { ReadCamera(path / "camera.yaml"); });
  ExpectReadingOrInputError(folder_, "joints.csv", [&] { ReadJoints(path / "joints.csv"); });
}

TEST_F(Damage, OfTagsIsTakenOrNamed) {
  TagGroup group;
  group.name = "board";
  group.translation_sigma_m = group.rotation_sigma_rad = 0.01;
  group.tags = {{3, {Eigen::Vector3d(0, 0, 0), {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}}};
  WriteTags(folder_.path() / "tags.yaml", {"tag36h11", {group}});
  ExpectReadingOrInputError(folder_, "tags.yaml", [&] { ReadTags(folder_.path() / "tags.yaml"); });
}

TEST_F(Damage, OfAModelIsTakenOrNamed) {
  CalibratedModel model;
  model.robot = DesktopHexapod();
  model.camera = DesktopCamera(true);
  model.camera_from_base = model.robot.home;
  model.parameter_names = {"a", "b", "c"};
  model.covariance = Eigen::Matrix3d::Identity();
  model.provenance = {{"session", "x"}};
  WriteModel(folder_.path() / "model.yaml", model);
  ExpectReadingOrInputError(folder_, "model.yaml", [&] { ReadModel(folder_.path() / "model.yaml"); });
}

TEST_F(Damage, OfAParallelRobotIsTakenOrNamed) {
  const auto file = folder_.Write("delta.yaml", Bytes(LEGIBLE_SOURCE_DIR "/datasets/robots/delta.yaml"));
  ExpectReadingOrInputError(folder_, "delta.yaml", [&] { ReadParallelRobot(file); });
}

}  // namespace
}  // namespace legible
