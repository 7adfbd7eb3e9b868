#include "apps/legs_command.h"

#include <nlohmann/json.hpp>

#include "apps/json_text.h"
#include "apps/legs_json.h"
#include "apps/legs_report.h"
#include "apps/legs_run.h"
#include "apps/legs_text.h"
#include "apps/program.h"
#include "apps/report_page.h"
#include "apps/wording.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

std::string TextOf(const LegsRun& run, const nlohmann::ordered_json& document) {
  switch (run.settings.format) {
    case LegsFormat::kJson:
      return JsonText(document);
    case LegsFormat::kHtml:
      return RenderLegsPage(LegsReportData(run, document));
    case LegsFormat::kTable:
      break;
  }
  return LegsTable(document);
}

}  // namespace

int RunLegs(const LegsSettings& settings, const Console& console) {
  std::error_code ignored;
  if (settings.out && std::filesystem::equivalent(settings.model, *settings.out, ignored))
    throw InputError(*settings.out, 0, "is what is read, and would be overwritten",
                     "name another file with --out");
  ProgressLine progress(console);
  const LegsRun run = JudgeLegs(settings, progress);
  const nlohmann::ordered_json document = LegsJson(run);
  const std::string text = TextOf(run, document);
  progress.Clear();
  if (settings.out)
    WriteFileAtomically(*settings.out, text);
  else
    console.out << text;
  console.err << WarningsText(document.at("warnings"));
  if (run.selection.has_choice) return kExitSuccess;
  console.err << "legible: " << document.at("why_no_choice").get<std::string>() << "\n";
  return kExitNoResult;
}

}  // namespace legible
