#include "apps/accuracy_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/index_definitions.h"
#include "apps/text_table.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

const std::vector<std::string> kErrors = {"x", "y", "z", "rx", "ry", "rz", "position", "rotation"};
const std::vector<std::string> kConditions = {"two",
                                              "frobenius",
                                              "infinity",
                                              "frobenius_of_gram",
                                              "two_normalized",
                                              "frobenius_normalized",
                                              "infinity_normalized",
                                              "frobenius_of_gram_normalized"};
const std::vector<std::string> kThreePoint = {"two_three_point", "frobenius_three_point",
                                              "frobenius_three_point_plain"};

constexpr size_t kMostPosesInDetail = 6;  // of longer lists only errors and what the sources add up to

std::string Number(const ordered_json& value) {
  const bool is_known = value.is_number() && std::isfinite(value.get<double>());
  return is_known ? fmt::format("{:.5g}", value.get<double>()) : "-";
}

// Member by member; null where one is missing.
const ordered_json& At(const ordered_json& json, const std::vector<std::string>& path) {
  static const ordered_json kNull;
  const ordered_json* at = &json;
  for (const std::string& name : path) {
    if (!at->is_object() || !at->contains(name)) return kNull;
    at = &at->at(name);
  }
  return *at;
}

// --- Tables.

using Row = TableRow;

std::string Section(const std::string& title, const std::vector<Row>& rows) {
  return rows.size() < 2 ? "" : "\n" + title + "\n" + AlignedTable(rows);
}

std::string ErrorTable(const ordered_json& document) {
  Row header = {"pose"};
  header.insert(header.end(), kErrors.begin(), kErrors.end());
  header.emplace_back("status");
  std::vector<Row> rows = {header};
  for (const ordered_json& pose : document.at("poses")) {
    Row row = {pose.at("name")};
    for (const std::string& name : kErrors) row.push_back(Number(At(pose, {"max_error", name})));
    row.push_back(pose.at("status"));
    rows.push_back(row);
  }
  return Section(fmt::format("Largest errors, {} and {}: along each axis of the base, and in any direction",
                             document.at("units").at("length").get<std::string>(),
                             document.at("units").at("angle").get<std::string>()),
                 rows);
}

void AddSourceRow(const std::string& pose, const std::string& name, const ordered_json& source,
                  std::vector<Row>& rows) {
  Row row = {pose, name};
  for (const char* kind : {"bound", "value_95"})
    for (const char* what : {"position", "rotation"}) row.push_back(Number(At(source, {kind, what})));
  const ordered_json& parts = At(source, {"contributions"});
  row.push_back(parts.is_array() && !parts.empty() ? parts[0].at("name").get<std::string>() : "-");
  rows.push_back(row);
}

std::string SourceTable(const ordered_json& document) {
  std::vector<Row> rows = {
      {"pose", "source", "bound: position", "rotation", "95 %: position", "rotation", "most from"}};
  const bool is_long = document.at("poses").size() > kMostPosesInDetail;
  for (const ordered_json& pose : document.at("poses")) {
    const ordered_json& sources = At(pose, {"sources"});
    if (!sources.is_array()) continue;
    if (!is_long)
      for (const ordered_json& source : sources)
        AddSourceRow(pose.at("name"), source.at("name"), source, rows);
    if (sources.size() > 1 || is_long) AddSourceRow(pose.at("name"), "together", pose.at("together"), rows);
  }
  return Section("Where errors come from", rows);
}

std::string Range(const ordered_json& range) {
  return range.is_array() ? fmt::format("{} to {}", Number(range[0]), Number(range[1])) : "-";
}

// A row an index, a column a pose.
std::string IndexTable(const ordered_json& document) {
  const ordered_json& poses = document.at("poses");
  if (poses.size() > kMostPosesInDetail)
    return "\nIndices: too many poses for a table; --format csv has a row for each\n";
  std::vector<Row> rows;
  const auto add = [&](const std::string& label, const auto& cell) {
    Row row = {label};
    for (const ordered_json& pose : poses) row.push_back(cell(pose));
    rows.push_back(row);
  };
  const ordered_json& units = document.at("units");
  add("index", [](const ordered_json& pose) { return pose.at("name").get<std::string>(); });
  for (const std::string key : {"determinant", "manipulability"})
    add(fmt::format("{}, {}", key, units.at(key).get<std::string>()),
        [&](const ordered_json& pose) { return Number(At(pose, {key})); });
  for (const std::string& name : kConditions)
    add(IndexLabel("condition." + name), [&](const ordered_json& pose) {
      return Number(At(pose, {"condition", name}));
    });
  add("characteristic length (2-norm), " + units.at("length").get<std::string>(),
      [](const ordered_json& pose) {
        return Number(At(pose, {"condition", "characteristic_length", "two"}));
      });
  for (const std::string& name : kThreePoint)
    add(IndexLabel("condition." + name), [&](const ordered_json& pose) {
      return Range(At(pose, {"condition", name}));
    });
  return Section("Indices", rows);
}

std::string ComparisonTable(const ordered_json& document) {
  const ordered_json& comparison = document.at("comparison");
  if (comparison.is_null()) return "";
  std::vector<Row> rows = {
      {"index", "tau: position", "rotation", "misranked: position", "rotation", "worst inversion"}};
  for (const ordered_json& index : comparison.at("indices")) {
    const auto percent = [&](const char* of) {
      const ordered_json& part = index.at("misranked").at(of);
      return part.is_number() ? fmt::format("{:.1f} %", 100 * part.get<double>()) : std::string("-");
    };
    Row row = {index.at("label"), fmt::format("{:+.2f}", index.at("tau").at("position").get<double>()),
               fmt::format("{:+.2f}", index.at("tau").at("rotation").get<double>()), percent("position"),
               percent("rotation")};
    const ordered_json& inversions = index.at("worst_inversions");
    row.push_back(
        inversions.empty()
            ? "none"
            : fmt::format("prefers {} ({}) to {} ({})", inversions[0].at("better").get<std::string>(),
                          Number(inversions[0].at("error")[0]), inversions[0].at("worse").get<std::string>(),
                          Number(inversions[0].at("error")[1])));
    rows.push_back(row);
  }
  std::string text =
      Section("Indices against errors, over " + comparison.at("over").get<std::string>(), rows);
  return text + "  " + comparison.at("verdict")[0].get<std::string>() + "\n";
}

