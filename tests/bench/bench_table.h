// Figures of a benchmark as a table for people and as JSON for machines.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace legible {

// Rows of named figures; every row has the same names in the same order.
struct BenchTable {
  std::string name;
  struct Row {
    std::string label;
    std::vector<std::pair<std::string, double>> figures;  // name with unit, value
  };
  std::vector<Row> rows;
};

// Prints the tables to stdout; with "--json FILE" among the arguments also writes them there. The program's
// exit code: 2, with a line on stderr, for other arguments or a file that cannot be written.
int Report(const std::vector<BenchTable>& tables, int argc, char** argv);

}  // namespace legible
