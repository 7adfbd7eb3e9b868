#include "apps/report_page.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/report/page_template.h"

namespace legible {
namespace {

// JSON text that cannot end the script element around it, nor open a comment in it: "<" occurs only in
// strings, where it may be written as an escape.
std::string WithoutMarkup(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char character : json) {
    if (character == '<')
      safe += "\\u003c";
    else
      safe += character;
  }
  return safe;
}

std::string Render(const PageTemplate& page, const nlohmann::json& data) {
  std::string text(page.before_data);
  text += WithoutMarkup(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  text += page.after_data;
  return text;
}

}  // namespace

std::string RenderCalibrationPage(const nlohmann::json& data) { return Render(CalibrationPage(), data); }
std::string RenderAccuracyPage(const nlohmann::json& data) { return Render(AccuracyPage(), data); }
std::string RenderServoPage(const nlohmann::json& data) { return Render(ServoPage(), data); }
std::string RenderIntrinsicsPage(const nlohmann::json& data) { return Render(IntrinsicsPage(), data); }
std::string RenderLegsPage(const nlohmann::json& data) { return Render(LegsPage(), data); }

}  // namespace legible