std::string PlusMinus(const ordered_json& enclosure) {
  const ordered_json& half_width = enclosure.at("half_width");
  if (!half_width.is_number() || !std::isfinite(half_width.get<double>())) return "-";
  return fmt::format("{} ± {:.1g}", Number(enclosure.at("value")), half_width.get<double>());
}

std::string WorkspaceTable(const ordered_json& document) {
  const ordered_json& workspace = document.at("workspace");
  if (workspace.is_null()) return "";
  std::vector<Row> rows = {{"", "mean", "median", "95 % below", "largest seen", "standard deviation"}};
  for (const ordered_json& one : workspace.at("statistics")) {
    const auto quantile = [&](double part) {
      for (const ordered_json& entry : one.at("quantiles"))
        if (entry.at("p") == part) return PlusMinus(entry);
      return std::string("-");
    };
    const std::string unit = one.at("unit");
    Row row = {one.at("label")};
    if (!unit.empty()) row[0].append(", ").append(unit);
    row.insert(row.end(),
               {PlusMinus(one.at("mean")), quantile(0.5), quantile(0.95), Number(one.at("largest_seen")),
                fmt::format("{:.5g}", std::sqrt(one.at("variance").at("value").get<double>()))});
    rows.push_back(std::move(row));
  }
  std::string text = fmt::format("\nOver the workspace {}\n", workspace.at("over").get<std::string>());
  if (rows.size() > 1) text += AlignedTable(rows);
  text += fmt::format("  {} samples ({}), {} of the box allowed; {}\n", workspace.at("samples").get<size_t>(),
                      workspace.at("rule").get<std::string>(), PlusMinus(workspace.at("allowed_fraction")),
                      workspace.at("certainty").get<std::string>());
  if (!workspace.at("global_conditioning_index").is_null())
    text += fmt::format("  global conditioning index {} (2-norm, characteristic length {} {})\n",
                        PlusMinus(workspace.at("global_conditioning_index")),
                        Number(workspace.at("characteristic_length")),
                        document.at("units").at("length").get<std::string>());
  return text;
}

// --- CSV.

std::string CsvNumber(const ordered_json& value) {
  return value.is_number() && std::isfinite(value.get<double>()) ? fmt::format("{}", value.get<double>())
                                                                 : "";
}

// Quoted where it must be (RFC 4180).
std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

Row CsvHeader(const std::string& length, const std::string& angle) {
  Row header = {"name", "status"};
  const auto unit = [&](const std::string& name) { return name[0] == 'r' ? angle : length; };
  for (size_t i = 0; i < 6; ++i) header.push_back(kErrors[i] + "_" + unit(kErrors[i]));
  for (const std::string& name : kErrors) header.push_back("max_error_" + name + "_" + unit(name));
  for (const char* kind : {"bound", "value_95"})
    for (const std::string name : {"position", "rotation"})
      header.push_back(fmt::format("together_{}_{}_{}", kind, name, unit(name)));
  header.emplace_back("determinant");
  header.emplace_back("manipulability");
  for (const std::string& name : kConditions) header.push_back("condition_" + name);
  for (const std::string& name : kThreePoint)
    for (const char* end : {"_min", "_max"}) header.push_back("condition_" + name + end);
  return header;
}

Row CsvRowOf(const ordered_json& pose) {
  Row row = {CsvText(pose.at("name")), pose.at("status")};
  for (const ordered_json& coordinate : pose.at("pose")) row.push_back(CsvNumber(coordinate));
  for (const std::string& name : kErrors) row.push_back(CsvNumber(At(pose, {"max_error", name})));
  for (const char* kind : {"bound", "value_95"})
    for (const char* name : {"position", "rotation"})
      row.push_back(CsvNumber(At(pose, {"together", kind, name})));
  row.push_back(CsvNumber(At(pose, {"determinant"})));
  row.push_back(CsvNumber(At(pose, {"manipulability"})));
  for (const std::string& name : kConditions) row.push_back(CsvNumber(At(pose, {"condition", name})));
  for (const std::string& name : kThreePoint)
    for (const size_t end : {0, 1}) {
      const ordered_json& range = At(pose, {"condition", name});
      row.push_back(range.is_array() ? CsvNumber(range[end]) : "");
    }
  return row;
}

}  // namespace

std::string AccuracyTable(const ordered_json& document) {
  std::string text = fmt::format("{} ({}), poses by {}\n", document.at("robot").get<std::string>(),
                                 document.at("model").get<std::string>(),
                                 document.at("conventions").at("orientation").get<std::string>());
  return text + ErrorTable(document) + SourceTable(document) + IndexTable(document) +
         ComparisonTable(document) + WorkspaceTable(document);
}

std::string AccuracyCsv(const ordered_json& document) {
  const ordered_json& units = document.at("units");
  std::string text = fmt::format("{}\n", fmt::join(CsvHeader(units.at("length"), units.at("angle")), ","));
  for (const ordered_json& pose : document.at("poses"))
    text += fmt::format("{}\n", fmt::join(CsvRowOf(pose), ","));
  return text;
}

}  // namespace legible
