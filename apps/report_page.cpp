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

}  // namespace

std::string RenderReportPage(const nlohmann::json& data) {
  std::string page(PageBeforeData());
  page += WithoutMarkup(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  page += PageAfterData();
  return page;
}

}  // namespace legible
