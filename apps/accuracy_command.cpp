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

}  // namespace

int RunAccuracy(const AccuracySettings& settings, const Console& console) {
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
