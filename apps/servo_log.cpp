#include "apps/servo_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/json_text.h"
#include "apps/servo_setup_json.h"
#include "core/geometry/pose_coordinates.h"
#include "datasets/atomic_file.h"
#include "datasets/csv_table.h"
#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

constexpr char kMend[] = "give the folder of a log as `legible servo` wrote it";

// ---- Writing: a column is a name and what stands in it.

// A row of a table in the making; the first row's names are the header.
class CsvRowWriter {
 public:
  void Add(const std::string& name, double value) { Put(name, fmt::format("{}", value)); }
  void Add(const std::string& name, const std::string& text) {
    std::string plain = text;
    std::replace(plain.begin(), plain.end(), ',', ' ');
    Put(name, plain);
  }
  template <typename Vector>
  void AddAll(const std::vector<std::string>& names, const Vector& values) {
    for (size_t i = 0; i < names.size(); ++i) Add(names[i], values[static_cast<Eigen::Index>(i)]);
  }
  void AddNone(const std::vector<std::string>& names) {
    for (const std::string& name : names) Put(name, "");
  }
  const std::string& header() const { return header_; }
  const std::string& row() const { return row_; }

 private:
  void Put(const std::string& name, const std::string& text) {
    const char* separator = header_.empty() ? "" : ",";
    header_ += separator + name;
    row_ += separator + text;
  }
  std::string header_, row_;
};

std::vector<std::string> ByLegNames(const std::string& letter, const std::string& unit) {
  std::vector<std::string> names;
  for (int i = 1; i <= kLegCount; ++i) names.push_back(fmt::format("{}{}_{}", letter, i, unit));
  return names;
}
std::vector<std::string> PoseNames(const std::string& prefix) {
  return {prefix + "x_m",    prefix + "y_m",    prefix + "z_m",
          prefix + "rx_rad", prefix + "ry_rad", prefix + "rz_rad"};
}
const std::vector<std::string> kCovarianceNames = {"c_xx", "c_yx", "c_zx", "c_xy", "c_yy",
                                                   "c_zy", "c_xz", "c_yz", "c_zz"};

CsvRowWriter CycleRow(size_t number, const LoggedCycle& logged, const ControlLawOptions& law) {
  const ServoCycle& cycle = logged.cycle;
  const ServoStep& step = cycle.output.step;
  CsvRowWriter row;
  row.Add("cycle", static_cast<double>(number));
  row.Add("time_s", cycle.input.time_s);
  row.Add("readings_time_s", cycle.input.readings.time_s);
  row.AddAll(ByLegNames("q", "m"), cycle.input.readings.joint_readings_m);
  row.Add("image_time_s", cycle.input.seen.time_s);
  row.Add("edges", static_cast<double>(cycle.input.seen.edges.size()));
  row.AddAll(ByLegNames("v", "m_per_s"), cycle.output.joint_speeds_m_per_s);
  row.Add("status", std::string(ToString(cycle.output.verdict.end)));
  row.Add("waiting", cycle.output.verdict.is_waiting ? 1.0 : 0.0);
  row.Add("error", step.law.error);
  row.Add("tolerance", cycle.output.verdict.tolerance);
  row.Add("edge_error_px", step.law.edge_error_px);
  row.Add("direction_error_rad", step.law.direction_error_rad);
  row.Add("gain_per_s", step.gain_per_s);
  row.Add("smallest_singular_value", step.law.singular_values[5]);
  row.Add("motion_sigma_m", step.law.motion_sigma_m);
  row.Add("conditioning", step.law.Conditioning());
  row.Add("robot_conditioning", step.law.robot_conditioning);
  row.Add("speed_factor", step.speed_factor);
  row.Add("singularity_factor", step.singularity_factor);
  row.AddAll(PoseNames(""), CoordinatesOf(step.law.base_from_platform));
  if (logged.true_base_from_platform)
    row.AddAll(PoseNames("true_"), CoordinatesOf(*logged.true_base_from_platform));
  else
    row.AddNone(PoseNames("true_"));
  row.Add("look_s", cycle.look_s);
  row.Add("law_s", cycle.law_s);
  row.Add("limits", DescribeLimits(step));
  row.Add("reason", cycle.output.verdict.reason + WhyNoSpeeds(step, law));
  return row;
}

CsvRowWriter EdgeRow(size_t number, const SeenEdge& edge) {
  CsvRowWriter row;
  row.Add("cycle", static_cast<double>(number));
  row.Add("leg", edge.leg + 1.0);
  row.Add("edge", edge.edge + 1.0);
  row.AddAll({"n_x", "n_y", "n_z"}, edge.normal);
  row.AddAll(kCovarianceNames, Eigen::Map<const Eigen::Matrix<double, 9, 1>>(edge.normal_covariance.data()));
  row.AddAll({"begin_x", "begin_y"}, edge.ends[0]);
  row.AddAll({"end_x", "end_y"}, edge.ends[1]);
  return row;
}

