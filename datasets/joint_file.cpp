#include "datasets/joint_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "core/robots/gough_stewart.h"
#include "datasets/atomic_file.h"
#include "datasets/input_error.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

const std::vector<std::string> kColumns = {"image", "q1_m", "q2_m", "q3_m", "q4_m", "q5_m", "q6_m"};

// A line's fields without the white space around them.
struct CsvRow {
  int line = 0;
  std::vector<std::string_view> fields;
};

std::vector<std::string_view> SplitTrimmed(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(Trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

// All rows, the header first; views into `text`.
std::vector<CsvRow> SplitRows(std::string_view text) {
  std::vector<CsvRow> rows;
  int line_number = 0;
  for (const std::string_view line : SplitTrimmed(text, '\n')) {
    ++line_number;
    if (!line.empty() && line[0] != '#') rows.push_back({line_number, SplitTrimmed(line, ',')});
  }
  return rows;
}

// Where in a row each of kColumns stands.
std::vector<size_t> ColumnPlaces(const std::filesystem::path& file, const CsvRow& header) {
  const std::string mend = fmt::format("the columns are {}", fmt::join(kColumns, ","));
  for (const std::string_view field : header.fields) {
    const std::string name(field);
    if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end()) {
      throw InputError(
          file, header.line,
          fmt::format("unknown column \"{}\" (the nearest known is {})", name, NearestName(name, kColumns)),
          mend);
    }
    if (std::count(header.fields.begin(), header.fields.end(), field) > 1) {
      throw InputError(file, header.line, fmt::format("column {} is there twice", name), mend);
    }
  }
  std::vector<size_t> places;
  for (const std::string& column : kColumns) {
    const auto found = std::find(header.fields.begin(), header.fields.end(), column);
    if (found == header.fields.end()) {
      throw InputError(file, header.line, fmt::format("column {} is missing", column), mend);
    }
    places.push_back(static_cast<size_t>(found - header.fields.begin()));
  }
  return places;
}

std::string ImageName(const std::filesystem::path& file, const CsvRow& row, std::string_view field) {
  if (field.empty()) throw InputError(file, row.line, "image is empty", "name the image's file");
  const std::filesystem::path name(field);
  if (name.filename() != name || name == "." || name == "..") {
    throw InputError(file, row.line, fmt::format("image \"{}\" is no plain file name", field),
                     "name a file of the session's image folder");
  }
  return name.string();
}

JointRow ParseRow(const std::filesystem::path& file, const CsvRow& row, const std::vector<size_t>& places) {
  if (row.fields.size() != places.size()) {
    throw InputError(file, row.line,
                     fmt::format("{} fields in this row, {} columns", row.fields.size(), places.size()),
                     "give one field for each column");
  }
  JointRow result;
  result.line = row.line;
  result.image = ImageName(file, row, row.fields[places[0]]);
  for (int i = 0; i < kLegCount; ++i) {
    const std::string_view field = row.fields[places[i + 1]];
    const std::optional<double> reading = ParseFinite(field);
    if (!reading) {
      throw InputError(file, row.line,
                       fmt::format("{} is \"{}\", not a finite number", kColumns[i + 1], field),
                       "give the reading in metres, or take this row out");
    }
    result.readings_m[i] = *reading;
  }
  return result;
}

void DemandDistinctImages(const std::filesystem::path& file, const std::vector<JointRow>& rows) {
  std::map<std::string, int> lines;
  for (const JointRow& row : rows) {
    const auto [place, is_new] = lines.emplace(row.image, row.line);
    if (is_new) continue;
    throw InputError(file, row.line,
                     fmt::format("image \"{}\" is there already, in line {}", row.image, place->second),
                     "keep one row for each image");
  }
}

}  // namespace

std::vector<JointRow> ReadJoints(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file);
  const std::vector<CsvRow> lines = SplitRows(text);
  const std::vector<size_t> places = ColumnPlaces(file, lines.empty() ? CsvRow{1, {}} : lines[0]);
  std::vector<JointRow> rows;
  for (size_t i = 1; i < lines.size(); ++i) rows.push_back(ParseRow(file, lines[i], places));
  if (rows.empty())
    throw InputError(file, 0, "no image: there is no row below the header", "add one for each image");
  DemandDistinctImages(file, rows);
  return rows;
}

void WriteJoints(const std::filesystem::path& file, const std::vector<JointRow>& rows) {
  std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
  for (const JointRow& row : rows) {
    text += row.image;
    for (const double reading : row.readings_m) text += fmt::format(",{}", NumberText(reading));
    text += "\n";
  }
  WriteFileAtomically(file, text);
}

}  // namespace legible
