// Tables of comma separated values whose first row names the columns.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace legible {

// A row's fields without the white space around them, and the line of the file (from 1) that they stand in.
struct CsvRow {
  int line = 0;
  std::vector<std::string_view> fields;
};

// All rows of a text, views into it; blank lines and lines that begin with # are passed over.
std::vector<CsvRow> SplitCsv(std::string_view text);

struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional;
};

// The rows below the header with their fields in the order of `columns`, required ones first; the field of an
// optional column that is not there is empty. Throws InputError for a missing, repeated or unknown column and
// for a row of another length than the header's.
std::vector<CsvRow> ArrangeCsv(const std::filesystem::path& file, const std::vector<CsvRow>& rows,
                               const CsvColumns& columns);

}  // namespace legible
