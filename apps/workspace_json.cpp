#include "apps/workspace_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/accuracy_judgement.h"
#include "apps/accuracy_units.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

ordered_json EnclosureJson(const Enclosure& enclosure, double unit) {
  return {{"value", enclosure.value / unit}, {"half_width", enclosure.half_width / unit}};
}

ordered_json StatisticsJson(const QuantityStatistics& statistics, double unit) {
  ordered_json quantiles = ordered_json::array();
  for (const Quantile& quantile : statistics.quantiles) {
    quantiles.push_back(EnclosureJson(quantile.at, unit));
    quantiles.back()["p"] = quantile.part;
  }
  return {{"mean", EnclosureJson(statistics.mean, unit)},
          {"variance", EnclosureJson(statistics.variance, unit * unit)},
          {"quantiles", quantiles},
          {"largest_seen", statistics.largest_seen / unit},
          {"smallest_seen", statistics.smallest_seen / unit}};
}

struct RowText {
  std::string of, label;
  int kind;  // 0 length, 1 angle, 2 number
};

const std::vector<RowText>& RowTexts() {
  static const std::vector<RowText> texts = {
      {"x", "error in x", 0},
      {"y", "error in y", 0},
      {"z", "error in z", 0},
      {"rx", "rotation error about x", 1},
      {"ry", "rotation error about y", 1},
      {"rz", "rotation error about z", 1},
      {"position", "largest position error", 0},
      {"rotation", "largest rotation error", 1},
      {"inverse_condition_two_normalized", "1 / condition number (2-norm, normalised)", 2}};
  return texts;
}

std::string CertaintyText(Certainty certainty, int replicates) {
  return certainty == Certainty::kStatistical95
             ? fmt::format(
                   "the truth lies within the half width with 95 %, by the scatter of {} independently "
                   "randomised replicates",
                   replicates)
             : "half width: the change from half as many panels; an estimate, good where the integrand is "
               "smooth";
}

ordered_json BoxJson(const Box& box, const InUnits& units) {
  ordered_json json;
  for (Eigen::Index i = 0; i < box.low.size(); ++i)
    json[CoordinateNames()[static_cast<size_t>(i)]] = {box.low[i] / units.Of(i), box.high[i] / units.Of(i)};
  return json;
}

}  // namespace

ordered_json WorkspaceJson(const Workspace& workspace, const AccuracySettings& settings) {
  const InUnits units(settings);
  const WorkspaceStatistics& found = workspace.statistics;
  ordered_json statistics = ordered_json::array();
  for (size_t row = 0; row < RowTexts().size() && !found.quantities.empty(); ++row) {
    const RowText& text = RowTexts()[row];
    ordered_json one = {{"of", text.of},
                        {"label", text.label},
                        {"unit", text.kind == 0   ? LengthUnitOf(settings).name
                                 : text.kind == 1 ? AngleUnitOf(settings).name
                                                  : ""}};
    one.update(StatisticsJson(found.quantities[row], text.kind == 2 ? 1 : units.Of(3 * text.kind)));
    statistics.push_back(one);
  }
  ordered_json gci = nullptr;
  if (!found.quantities.empty()) gci = EnclosureJson(found.quantities[kInverseConditionRow].mean, 1);
  return {{"over", workspace.laid.over},
          {"measure", "uniform in the coordinates named"},
          {"box", BoxJson(workspace.laid.box, units)},
          {"characteristic_length", units.Length(workspace.laid.characteristic_length_m)},
          {"rule", ToString(settings.sampling.rule)},
          {"samples", found.samples},
          {"replicates", found.replicates},
          {"inside", found.inside},
          {"near_singular_samples", found.near_singular},
          {"singular_samples", found.singular},
          {"crosses_singularity", workspace.crosses_singularity},
          {"allowed_fraction", EnclosureJson(found.allowed_fraction, 1)},
          {"certainty", CertaintyText(found.certainty, found.replicates)},
          {"global_conditioning_index", gci},
          {"statistics", statistics},
          {"warnings", WorkspaceWarnings(workspace)}};
}

}  // namespace legible
