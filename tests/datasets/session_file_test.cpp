#include "datasets/session_file.h"

#include "tests/datasets/equality.h"
#include "tests/datasets/session_fixture.h"

namespace legible {
namespace {

using testing::ElementsAre;

class SessionFile : public SessionOnDisk {
 protected:
  std::string ReadComplaint() const {
    return InputErrorOf([this] { ReadSession(folder_.path()); });
  }
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
};

TEST_F(SessionFile, ReadsWhatItsFilesSay) {
  const Session session = ReadSession(folder_.path());
  EXPECT_EQ(session.folder, folder_.path());
  ExpectSame(session.robot, DesktopHexapod());
  ExpectSame(session.camera, DesktopCamera(false));
  EXPECT_FALSE(session.camera_from_base.has_value());
  EXPECT_FALSE(session.tags.has_value());
  ASSERT_EQ(session.images.size(), 2u);
  EXPECT_EQ(session.images[0].name, "b.png");
  EXPECT_EQ(session.images[0].file, Path("images/b.png"));
  EXPECT_EQ(session.images[1].joint_readings_m,
            (Vector6d() << 0.41, 0.42, 0.43, 0.44, 0.45, 0.46).finished());
  EXPECT_EQ(session.known.joint_reading_m, 2.0e-5);
  EXPECT_EQ(session.known.radius_m, std::nullopt);
  EXPECT_THAT(session.files,
              ElementsAre(Path("session.yaml"), Path("robot.yaml"), Path("camera.yaml"), Path("joints.csv")));
}

TEST_F(SessionFile, ImagesThatAreNotListedAreNamedAndOtherFilesPassedOver) {
  folder_.Write("images/d.png", "");
  folder_.Write("images/c.JPG", "");
  folder_.Write("images/notes.txt", "");
  const Session session = ReadSession(folder_.path());
  EXPECT_EQ(session.images.size(), 2u);
  EXPECT_THAT(session.unlisted_images, ElementsAre("c.JPG", "d.png"));
}

TEST_F(SessionFile, RoundTripIsExact) {
  Session session = ReadSession(folder_.path());
  session.camera_from_base = Rigid3{Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4).normalized(), {0.1, 0.2, 0.3}};
  session.known.distortion = 0.1;
  session.known.principal_point_px = 1.0 / 3;
  TagGroup group;
  group.name = "lid";
  group.carrier = TagCarrier::kPlatform;
  group.translation_sigma_m = 0.002;
  group.rotation_sigma_rad = 0.01;
  group.tags = {{3, {Eigen::Vector3d(0, 0, 0), {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}}};
  session.tags = TagLayout{"tag36h11", {group}};

  const auto copy = folder_.path() / "new" / "copy";
  WriteSession(copy, session);
  std::filesystem::copy(Path("images"), copy / "images");
  const Session again = ReadSession(copy);
  ExpectSame(again.robot, session.robot);
  ExpectSame(again.camera, session.camera);
  ASSERT_TRUE(again.camera_from_base.has_value());
  ExpectSame(*again.camera_from_base, *session.camera_from_base);
  ASSERT_EQ(again.images.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.images[i].name, session.images[i].name);
    EXPECT_EQ(again.images[i].joint_readings_m, session.images[i].joint_readings_m);
  }
  ASSERT_TRUE(again.tags.has_value());
  EXPECT_EQ(again.tags->groups[0].tags[0].corners_m, group.tags[0].corners_m);
  EXPECT_EQ(again.known.joint_reading_m, 2.0e-5);
  EXPECT_EQ(again.known.distortion, 0.1);
  EXPECT_EQ(again.known.principal_point_px, 1.0 / 3);
  EXPECT_EQ(again.known.focal_length_px, std::nullopt);
}

TEST_F(SessionFile, WritesNoKnownSectionWhereNothingIsKnown) {
  Session session = ReadSession(folder_.path());
  session.known = {};
  WriteSession(folder_.path(), session);
  EXPECT_THAT(Bytes(Path("session.yaml")), testing::Not(testing::HasSubstr("known")));
  EXPECT_EQ(ReadSession(folder_.path()).known.joint_reading_m, std::nullopt);
}

TEST_F(SessionFile, EveryPieceOfPriorKnowledgeHasItsKey) {
  folder_.Write("session.yaml", Replaced(kSessionYaml, "  joint_reading_m: 2.0e-5\n",
                                         "  joint_reading_m: 1\n  radius_m: 2\n  joint_offset_m: 3\n"
                                         "  base_joint_m: 4\n  platform_joint_m: 5\n  focal_length_px: 6\n"
                                         "  principal_point_px: 7\n  distortion: 8\n"));
  const PriorKnowledge known = ReadSession(folder_.path()).known;
  EXPECT_EQ(known.joint_reading_m, 1);
  EXPECT_EQ(known.radius_m, 2);
  EXPECT_EQ(known.joint_offset_m, 3);
  EXPECT_EQ(known.base_joint_m, 4);
  EXPECT_EQ(known.platform_joint_m, 5);
  EXPECT_EQ(known.focal_length_px, 6);
  EXPECT_EQ(known.principal_point_px, 7);
  EXPECT_EQ(known.distortion, 8);
}

TEST_F(SessionFile, KnowsOfTheCameraWhatABoardToldAndRefusesItTwice) {
  Session session = ReadSession(folder_.path());
  session.known.focal_length_px.reset();
  session.known.camera_information = Eigen::MatrixXd::Identity(9, 9);
  WriteSession(folder_.path(), session);
  EXPECT_EQ(ReadSession(folder_.path()).known.camera_information, session.known.camera_information);
  session.known.focal_length_px = 2;
  WriteSession(folder_.path(), session);
  EXPECT_THAT(
      InputErrorOf([&] { ReadSession(folder_.path()); }),
      testing::AllOf(testing::HasSubstr("known.focal_length_px is said"), testing::HasSubstr("of a board")));
}

TEST_F(SessionFile, NothingMayBeKnown) {
  folder_.Write("session.yaml",
                Replaced(kSessionYaml, "  joint_reading_m: 2.0e-5\n", "  # joint_reading_m: 2.0e-5\n"));
  EXPECT_EQ(ReadSession(folder_.path()).known.joint_reading_m, std::nullopt);
}

TEST_F(SessionFile, PriorKnowledgeIsPositiveAndOfAKnownName) {
  folder_.Write("session.yaml", Replaced(kSessionYaml, "2.0e-5", "0"));
  EXPECT_EQ(ReadComplaint(),
            Complaint(Path("session.yaml"), 6, "known.joint_reading_m is 0; give a number greater than 0"));
  folder_.Write("session.yaml", Replaced(kSessionYaml, "joint_reading_m", "joint_readings_m"));
  EXPECT_EQ(ReadComplaint(),
            Complaint(Path("session.yaml"), 6,
                      "known has the unknown key \"joint_readings_m\"; "
                      "the nearest known key is \"joint_reading_m\": rename it or take it out"));
}

TEST_F(SessionFile, UnknownKeysAreRefused) {
  folder_.Write("session.yaml", std::string(kSessionYaml) + "tag: tags.yaml\n");
  EXPECT_EQ(ReadComplaint(), Complaint(Path("session.yaml"), 7,
                                       "the file has the unknown key \"tag\"; "
                                       "the nearest known key is \"tags\": rename it or take it out"));
}

TEST_F(SessionFile, FilesThatAreNotThereAreNamed) {
  const std::string mend = "; give a path relative to the session's folder";
  folder_.Write("session.yaml", std::string(kSessionYaml) + "tags: tags.yaml\n");
  EXPECT_EQ(ReadComplaint(),
            Complaint(Path("session.yaml"), 7,
                      "tags names " + Path("tags.yaml").string() + ", which is no file" + mend));
  folder_.Write("session.yaml", Replaced(kSessionYaml, "images: images", "images: pictures"));
  EXPECT_EQ(ReadComplaint(),
            Complaint(Path("session.yaml"), 4,
                      "images names " + Path("pictures").string() + ", which is no folder" + mend));
}

TEST_F(SessionFile, AnImageThatIsListedButNotThereIsNamedWithItsRow) {
  std::filesystem::remove(Path("images/a.png"));
  EXPECT_EQ(ReadComplaint(), Complaint(Path("joints.csv"), 3,
                                       "image " + Path("images/a.png").string() +
                                           " is missing; add the file, or take this row out"));
}

TEST_F(SessionFile, ASessionNeedsAnImage) {
  std::filesystem::remove(Path("images/a.png"));
  std::filesystem::remove(Path("images/b.png"));
  EXPECT_EQ(ReadComplaint(),
            Complaint(Path("images"), 0, "no image in this folder; add the session's images"));
  folder_.Write("joints.csv", "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m\n");
  EXPECT_EQ(ReadComplaint(), Complaint(Path("joints.csv"), 0,
                                       "no image: there is no row below the header; add one for each image"));
}

TEST_F(SessionFile, ReadingsInMillimetresAreRefused) {
  folder_.Write("joints.csv",
                Replaced(kJointsCsv, "0.41,0.42,0.43,0.44,0.45,0.46", "0.41,0.42,430,0.44,0.45,0.46"));
  EXPECT_EQ(ReadComplaint(), Complaint(Path("joints.csv"), 3,
                                       "q3_m is 430, far outside the leg's joint_range_m [0.345, 0.485]; "
                                       "give the readings in metres, or mend the robot's joint_range_m"));
}

TEST_F(SessionFile, ReadingsALittleOutOfRangeAreTaken) {
  folder_.Write("joints.csv",
                Replaced(kJointsCsv, "0.41,0.42,0.43,0.44,0.45,0.46", "0.341,0.42,0.43,0.44,0.45,0.487"));
  EXPECT_EQ(ReadSession(folder_.path()).images[1].joint_readings_m[0], 0.341);
}

TEST_F(SessionFile, ErrorsInTheFilesItNamesPassThrough) {
  folder_.Write("camera.yaml",
                Replaced(Bytes(Path("camera.yaml")), "image_width: 1280", "image_width: 1280px"));
  EXPECT_EQ(ReadComplaint(), Complaint(Path("camera.yaml"), 2,
                                       "image_width is \"1280px\", not a whole number; give a whole number"));
}

TEST_F(SessionFile, AFolderWithoutSessionIsRefused) {
  const auto images = Path("images");
  EXPECT_EQ(InputErrorOf([&] { ReadSession(images); }),
            Complaint(images, 0, "holds no session.yaml; give the folder of a session"));
  const auto missing = Path("missing");
  EXPECT_EQ(InputErrorOf([&] { ReadSession(missing); }),
            Complaint(missing, 0, "is no folder; give the folder that holds the session.yaml"));
}

TEST_F(SessionFile, IsNotWrittenWhereAFileIsInTheWay) {
  const Session session = ReadSession(folder_.path());
  const auto file = Path("robot.yaml");
  EXPECT_THAT(InputErrorOf([&] { WriteSession(file / "copy", session); }),
              testing::StartsWith(Complaint(file / "copy", 0, "cannot be created: ")));
}

TEST_F(SessionFile, WritesNothingThatIsNotFinite) {
  Session session = ReadSession(folder_.path());
  session.robot.legs[0].joint_offset_m = std::nan("");
  EXPECT_THROW(WriteSession(Path("copy"), session), std::invalid_argument);
  EXPECT_THAT(std::filesystem::exists(Path("copy/session.yaml")), false);
}

}  // namespace
}  // namespace legible
