#include "apps/accuracy_command.h"

#include <nlohmann/json.hpp>

#include "apps/accuracy_json.h"
#include "apps/accuracy_report.h"
#include "apps/accuracy_run.h"
#include "apps/accuracy_text.h"
#include "apps/json_text.h"
#include "apps/program.h"
#include "apps/report_page.h"
#include "apps/wording.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

std::string TextOf(const AccuracyRun& run, const nlohmann::ordered_json& document) {
  switch (run.settings.format) {
    case AccuracyFormat::kJson:
      return JsonText(document);
    case AccuracyFormat::kCsv:
      return AccuracyCsv(document);
    case AccuracyFormat::kHtml:
      return RenderAccuracyPage(AccuracyReportData(run, document));
    case AccuracyFormat::kTable:
      break;
  }
  return AccuracyTable(document);
}

// The result must not take the place of what it is computed from.
void DemandOtherThanInputs(const AccuracySettings& settings) {
  if (!settings.out) return;
  std::error_code ignored;
  for (const auto& input : {std::optional(settings.model), settings.poses_file})
    if (input && std::filesystem::equivalent(*input, *settings.out, ignored))
      throw InputError(*settings.out, 0, "is what is read, and would be overwritten",
                       "name another file with --out");
}

}  // namespace

int RunAccuracy(const AccuracySettings& settings, const Console& console) {
  DemandOtherThanInputs(settings);
  ProgressLine progress(console);
  const AccuracyRun run = JudgeAccuracy(settings, progress);
  const nlohmann::ordered_json document = AccuracyJson(run);
  const std::string text = TextOf(run, document);
  progress.Clear();
  if (settings.out)
    WriteFileAtomically(*settings.out, text);
  else
    console.out << text;
  console.err << WarningsText(document.at("warnings"));
  if (run.HasErrors()) return kExitSuccess;
  console.err << "legible: no pose has errors: all are singular\n";
  return kExitNoResult;
}

}  // namespace legible
