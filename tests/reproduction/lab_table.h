// A hundred runs a row: how they ended and how far off, as Markdown for people and JSON for machines.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/reproduction/lab_runs.h"

namespace legible {

struct LabRow {
  std::string label;
  std::vector<LabOutcome> outcomes;
};

double QuantileOf(std::vector<double> values, double share);
double MedianOf(const LabRow& row, double LabOutcome::*field);

// Columns: how runs ended ("refused": not begun); median · 90 % of the runs that were begun.
std::string Markdown(const std::vector<LabRow>& rows);
nlohmann::json Json(const std::vector<LabRow>& rows);

}  // namespace legible