std::string CyclesHead(const ControlLawOptions& law) {
  return fmt::format(
             "# legible servo, schema {}: one row a cycle. Units by the columns' names; `error` and "
             "`tolerance` in {}.\n"
             "# time_s: of the command, by the rig's clock; q: joint readings; v: commanded joint speeds;\n"
             "# x .. rz: base_from_platform by the readings, rotation vector; true_: as a simulated rig\n"
             "# knows it, in the model's frames;\n"
             "# smallest_singular_value: of the interaction matrix as the law weighs it, 1/m;\n"
             "# motion_sigma: of the platform's motion that one image tells worst, rotations by its radius;\n"
             "# look_s, law_s: computing times; reason: why it ended or waits.\n",
             kServoLogSchema, UnitOf(law.mode)) +
         CycleRow(0, {}, law).header() + "\n";
}

std::string EdgesHead() {
  return fmt::format(
             "# legible servo, schema {}: one row for each edge seen in a cycle. n: outline normal in "
             "the camera frame,\n"
             "# unit, away from the leg; c: its covariance; begin, end: the stretch seen, normalised "
             "image coordinates\n"
             "# without distortion. Legs and edges count from 1.\n",
             kServoLogSchema) +
         EdgeRow(0, {}).header() + "\n";
}

// ---- Reading

double NumberOf(const std::filesystem::path& file, const CsvRow& row, size_t column) {
  const std::string_view field = row.fields[column];
  if (field == "nan" || field == "-nan") return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = ParseFinite(field);
  if (!value) throw InputError(file, row.line, fmt::format("\"{}\" is no number", field), kMend);
  return *value;
}

template <typename Vector>
void Fill(const std::filesystem::path& file, const CsvRow& row, size_t first, Vector& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values.data()[i] = NumberOf(file, row, first + static_cast<size_t>(i));
}

std::vector<std::string> Columns(const std::string& header) {
  const std::vector<CsvRow> rows = SplitCsv(header);
  return {rows[0].fields.begin(), rows[0].fields.end()};
}

// The text of a table; of a log that is cut off, without a last line that was half written.
std::string ReadTable(const std::filesystem::path& file, RecordedServo& recorded) {
  std::string text = ReadTextFile(file);
  if (!recorded.is_cut_off || text.empty() || text.back() == '\n') return text;
  recorded.is_torn = true;
  text.resize(text.rfind('\n') + 1);  // to nothing, where there is no line at all
  return text;
}

void ReadCycles(const std::filesystem::path& file, RecordedServo& recorded) {
  CsvColumns columns;
  columns.required = {"cycle", "time_s", "readings_time_s", "image_time_s", "status"};
  for (const auto& names : {ByLegNames("q", "m"), ByLegNames("v", "m_per_s")})
    columns.required.insert(columns.required.end(), names.begin(), names.end());
  for (const std::string& name : Columns(CycleRow(0, {}, {}).header()))
    if (std::find(columns.required.begin(), columns.required.end(), name) == columns.required.end())
      columns.optional.push_back(name);
  const std::string text = ReadTable(file, recorded);
  std::vector<RecordedCycle>& cycles = recorded.cycles;
  for (const CsvRow& row : ArrangeCsv(file, SplitCsv(text), columns)) {
    if (NumberOf(file, row, 0) != static_cast<double>(cycles.size()))
      throw InputError(file, row.line, fmt::format("cycle {} is missing", cycles.size()), kMend);
    RecordedCycle cycle;
    cycle.input.time_s = NumberOf(file, row, 1);
    cycle.input.readings.time_s = NumberOf(file, row, 2);
    cycle.input.seen.time_s = NumberOf(file, row, 3);
    cycle.end = std::string(row.fields[4]);
    Fill(file, row, 5, cycle.input.readings.joint_readings_m);
    Fill(file, row, 5 + kLegCount, cycle.joint_speeds_m_per_s);
    cycles.push_back(cycle);
  }
}

bool IsCount(double number, double lowest, double highest) {
  return number >= lowest && number <= highest && number == std::floor(number);
}

