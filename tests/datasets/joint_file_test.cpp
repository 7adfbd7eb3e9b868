#include "datasets/joint_file.h"

#include <fmt/format.h>

#include <limits>

#include "tests/datasets/files.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr char kMend[] = "; the columns are image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m";

std::string ReadComplaint(const TemporaryFolder& folder, const std::string& text) {
  return InputErrorOf([&] { ReadJoints(folder.Write("joints.csv", text)); });
}

TEST(JointFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  std::mt19937_64 generator = TestGenerator();
  std::vector<JointRow> rows(30);
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].image = std::to_string(i) + ".png";
    rows[i].readings_m << UniformVector(generator, 0, 1), UniformVector(generator, -1e-7, 1e-7);
  }
  WriteJoints(folder.path() / "joints.csv", rows);
  const std::vector<JointRow> again = ReadJoints(folder.path() / "joints.csv");
  ASSERT_EQ(again.size(), rows.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(again[i].image, rows[i].image);
    EXPECT_EQ(again[i].readings_m, rows[i].readings_m);
    EXPECT_EQ(again[i].line, static_cast<int>(i) + 2);
  }
}

TEST(JointFile, ToleratesWhatSpreadsheetsAndPeopleAdd) {
  const TemporaryFolder folder;
  const std::vector<JointRow> rows = ReadJoints(folder.Write("joints.csv",
                                                             "\xEF\xBB\xBF# by hand\r\n"
                                                             "\r\n"
                                                             " q6_m , image,q1_m,q2_m,q3_m,q4_m,q5_m\t\r\n"
                                                             "0.6, a b.png ,0.1,+0.2,3e-1,0.4,0.5  \r\n"
                                                             "  # a comment, with commas\r\n"
                                                             "   \r\n"
                                                             "1.6,c.png,1.1,1.2,1.3,1.4,1.5"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].image, "a b.png");
  EXPECT_EQ(rows[0].line, 4);
  EXPECT_EQ(rows[0].readings_m, (Vector6d() << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished());
  EXPECT_EQ(rows[1].image, "c.png");
  EXPECT_EQ(rows[1].line, 7);
}

TEST(JointFile, ColumnsAreNamedWhereOneIsMissingRepeatedOrUnknown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "joints.csv";
  EXPECT_EQ(ReadComplaint(folder, "\nimage,q1_m,q2_m,q4_m,q5_m,q6_m\n"),
            Complaint(file, 2, "column q3_m is missing" + std::string(kMend)));
  EXPECT_EQ(ReadComplaint(folder, "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m,q7_m\n"),
            Complaint(file, 1, "unknown column \"q7_m\" (the nearest known is q1_m)" + std::string(kMend)));
  EXPECT_EQ(ReadComplaint(folder, "image,q1_m,q2_m,q3_m,q4_m,q5_m,q5_m\n"),
            Complaint(file, 1, "column q5_m is there twice" + std::string(kMend)));
  EXPECT_EQ(ReadComplaint(folder, "# only this\n"),
            Complaint(file, 1, "column image is missing" + std::string(kMend)));
}

TEST(JointFile, RowsAreCompleteAndFinite) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "joints.csv";
  const std::string header = "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m\na.png,1,2,3,4,5,6\n";
  EXPECT_EQ(ReadComplaint(folder, header + "b.png,1,2,3,4,5\n"),
            Complaint(file, 3, "6 fields in this row, 7 columns; give one field for each column"));
  EXPECT_EQ(ReadComplaint(folder, header + "b.png,1,2,3,4,5,6,7\n"),
            Complaint(file, 3, "8 fields in this row, 7 columns; give one field for each column"));
  for (const std::string field : {"nan", "inf", "", "x", "0.3 m"}) {
    EXPECT_EQ(
        ReadComplaint(folder, header + fmt::format("b.png,1,2,3,4,{},6\n", field)),
        Complaint(file, 3,
                  fmt::format("q5_m is \"{}\", not a finite number; give the reading in metres, or take "
                              "this row out",
                              field)));
  }
}

TEST(JointFile, ImagesAreFilesNamedOnce) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "joints.csv";
  const std::string header = "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m\na.png,1,2,3,4,5,6\n";
  EXPECT_EQ(ReadComplaint(folder, header + "\na.png,1,2,3,4,5,6\n"),
            Complaint(file, 4, "image \"a.png\" is there already, in line 2; keep one row for each image"));
  EXPECT_EQ(ReadComplaint(folder, header + " ,1,2,3,4,5,6\n"),
            Complaint(file, 3, "image is empty; name the image's file"));
  for (const std::string name : {"../a.png", "/a.png", "left/a.png", ".."}) {
    EXPECT_EQ(
        ReadComplaint(folder, header + name + ",1,2,3,4,5,6\n"),
        Complaint(file, 3,
                  "image \"" + name + "\" is no plain file name; name a file of the session's image folder"));
  }
}

TEST(JointFile, AFileWithoutRowsHasNoImage) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadComplaint(folder, "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m\n"),
            Complaint(folder.path() / "joints.csv", 0,
                      "no image: there is no row below the header; add one for each image"));
  EXPECT_EQ(ReadComplaint(folder, "\n"),
            Complaint(folder.path() / "joints.csv", 0, "is empty; fill it in, or name another file"));
}

TEST(JointFile, ReadingsThatAreNotFiniteAreNotWritten) {
  const TemporaryFolder folder;
  JointRow row{"a.png", Vector6d::Constant(std::numeric_limits<double>::infinity())};
  EXPECT_THROW(WriteJoints(folder.path() / "joints.csv", {row}), std::invalid_argument);
  EXPECT_THAT(folder.Names(), testing::IsEmpty());
}

}  // namespace
}  // namespace legible
