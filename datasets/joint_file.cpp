#include "datasets/joint_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "core/robots/gough_stewart.h"
#include "datasets/atomic_file.h"
#include "datasets/csv_table.h"
#include "datasets/input_error.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

const std::vector<std::string> kColumns = {"image", "q1_m", "q2_m", "q3_m", "q4_m", "q5_m", "q6_m"};

std::string ImageName(const std::filesystem::path& file, const CsvRow& row, std::string_view field) {
  if (field.empty()) throw InputError(file, row.line, "image is empty", "name the image's file");
  const std::filesystem::path name(field);
  if (name.filename() != name || name == "." || name == "..") {
    throw InputError(file, row.line, fmt::format("image \"{}\" is no plain file name", field),
                     "name a file of the session's image folder");
  }
  return name.string();
}

JointRow ParseRow(const std::filesystem::path& file, const CsvRow& row) {
  JointRow result;
  result.line = row.line;
  result.image = ImageName(file, row, row.fields[0]);
  for (int i = 0; i < kLegCount; ++i) {
    const std::string_view field = row.fields[i + 1];
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
  std::vector<JointRow> rows;
  for (const CsvRow& row : ArrangeCsv(file, SplitCsv(text), {kColumns, {}}))
    rows.push_back(ParseRow(file, row));
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