void ReadEdges(const std::filesystem::path& file, RecordedServo& recorded) {
  const std::string text = ReadTable(file, recorded);
  const std::vector<CsvRow> rows = SplitCsv(text);
  if (rows.empty()) return;  // no edge was seen
  const auto cycles = static_cast<double>(recorded.cycles.size());
  for (const CsvRow& row : ArrangeCsv(file, rows, {Columns(EdgeRow(0, {}).header()), {}})) {
    const double number = NumberOf(file, row, 0), leg = NumberOf(file, row, 1), edge = NumberOf(file, row, 2);
    if (recorded.is_cut_off && number == cycles) {  // edges are written before their cycle
      recorded.is_torn = true;
      continue;
    }
    const bool is_known = IsCount(number, 0, cycles - 1) && IsCount(leg, 1, kLegCount) && IsCount(edge, 1, 2);
    if (!is_known) throw InputError(file, row.line, "names a cycle, leg or edge that is not there", kMend);
    SeenEdge seen;
    seen.leg = static_cast<int>(leg) - 1;
    seen.edge = static_cast<int>(edge) - 1;
    Fill(file, row, 3, seen.normal);
    Fill(file, row, 6, seen.normal_covariance);
    Fill(file, row, 15, seen.ends[0]);
    Fill(file, row, 17, seen.ends[1]);
    recorded.cycles[static_cast<size_t>(number)].input.seen.edges.push_back(seen);
  }
}

// What `read` makes of the document in a file; whatever it finds wrong is bad input.
template <typename F>
auto ReadDocument(const std::filesystem::path& file, const std::string& what, const F& read) {
  const std::string text = ReadTextFile(file);
  try {
    return read(nlohmann::ordered_json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, 0, fmt::format("is no {} of a servo: {}", what, error.what()), kMend);
  } catch (const std::invalid_argument& error) {
    throw InputError(file, 0, fmt::format("is no {} of a servo: {}", what, error.what()), kMend);
  }
}

ServoSetup ReadSetup(const std::filesystem::path& file) {
  return ReadDocument(file, "set-up", SetupFromJson);
}

void ReadResult(const std::filesystem::path& file, RecordedServo& recorded) {
  const int cycles = ReadDocument(file, "result", [&recorded](const nlohmann::ordered_json& document) {
    recorded.end = document.at("status").get<std::string>();
    recorded.reason = document.at("reason").get<std::string>();
    return document.at("iterations").get<int>();
  });
  if (static_cast<size_t>(cycles) != recorded.cycles.size())
    throw InputError(
        file, 0, fmt::format("has {} iterations, and cycles.csv {}", cycles, recorded.cycles.size()), kMend);
}

}  // namespace

void ServoLogWriter::GrowingFile::Append(const std::string& text) {
  stream << text << std::flush;
  if (!stream) throw InputError(path, 0, "cannot be written", "see that there is room");
}

ServoLogWriter::ServoLogWriter(const std::filesystem::path& folder, const ServoSetup& setup)
    : law_(setup.options.step.law),
      cycles_{folder / "cycles.csv", std::ofstream(folder / "cycles.csv", std::ios::binary)},
      edges_{folder / "edges.csv", std::ofstream(folder / "edges.csv", std::ios::binary)} {
  cycles_.Append(CyclesHead(law_));
  edges_.Append(EdgesHead());
  WriteFileAtomically(folder / "setup.json", JsonText(SetupToJson(setup)));
}

// The edges first: a cycle that is there has all of its own.
void ServoLogWriter::Add(const LoggedCycle& logged) {
  std::string edges;
  for (const SeenEdge& edge : logged.cycle.input.seen.edges) edges += EdgeRow(count_, edge).row() + "\n";
  edges_.Append(edges);
  cycles_.Append(CycleRow(count_, logged, law_).row() + "\n");
  ++count_;
}

std::vector<std::filesystem::path> UnfinishedLogs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> logs;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().filename().string().starts_with(kUnfinishedLog) && IsServoLog(entry.path()))
      logs.push_back(entry.path());
  std::sort(logs.begin(), logs.end(), [](const auto& a, const auto& b) {  // 10 after 9
    return std::pair(a.native().size(), a) < std::pair(b.native().size(), b);
  });
  return logs;
}

bool IsServoLog(const std::filesystem::path& folder) {
  try {
    ReadSetup(folder / "setup.json");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

RecordedServo ReadServoLog(const std::filesystem::path& folder) {
  RecordedServo recorded;
  recorded.setup = ReadSetup(folder / "setup.json");
  recorded.is_cut_off = !std::filesystem::exists(folder / "result.json");
  ReadCycles(folder / "cycles.csv", recorded);
  ReadEdges(folder / "edges.csv", recorded);
  if (!recorded.is_cut_off) ReadResult(folder / "result.json", recorded);
  return recorded;
}

}  // namespace legible
