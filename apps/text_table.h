// Tables of text in columns.
#pragma once

#include <string>
#include <vector>

namespace legible {

using TableRow = std::vector<std::string>;

// A line a row, indented by two, columns as wide as they need to be in characters of UTF-8: the first to the
// left, the others to the right.
std::string AlignedTable(const std::vector<TableRow>& rows);

}  // namespace legible
