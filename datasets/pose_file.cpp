#include "datasets/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "datasets/csv_table.h"
#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

const std::vector<std::string> kPlain = {"x", "y", "z", "rx", "ry", "rz"};
const std::vector<std::string> kWithUnits = {"x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad"};
const std::string kName = "name";

bool HasNoHeader(const std::vector<CsvRow>& rows) {
  return !rows.empty() && rows[0].fields.size() == kPlain.size() &&
         std::all_of(rows[0].fields.begin(), rows[0].fields.end(),
                     [](std::string_view field) { return ParseFinite(field).has_value(); });
}

// Rows with the six coordinates and the name, which may be empty.
std::vector<CsvRow> Arranged(const std::filesystem::path& file, std::vector<CsvRow> rows) {
  if (HasNoHeader(rows)) {
    const CsvRow header{rows[0].line, {kPlain.begin(), kPlain.end()}};
    rows.insert(rows.begin(), header);
  }
  const bool has_units =
      !rows.empty() && std::any_of(rows[0].fields.begin(), rows[0].fields.end(), [](std::string_view field) {
        return std::find(kWithUnits.begin(), kWithUnits.end(), field) != kWithUnits.end();
      });
  return ArrangeCsv(file, rows, {has_units ? kWithUnits : kPlain, {kName}});
}

PoseRow ParseRow(const std::filesystem::path& file, const CsvRow& row, size_t number) {
  PoseRow pose;
  pose.line = row.line;
  pose.name = row.fields.back().empty() ? std::to_string(number) : std::string(row.fields.back());
  for (size_t i = 0; i < kPlain.size(); ++i) {
    const std::optional<double> value = ParseFinite(row.fields[i]);
    if (!value)
      throw InputError(file, row.line,
                       fmt::format("{} is \"{}\", not a finite number", kPlain[i], row.fields[i]),
                       "give metres and radians, or take this row out");
    pose.coordinates[static_cast<Eigen::Index>(i)] = *value;
  }
  return pose;
}

}  // namespace

std::vector<PoseRow> ReadPoses(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file);
  std::vector<PoseRow> poses;
  std::map<std::string, int> lines;
  for (const CsvRow& row : Arranged(file, SplitCsv(text))) {
    poses.push_back(ParseRow(file, row, poses.size() + 1));
    const auto [place, is_new] = lines.emplace(poses.back().name, row.line);
    if (!is_new)
      throw InputError(file, row.line,
                       fmt::format("pose \"{}\" is there already, in line {}", place->first, place->second),
                       "give each pose a name of its own");
  }
  if (poses.empty())
    throw InputError(file, 0, "no pose: there is no row below the header", "add one for each pose");
  return poses;
}

}  // namespace legible
