#include "tests/bench/bench_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace legible {
namespace {

size_t WidthOf(const std::string& name) { return std::max<size_t>(18, name.size() + 2); }

void Print(const BenchTable& table) {
  fmt::print("{}\n", table.name);
  if (table.rows.empty()) return;
  fmt::print("{:24}", "");
  for (const auto& [name, value] : table.rows.front().figures) fmt::print("{:>{}}", name, WidthOf(name));
  fmt::print("\n");
  for (const BenchTable::Row& row : table.rows) {
    fmt::print("{:24}", row.label);
    for (const auto& [name, value] : row.figures) fmt::print("{:>{}.5g}", value, WidthOf(name));
    fmt::print("\n");
  }
  fmt::print("\n");
}

nlohmann::ordered_json ToJson(const std::vector<BenchTable>& tables) {
  nlohmann::ordered_json document;
  for (const BenchTable& table : tables)
    for (const BenchTable::Row& row : table.rows) {
      nlohmann::ordered_json figures = {{"label", row.label}};
      for (const auto& [name, value] : row.figures) figures[name] = value;
      document[table.name].push_back(figures);
    }
  return document;
}

}  // namespace

int Report(const std::vector<BenchTable>& tables, int argc, char** argv) {
  const bool as_json = argc == 3 && std::strcmp(argv[1], "--json") == 0;
  if (argc != 1 && !as_json) {
    fmt::print(stderr, "usage: {} [--json FILE]\n", argv[0]);
    return 2;
  }
  for (const BenchTable& table : tables) Print(table);
  if (!as_json) return 0;
  std::ofstream file(argv[2]);
  file << ToJson(tables).dump(2) << '\n';
  file.close();
  if (!file) fmt::print(stderr, "{}: cannot be written; name a file in a folder that exists\n", argv[2]);
  return file ? 0 : 2;
}

}  // namespace legible
