#include "datasets/pose_file.h"

#include <gmock/gmock.h>

#include "tests/datasets/files.h"

namespace legible {
namespace {

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& text) {
  return InputErrorOf([&] { ReadPoses(folder.Write("poses.csv", text)); });
}

TEST(PoseFile, ReadsNamesAndColumnsInAnyOrder) {
  const TemporaryFolder folder;
  const auto poses =
      ReadPoses(folder.Write("poses.csv", "# a comment\nrz,ry,rx,z,y,x,name\n6,5,4,3,2,1,there\n"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].name, "there");
  EXPECT_EQ(poses[0].line, 3);
  EXPECT_EQ(poses[0].coordinates, (Vector6d() << 1, 2, 3, 4, 5, 6).finished());
}

TEST(PoseFile, NeedsNoHeaderNoNamesAndTakesUnitsInTheColumnsNames) {
  const TemporaryFolder folder;
  const auto bare = ReadPoses(folder.Write("bare.csv", "1,2,3,4,5,6\n0,0,0,0,0,0\n"));
  ASSERT_EQ(bare.size(), 2u);
  EXPECT_EQ(bare[0].name, "1");
  EXPECT_EQ(bare[0].line, 1);
  EXPECT_EQ(bare[1].name, "2");
  const auto with_units =
      ReadPoses(folder.Write("units.csv", "x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n1,2,3,4,5,6\n"));
  EXPECT_EQ(with_units[0].coordinates, bare[0].coordinates);
}

TEST(PoseFile, ComplaintsNameLineAndMend) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "poses.csv";
  EXPECT_EQ(ReadComplaint(folder, "x,y,z,rx,ry,rz\n"),
            Complaint(file, 0, "no pose: there is no row below the header; add one for each pose"));
  EXPECT_EQ(ReadComplaint(folder, "x,y,z,rx,ry\n1,2,3,4,5\n"),
            Complaint(file, 1, "column rz is missing; the columns are x,y,z,rx,ry,rz and, if wished, name"));
  EXPECT_EQ(ReadComplaint(folder, "x,y,z,rx,ry,rz\n1,2,3,4,5,6\n1,2,three,4,5,6\n"),
            Complaint(file, 3,
                      "z is \"three\", not a finite number; give metres and radians, or take this row out"));
  EXPECT_EQ(ReadComplaint(folder, "x,y,z,rx,ry,rz\n1,2,3,4,5,inf\n"),
            Complaint(file, 2,
                      "rz is \"inf\", not a finite number; give metres and radians, or take this row out"));
  EXPECT_EQ(ReadComplaint(folder, "x,y,z,rx,ry,rz,name\n1,2,3,4,5,6,a\n1,2,3,4,5,6,a\n"),
            Complaint(file, 3, "pose \"a\" is there already, in line 2; give each pose a name of its own"));
  EXPECT_EQ(ReadComplaint(folder, "1,2,3,4,5,6\n1,2,3\n"),
            Complaint(file, 2, "3 fields in this row, 6 columns; give one field for each column"));
}

}  // namespace
}  // namespace legible
