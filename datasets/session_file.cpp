#include "datasets/session_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"
#include "datasets/image_folder.h"
#include "datasets/input_error.h"
#include "datasets/joint_file.h"
#include "datasets/robot_file.h"
#include "datasets/tag_file.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

// What a board has told of the camera is in camera.yaml, and would count twice.
void DemandToldOnce(const YamlValue& section, const PriorKnowledge& known) {
  if (known.camera_information.size() == 0) return;
  for (const char* name : {"focal_length_px", "principal_point_px", "distortion"})
    if (const auto value = section.Find(name))
      value->Fail("is said, and the camera's file has the information of a board",
                  "take it out, or `information` out of that file");
}

void AddKnown(const YamlValue& section, PriorKnowledge& known) {
  if (section.IsNull()) return;
  std::vector<std::string> names;
  names.reserve(std::size(kKnownFields));
  for (const auto& [name, field] : kKnownFields) names.push_back(name);
  section.AllowKeys(names);
  for (const auto& [name, field] : kKnownFields) {
    const auto sigma = section.Find(name);
    if (!sigma) continue;
    known.*field = sigma->PositiveNumber();
    if (known.*field < kLeastKnownSigma)
      sigma->Fail(
          fmt::format("is {}", *(known.*field)),
          fmt::format("give {} or more; what is known exactly is held with --hold", kLeastKnownSigma));
  }
  DemandToldOnce(section, known);
}

std::string KnownToYaml(const PriorKnowledge& known) {
  std::string text;
  for (const auto& [name, field] : kKnownFields) {
    if (known.*field) text += fmt::format("  {}: {}\n", name, NumberText(*(known.*field)));
  }
  const std::string comment = "  # 1-sigma of what is known beforehand; what is not listed is unknown\n";
  return text.empty() ? text : "known:" + comment + text;
}

std::filesystem::path NamedFile(const std::filesystem::path& folder, const YamlValue& value) {
  std::filesystem::path file = folder / value.Text();
  if (!std::filesystem::is_regular_file(file)) {
    value.Fail(fmt::format("names {}, which is no file", file.string()),
               "give a path relative to the session's folder");
  }
  return file;
}

std::filesystem::path NamedFolder(const std::filesystem::path& folder, const YamlValue& value) {
  std::filesystem::path named = folder / value.Text();
  if (!std::filesystem::is_directory(named)) {
    value.Fail(fmt::format("names {}, which is no folder", named.string()),
               "give a path relative to the session's folder");
  }
  return named;
}

// Readings in other units than metres, or of another robot, lie further outside the range than the range is
// wide.
void DemandReadingsNearRange(const std::filesystem::path& file, const JointRow& row,
                             const GoughStewart& robot) {
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest, longest] = robot.legs[i].joint_range_m;
    const double margin = longest - shortest;
    if (row.readings_m[i] >= shortest - margin && row.readings_m[i] <= longest + margin) continue;
    throw InputError(file, row.line,
                     fmt::format("q{}_m is {}, far outside the leg's joint_range_m [{}, {}]", i + 1,
                                 row.readings_m[i], shortest, longest),
                     "give the readings in metres, or mend the robot's joint_range_m");
  }
}

SessionImage ImageOfRow(const std::filesystem::path& joints_file, const JointRow& row,
                        const std::filesystem::path& images_folder) {
  const std::filesystem::path file = images_folder / row.image;
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(joints_file, row.line, fmt::format("image {} is missing", file.string()),
                     "add the file, or take this row out");
  }
  return {row.image, file, row.readings_m};
}

void ReadImages(const std::filesystem::path& joints_file, const std::filesystem::path& images_folder,
                Session& session) {
  const std::vector<JointRow> rows = ReadJoints(joints_file);
  std::set<std::string> unlisted = ImagesIn(images_folder);
  if (unlisted.empty())
    throw InputError(images_folder, 0, "no image in this folder", "add the session's images");
  for (const JointRow& row : rows) {
    DemandReadingsNearRange(joints_file, row, session.robot);
    session.images.push_back(ImageOfRow(joints_file, row, images_folder));
    unlisted.erase(row.image);
  }
  session.unlisted_images.assign(unlisted.begin(), unlisted.end());
}

std::filesystem::path SessionYamlIn(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder, 0, "is no folder", "give the folder that holds the session.yaml");
  }
  std::filesystem::path file = folder / "session.yaml";
  if (!std::filesystem::exists(file)) {
    throw InputError(folder, 0, "holds no session.yaml", "give the folder of a session");
  }
  return file;
}

}  // namespace

Session ReadSession(const std::filesystem::path& folder) {
  const std::filesystem::path session_yaml = SessionYamlIn(folder);
  const YamlValue root = YamlValue::LoadFile(session_yaml);
  root.AllowKeys({"robot", "camera", "joints", "images", "tags", "known"});
  const std::filesystem::path robot = NamedFile(folder, root.Get("robot"));
  const std::filesystem::path camera = NamedFile(folder, root.Get("camera"));
  const std::filesystem::path joints = NamedFile(folder, root.Get("joints"));
  const std::filesystem::path images = NamedFolder(folder, root.Get("images"));

  Session session;
  session.folder = folder;
  session.files = {session_yaml, robot, camera, joints};
  session.robot = ReadRobot(robot);
  CameraFile camera_file = ReadCamera(camera);
  session.camera = camera_file.camera;
  session.camera_from_base = camera_file.camera_from_base;
  session.known.camera_information = camera_file.information;
  session.warnings = camera_file.warnings;
  if (const auto tags = root.Find("tags")) {
    session.files.push_back(NamedFile(folder, *tags));
    session.tags = ReadTags(session.files.back());
  }
  if (const auto known = root.Find("known")) AddKnown(*known, session.known);
  ReadImages(joints, images, session);
  return session;
}

void WriteSession(const std::filesystem::path& folder, const Session& session) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder, 0, "cannot be created: " + error.message(), "name another folder");
  WriteRobot(folder / "robot.yaml", session.robot);
  WriteFileAtomically(folder / "camera.yaml", CameraInfoText({session.camera, session.camera_from_base,
                                                              session.known.camera_information}));
  std::vector<JointRow> rows;
  for (const SessionImage& image : session.images) rows.push_back({image.name, image.joint_readings_m});
  WriteJoints(folder / "joints.csv", rows);
  std::string text = "robot: robot.yaml\ncamera: camera.yaml\njoints: joints.csv\nimages: images\n";
  if (session.tags) {
    WriteTags(folder / "tags.yaml", *session.tags);
    text += "tags: tags.yaml\n";
  }
  // Last, so that a session half written is not taken for one.
  WriteFileAtomically(folder / "session.yaml", text + KnownToYaml(session.known));
}

}  // namespace legible
