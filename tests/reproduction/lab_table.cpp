#include "tests/reproduction/lab_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace legible {
namespace {

struct Column {
  std::string name, title;
  double LabOutcome::*field;
  double unit;
  int digits;
};
const std::vector<Column> kErrors = {
    {"edge_error_px", "edges, px", &LabOutcome::edge_error_px, 1, 2},
    {"direction_error_mrad", "directions, mrad", &LabOutcome::direction_error_rad, 1e-3, 2},
    {"position_mm", "position, mm", &LabOutcome::position_m, 1e-3, 2},
    {"rotation_mrad", "rotation, mrad", &LabOutcome::rotation_rad, 1e-3, 2},
    {"path_deviation_percent", "path off straight, %", &LabOutcome::deviation_share, 1e-2, 1},
    {"settled_s", "settled, s", &LabOutcome::settled_s, 1, 1},
    {"time_s", "ended, s", &LabOutcome::time_s, 1, 1},
};

std::vector<double> Values(const LabRow& row, double LabOutcome::*field) {
  std::vector<double> values;
  for (const LabOutcome& outcome : row.outcomes)
    if (outcome.end != ServoEnd::kRunning) values.push_back(outcome.*field);
  return values;
}

// How it ended, a stall with what the supervisor made of it.
std::string EndOf(const LabOutcome& outcome) {
  const auto says = [&](const char* words) { return outcome.reason.find(words) != std::string::npos; };
  if (outcome.end == ServoEnd::kRunning) return "refused";
  if (outcome.end != ServoEnd::kStalled) return ToString(outcome.end);
  if (says("does not follow")) return "stalled by friction";
  return says("held back") ? "stalled at a joint range" : "stalled";
}

std::map<std::string, int> Ends(const LabRow& row) {
  std::map<std::string, int> ends;
  for (const LabOutcome& outcome : row.outcomes) ++ends[EndOf(outcome)];
  return ends;
}

std::string EndsText(const LabRow& row) {
  std::string text;
  for (const auto& [end, count] : Ends(row))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, end);
  return text;
}

}  // namespace

double QuantileOf(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double MedianOf(const LabRow& row, double LabOutcome::*field) { return QuantileOf(Values(row, field), 0.5); }

std::string Markdown(const std::vector<LabRow>& rows) {
  std::string text = "| | ended |", rule = "| --- | --- |";
  for (const Column& column : kErrors) {
    text += " " + column.title + " |";
    rule += " --- |";
  }
  text += "\n" + rule + "\n";
  for (const LabRow& row : rows) {
    text += fmt::format("| {} | {} |", row.label, EndsText(row));
    for (const Column& column : kErrors) {
      const std::vector<double> values = Values(row, column.field);
      text += fmt::format(" {:.{}f} · {:.{}f} |", QuantileOf(values, 0.5) / column.unit, column.digits,
                          QuantileOf(values, 0.9) / column.unit, column.digits);
    }
    text += "\n";
  }
  return text;
}

nlohmann::json Json(const std::vector<LabRow>& rows) {
  nlohmann::json all = nlohmann::json::array();
  for (const LabRow& row : rows) {
    nlohmann::json one = {{"label", row.label}, {"ends", Ends(row)}};
    for (const Column& column : kErrors) {
      const std::vector<double> values = Values(row, column.field);
      one[column.name] = {{"median", QuantileOf(values, 0.5) / column.unit},
                          {"p90", QuantileOf(values, 0.9) / column.unit}};
    }
    std::map<std::string, int> reasons;
    for (const LabOutcome& outcome : row.outcomes)
      if (outcome.end != ServoEnd::kConverged) ++reasons[outcome.reason];
    one["reasons"] = reasons;
    all.push_back(one);
  }
  return all;
}

}  // namespace legible
