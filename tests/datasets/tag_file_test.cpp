#include "datasets/tag_file.h"

#include "tests/datasets/equality.h"
#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr char kTags[] = R"(family: tag36h11
groups:
  - name: board
    on: base
    base_from_group: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0.3, 0, 0]}
    known: {translation_m: 0.002, rotation_rad: 0.0175}
    tags:
      - {id: 0, corners_m: [[-0.09, -0.02, 0], [-0.05, -0.02, 0], [-0.05, 0.02, 0], [-0.09, 0.02, 0]]}
      - {id: 1, corners_m: [[0.01, -0.02, 0], [0.05, -0.02, 0], [0.05, 0.02, 0], [0.01, 0.02, 0]]}
  - name: lid
    on: platform
    platform_from_group: {rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0.01]}
    known: {translation_m: 0.003, rotation_rad: 0.02}
    tags:
      - {id: 7, corners_m: [[-0.02, -0.02, 0], [0.02, -0.02, 0], [0.02, 0.02, 0], [-0.02, 0.02, 0]]}
)";

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& old_part,
                          const std::string& new_part) {
  const auto file = folder.Write("tags.yaml", Replaced(kTags, old_part, new_part));
  return InputErrorOf([&] { ReadTags(file); });
}

TEST(TagFile, ReadsGroupsOfBothCarriers) {
  const TemporaryFolder folder;
  const TagLayout layout = ReadTags(folder.Write("tags.yaml", kTags));
  EXPECT_EQ(layout.family, "tag36h11");
  ASSERT_EQ(layout.groups.size(), 2u);
  EXPECT_EQ(layout.groups[0].name, "board");
  EXPECT_EQ(layout.groups[0].carrier, TagCarrier::kBase);
  EXPECT_EQ(layout.groups[0].carrier_from_group.translation, Eigen::Vector3d(0.3, 0, 0));
  EXPECT_EQ(layout.groups[0].translation_sigma_m, 0.002);
  EXPECT_EQ(layout.groups[0].rotation_sigma_rad, 0.0175);
  ASSERT_EQ(layout.groups[0].tags.size(), 2u);
  EXPECT_EQ(layout.groups[0].tags[1].id, 1);
  EXPECT_EQ(layout.groups[0].tags[1].corners_m[2], Eigen::Vector3d(0.05, 0.02, 0));
  EXPECT_EQ(layout.groups[1].carrier, TagCarrier::kPlatform);
}

TEST(TagFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  TagLayout layout = ReadTags(folder.Write("tags.yaml", kTags));
  for (TagGroup& group : layout.groups) {
    group.carrier_from_group = {UniformRotation(generator), UniformVector(generator, -1, 1)};
    for (Tag& tag : group.tags) {
      for (Eigen::Vector3d& corner : tag.corners_m) corner += UniformVector(generator, -1e-3, 1e-3);
    }
  }
  WriteTags(folder.path() / "again.yaml", layout);
  const TagLayout again = ReadTags(folder.path() / "again.yaml");
  EXPECT_EQ(again.family, layout.family);
  ASSERT_EQ(again.groups.size(), layout.groups.size());
  for (size_t i = 0; i < layout.groups.size(); ++i) {
    const TagGroup &found = again.groups[i], &expected = layout.groups[i];
    EXPECT_EQ(found.name, expected.name);
    EXPECT_EQ(found.carrier, expected.carrier);
    ExpectSame(found.carrier_from_group, expected.carrier_from_group);
    EXPECT_EQ(found.translation_sigma_m, expected.translation_sigma_m);
    EXPECT_EQ(found.rotation_sigma_rad, expected.rotation_sigma_rad);
    ASSERT_EQ(found.tags.size(), expected.tags.size());
    for (size_t j = 0; j < expected.tags.size(); ++j) {
      EXPECT_EQ(found.tags[j].id, expected.tags[j].id);
      EXPECT_EQ(found.tags[j].corners_m, expected.tags[j].corners_m);
    }
  }
}

TEST(TagFile, ContradictionsAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "tags.yaml";
  EXPECT_EQ(
      ReadComplaint(folder, "tag36h11", "36h11"),
      Complaint(file, 1,
                "family is \"36h11\", which libapriltag does not have; the nearest that it has is tag36h11"));
  EXPECT_EQ(ReadComplaint(folder, "id: 7", "id: 1"),
            Complaint(file, 15, "groups[2].tags[1] has the id 1, which is there already; keep one"));
  EXPECT_EQ(ReadComplaint(folder, "name: lid", "name: board"),
            Complaint(file, 10, "groups[2] has the name \"board\", which is there already; keep one"));
  EXPECT_EQ(ReadComplaint(folder, "on: platform", "on: lid"),
            Complaint(file, 11, "groups[2].on is \"lid\"; give base or platform"));
  EXPECT_EQ(ReadComplaint(folder, "on: platform", "on: base"),
            Complaint(file, 12,
                      "groups[2] has the unknown key \"platform_from_group\"; "
                      "the nearest known key is \"base_from_group\": rename it or take it out"));
}

TEST(TagFile, ImpossibleTagsAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "tags.yaml";
  EXPECT_EQ(ReadComplaint(folder, "id: 7", "id: -7"),
            Complaint(file, 15, "groups[2].tags[1] has the id -7; tag36h11 has the ids 0 to 586"));
  EXPECT_EQ(ReadComplaint(folder, "id: 7", "id: 587"),
            Complaint(file, 15, "groups[2].tags[1] has the id 587; tag36h11 has the ids 0 to 586"));
  for (const char* corners : {"[0, 0, 0], [0.02, 0, 0], [0.03, 0, 0], [0.01, 0, 0]",
                              "[0, 0, 0], [0, 0, 0], [0.02, 0.02, 0], [0, 0.02, 0]"})
    EXPECT_EQ(ReadComplaint(folder, "[-0.02, -0.02, 0], [0.02, -0.02, 0], [0.02, 0.02, 0], [-0.02, 0.02, 0]",
                            corners),
              Complaint(file, 15,
                        "groups[2].tags[1].corners_m are not those of a square; "
                        "give bottom-left, bottom-right, top-right, top-left of the black border"));
  EXPECT_EQ(ReadComplaint(folder, ", [0.02, -0.02, 0], [0.02, 0.02, 0]", ", [0.02, 0.02, 0]"),
            Complaint(file, 15, "groups[2].tags[1].corners_m has 3 values; give 4"));
  EXPECT_EQ(ReadComplaint(folder, "translation_m: 0.003", "translation_m: 0"),
            Complaint(file, 13, "groups[2].known.translation_m is 0; give a number greater than 0"));
}

}  // namespace
}  // namespace legible
