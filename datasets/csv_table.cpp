#include "datasets/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

using Place = std::optional<size_t>;  // of a column in the file's rows

std::vector<std::string_view> SplitTrimmed(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(Trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

void DemandKnownOnce(const std::filesystem::path& file, const CsvRow& header,
                     const std::vector<std::string>& known, const std::string& mend) {
  for (const std::string_view field : header.fields) {
    const std::string name(field);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError(
          file, header.line,
          fmt::format("unknown column \"{}\" (the nearest known is {})", name, NearestName(name, known)),
          mend);
    }
    if (std::count(header.fields.begin(), header.fields.end(), field) > 1)
      throw InputError(file, header.line, fmt::format("column {} is there twice", name), mend);
  }
}

std::vector<Place> ColumnPlaces(const std::filesystem::path& file, const CsvRow& header,
                                const CsvColumns& columns) {
  std::vector<std::string> known = columns.required;
  known.insert(known.end(), columns.optional.begin(), columns.optional.end());
  const std::string mend =
      fmt::format("the columns are {}", fmt::join(columns.required, ",")) +
      (columns.optional.empty() ? "" : fmt::format(" and, if wished, {}", fmt::join(columns.optional, ",")));
  DemandKnownOnce(file, header, known, mend);
  std::vector<Place> places;
  for (const std::string& column : known) {
    const auto found = std::find(header.fields.begin(), header.fields.end(), column);
    if (found != header.fields.end())
      places.emplace_back(static_cast<size_t>(found - header.fields.begin()));
    else if (places.size() < columns.required.size())
      throw InputError(file, header.line, fmt::format("column {} is missing", column), mend);
    else
      places.emplace_back(std::nullopt);
  }
  return places;
}

}  // namespace

std::vector<CsvRow> SplitCsv(std::string_view text) {
  std::vector<CsvRow> rows;
  int line_number = 0;
  for (const std::string_view line : SplitTrimmed(text, '\n')) {
    ++line_number;
    if (!line.empty() && line[0] != '#') rows.push_back({line_number, SplitTrimmed(line, ',')});
  }
  return rows;
}

std::vector<CsvRow> ArrangeCsv(const std::filesystem::path& file, const std::vector<CsvRow>& rows,
                               const CsvColumns& columns) {
  const CsvRow header = rows.empty() ? CsvRow{1, {}} : rows[0];
  const std::vector<Place> places = ColumnPlaces(file, header, columns);
  std::vector<CsvRow> arranged;
  for (size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].fields.size() != header.fields.size()) {
      throw InputError(
          file, rows[i].line,
          fmt::format("{} fields in this row, {} columns", rows[i].fields.size(), header.fields.size()),
          "give one field for each column");
    }
    CsvRow row{rows[i].line, {}};
    for (const Place& place : places)
      row.fields.push_back(place ? rows[i].fields[*place] : std::string_view());
    arranged.push_back(row);
  }
  return arranged;
}

}  // namespace legible
