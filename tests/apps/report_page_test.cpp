#include "apps/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

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

TEST(ReportPage, EmbedsDataThatParseBackEqual) {
  const json data = CalibratedData();
  EXPECT_EQ(json::parse(EmbeddedData(RenderReportPage(data))), data);
}

TEST(ReportPage, TextsOfTheDataCannotEndOrHideTheScriptElement) {
  for (const std::string attack :
       {"</script><script>alert(1)</script>", "<!--<script>", "</SCRIPT >", "<![CDATA["}) {
    const json data = {{"images", {{{"name", attack}}}}};
    const std::string page = RenderReportPage(data);
    EXPECT_EQ(json::parse(EmbeddedData(page)), data);
    EXPECT_THAT(EmbeddedData(page), Not(HasSubstr("<")));
    EXPECT_THAT(page, Not(HasSubstr(attack)));
    EXPECT_EQ(Count(page, "<script"), Count(RenderReportPage(json::object()), "<script"));
  }
}

TEST(ReportPage, HasEverySectionEvenWithoutData) {
  const std::string page = RenderReportPage(json::object());
  for (const char* heading :
       {"Verdict", "Parameters: found and drawn", "Residuals", "Pictures with found and predicted edges",
        "What was left out", "Correlations", "Weak directions", "Prior knowledge and its pull", "Checks",
        "Options and provenance", "Time"})
    EXPECT_THAT(page, HasSubstr(std::string("<h2>") + heading + "</h2>"));
}

TEST(ReportPage, IsOneWholeDocumentThatLoadsNothing) {
  const std::string page = RenderReportPage(CalibratedData());
  EXPECT_EQ(page.find("<!doctype html>"), 0u);
  EXPECT_THAT(page, testing::EndsWith("</html>\n"));
  for (const char* leftover : {"@STYLE@", "@SCRIPT@", "@DATA@"}) EXPECT_THAT(page, Not(HasSubstr(leftover)));
  for (const char* load : {"<link", "<script src", "<img", "@import", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(load)));
}

TEST(ReportPage, NumbersThatAreNotFiniteAreEmbeddedAsNull) {
  const json data = {{"calibration", {{"rms_px", std::numeric_limits<double>::quiet_NaN()}}}};
  EXPECT_TRUE(json::parse(EmbeddedData(RenderReportPage(data)))["calibration"]["rms_px"].is_null());
}

TEST(ReportPage, BytesThatAreNotUtf8AreReplaced) {
  const json data = {{"session", "caf\xe9/session"}};
  EXPECT_EQ(json::parse(EmbeddedData(RenderReportPage(data)))["session"], "caf\xef\xbf\xbd/session");
}

}  // namespace
}  // namespace legible
