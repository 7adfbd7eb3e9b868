#include "datasets/text.h"

#include "tests/datasets/files.h"

namespace legible {
namespace {

TEST(Text, InputErrorNamesFileLineFaultAndMend) {
  EXPECT_STREQ(InputError("a/b.yaml", 7, "is wrong", "mend it").what(), "a/b.yaml:7: is wrong; mend it");
  EXPECT_STREQ(InputError("a/b.yaml", 0, "is wrong", "mend it").what(), "a/b.yaml: is wrong; mend it");
}

TEST(Text, InputErrorIsOneLineWhateverItQuotes) {
  EXPECT_STREQ(InputError("a.yaml", 1, "is \"x\r\ny\x1b[31m\"", "mend it").what(),
               "a.yaml:1: is \"x  y [31m\"; mend it");
}

TEST(Text, TrimmedTakesWhiteSpaceAndCarriageReturnsOffBothEnds) {
  EXPECT_EQ(Trimmed(" \ta b\t \r"), "a b");
  EXPECT_EQ(Trimmed("\r\n "), "");
  EXPECT_EQ(Trimmed(""), "");
}

TEST(Text, FiniteNumbersTakeUpTheWholeText) {
  EXPECT_EQ(ParseFinite("0.1"), 0.1);
  EXPECT_EQ(ParseFinite("+2e-5"), 2e-5);
  EXPECT_EQ(ParseFinite("-.5"), -0.5);
  for (const char* text :
       {"", "+", "+-1", "1,5", "1 2", "0.1m", "0x10", "nan", "NaN", "inf", "-inf", ".nan", "1e999"}) {
    EXPECT_EQ(ParseFinite(text), std::nullopt) << text;
  }
}

TEST(Text, WholeNumbersHaveNoFractionAndAreDecimal) {
  EXPECT_EQ(ParseInteger("010"), 10);
  EXPECT_EQ(ParseInteger("-3"), -3);
  for (const char* text : {"", "1.0", "1e3", "99999999999", "x"})
    EXPECT_EQ(ParseInteger(text), std::nullopt) << text;
}

TEST(Text, ShortenedIsTheFirstLineUpToSixtyBytesOfWholeCharacters) {
  EXPECT_EQ(Shortened(""), "");
  EXPECT_EQ(Shortened(std::string(60, 'a')), std::string(60, 'a'));
  EXPECT_EQ(Shortened(std::string(61, 'a')), std::string(60, 'a') + "…");
  EXPECT_EQ(Shortened("one\ntwo"), "one…");
  EXPECT_EQ(Shortened(std::string(59, 'a') + "äb"), std::string(59, 'a') + "…");
}

TEST(Text, NearestNameHasTheFewestLettersToChange) {
  const std::vector<std::string> known = {"radius_m", "base_joint_m", "joint_offset_m"};
  EXPECT_EQ(NearestName("raduis_m", known), "radius_m");
  EXPECT_EQ(NearestName("base_joints", known), "base_joint_m");
  EXPECT_EQ(NearestName("joint_offset", known), "joint_offset_m");
}

TEST(Text, FilesLoseTheirByteOrderMark) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadTextFile(folder.Write("bom.txt",
                                      "\xEF\xBB\xBF"
                                      "a\n")),
            "a\n");
}

TEST(Text, UnreadableFilesAreNamed) {
  const TemporaryFolder folder;
  const auto complaint = [](const std::filesystem::path& file) {
    return InputErrorOf([&] { ReadTextFile(file); });
  };
  const std::string mend = "; check the path and that the file may be read";
  const auto missing = folder.path() / "missing.txt";
  EXPECT_EQ(complaint(missing), Complaint(missing, 0, "cannot be read: No such file or directory" + mend));
  EXPECT_EQ(complaint(folder.path()), Complaint(folder.path(), 0, "cannot be read: Is a directory" + mend));
  const auto empty = folder.Write("empty.txt", " \r\n");
  EXPECT_EQ(complaint(empty), Complaint(empty, 0, "is empty; fill it in, or name another file"));
  const auto utf16 = folder.Write("utf16.txt", std::string("a\0b\0", 4));
  EXPECT_EQ(complaint(utf16), Complaint(utf16, 0, "is no text in UTF-8; save it as UTF-8 text"));
}

}  // namespace
}  // namespace legible
