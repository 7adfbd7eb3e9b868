#include "apps/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace legible {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string kDataOpening = R"(<script type="application/json" id="data">)";

// The text that a browser takes for the data: up to the first end of a script element.
std::string EmbeddedData(const std::string& page) {
  const size_t start = page.find(kDataOpening) + kDataOpening.size();
  return page.substr(start, page.find("</script", start) - start);
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

json CalibratedData() {
  return {
      {"title", "Hexapod of Müller & Søn"},
      {"program_version", "0.1.0"},
      {"calibration", {{"status", "converged"}, {"rms_px", 0.0625}, {"unobservable", json::array()}}},
      {"images",
       {{{"name", "000.png"}, {"picture", nullptr}, {"edges", {{{"leg", 1}, {"samples", {{1.5, -2.25}}}}}}}}},
      {"options", {{"note", "quotes \" and \\ and \n new lines, 3 < 4 > 2"}}}};
}

struct Page {
  const char* name;
  std::string (*render)(const json&);
  std::vector<const char*> headings;
};

class ReportPage : public testing::TestWithParam<Page> {};

TEST_P(ReportPage, EmbedsDataThatParseBackEqual) {
  const json data = CalibratedData();
  EXPECT_EQ(json::parse(EmbeddedData(GetParam().render(data))), data);
}

TEST_P(ReportPage, TextsOfTheDataCannotEndOrHideTheScriptElement) {
  for (const std::string attack :
       {"</script><script>alert(1)</script>", "<!--<script>", "</SCRIPT >", "<![CDATA["}) {
    const json data = {{"images", {{{"name", attack}}}}};
    const std::string page = GetParam().render(data);
    EXPECT_EQ(json::parse(EmbeddedData(page)), data);
    EXPECT_THAT(EmbeddedData(page), Not(HasSubstr("<")));
    EXPECT_THAT(page, Not(HasSubstr(attack)));
    EXPECT_EQ(Count(page, "<script"), Count(GetParam().render(json::object()), "<script"));
  }
}

TEST_P(ReportPage, HasEverySectionEvenWithoutData) {
  const std::string page = GetParam().render(json::object());
  for (const char* heading : GetParam().headings)
    EXPECT_THAT(page, HasSubstr(std::string("<h2>") + heading + "</h2>"));
}

TEST_P(ReportPage, IsOneWholeDocumentThatLoadsNothing) {
  const std::string page = GetParam().render(CalibratedData());
  EXPECT_EQ(page.find("<!doctype html>"), 0u);
  EXPECT_THAT(page, testing::EndsWith("</html>\n"));
  for (const char* leftover : {"@STYLE@", "@SCRIPT@", "@DATA@"}) EXPECT_THAT(page, Not(HasSubstr(leftover)));
  for (const char* load : {"<link", "<script src", "<img", "@import", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(load)));
}

TEST_P(ReportPage, NumbersThatAreNotFiniteAreEmbeddedAsNull) {
  const json data = {{"calibration", {{"rms_px", std::numeric_limits<double>::quiet_NaN()}}}};
  EXPECT_TRUE(json::parse(EmbeddedData(GetParam().render(data)))["calibration"]["rms_px"].is_null());
}

TEST_P(ReportPage, BytesThatAreNotUtf8AreReplaced) {
  const json data = {{"session", "caf\xe9/session"}};
  EXPECT_EQ(json::parse(EmbeddedData(GetParam().render(data)))["session"], "caf\xef\xbf\xbd/session");
}

INSTANTIATE_TEST_SUITE_P(
    Pages, ReportPage,
    testing::Values(
        Page{"Calibration",
             RenderCalibrationPage,
             {"Verdict", "Parameters: found and drawn", "Residuals",
              "Pictures with found and predicted edges", "What was left out", "Correlations",
              "Weak directions", "Prior knowledge and its pull", "Checks", "Options and provenance", "Time"}},
        Page{"Accuracy",
             RenderAccuracyPage,
             {"Summary", "The robot and its errors", "Largest errors", "Where the error comes from",
              "Indices", "All poses", "Map of the errors", "Do the indices tell the errors?",
              "Over the workspace", "Conventions, definitions, provenance"}},
        Page{"Servo",
             RenderServoPage,
             {"Verdict", "Errors", "Speeds and readings of the legs", "Conditioning",
              "Gain, and what slowed the robot", "The path in space",
              "Pictures with current and desired edges", "Computing times", "Settings and provenance"}},
        Page{"Intrinsics",
             RenderIntrinsicsPage,
             {"Verdict", "Parameters", "Uncertainty over the image",
              "Cross-validation: two halves of the views", "Residuals", "Pictures with found corners",
              "Coverage, and the view to add next", "What was left out", "Options, provenance, time"}},
        Page{"Legs",
             RenderLegsPage,
             {"Verdict", "Sets of legs", "The chosen set", "Other assembly modes of the chosen set",
              "Simulated servo of the chosen set", "Maps around the goal", "The legs, and the robot itself",
              "Definitions and provenance"}}),
    [](const auto& page) { return page.param.name; });

TEST(ReportPages, AreDifferentPages) {
  EXPECT_THAT(RenderCalibrationPage(json::object()), HasSubstr("<title>Calibration report</title>"));
  EXPECT_THAT(RenderAccuracyPage(json::object()), HasSubstr("<title>Accuracy report</title>"));
  EXPECT_THAT(RenderServoPage(json::object()), HasSubstr("<title>Servo report</title>"));
  EXPECT_THAT(RenderIntrinsicsPage(json::object()), HasSubstr("<title>Intrinsics report</title>"));
  EXPECT_THAT(RenderLegsPage(json::object()), HasSubstr("<title>Legs report</title>"));
}

}  // namespace
}  // namespace legible
