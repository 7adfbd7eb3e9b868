// Section 4 of Andreff, Dallej and Martinet 2007 again, and what calibration buys there. Writes tables
// (Markdown) and curves (JSON) into the folder that it is given. The same figures whatever the number of
// threads.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "tests/reproduction/lab_curves.h"
#include "tests/reproduction/lab_table.h"

namespace legible {
namespace {

constexpr int kRuns = 100;

// ---- Without noise: section 4.2, figure 5.

constexpr double kPerfectDuration_s = 8, kFitFrom_s = 1;

struct PerfectRun {
  std::string name;
  LabServo servo;
  LabRun run;
};

PerfectRun RunPerfect(ControlMode mode) {
  PerfectRun perfect{ToString(mode), PerfectServo(mode, kPerfectDuration_s), {}};
  perfect.run = RunInLab(perfect.servo);
  return perfect;
}

std::string PerfectRow(const PerfectRun& perfect) {
  std::string row = fmt::format("| {} |", perfect.name);
  for (double LabMoment::*error : {&LabMoment::edge_error_px, &LabMoment::direction_error_rad}) {
    const Decay decay = FitDecay(perfect.run, error, kFitFrom_s, kPerfectDuration_s);
    row += fmt::format(" {:.4f} ({:.1f} %) |", decay.rate_per_s, 100 * decay.rms_log);
  }
  double aside_m = 0;
  std::vector<Eigen::Vector3d> places_m;
  for (const LabMoment& moment : perfect.run.moments) {
    places_m.push_back(moment.true_base_from_platform.translation);
    aside_m = std::max(aside_m, std::abs(places_m.back().y()));
  }
  const PathShape shape = ShapeOfPath(places_m, perfect.servo.true_goal.translation);
  return row + fmt::format(" {:.0e} | {:.1f} | {:.2f} |\n", aside_m, 1e3 * shape.length_m,
                           100 * shape.deviation_m / shape.length_m);
}

std::string PerfectTable(const std::vector<PerfectRun>& runs) {
  std::string table =
      "| law | edge error falls, 1/s (off an exponential) | direction error falls, 1/s | off the symmetry "
      "plane, m | path, mm | off a straight line, % |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const PerfectRun& run : runs) table += PerfectRow(run);
  return table;
}

// ---- With noise, friction and an approximate model: section 4.3, figures 6 to 8.

struct NamedLaw {
  std::string name;
  ControlLawOptions options;
};

ControlLawOptions Law(ControlMode mode, DirectionSource source, bool is_weighted) {
  ControlLawOptions law = PaperLaw(mode);
  law.direction_source = source;
  law.is_weighted = is_weighted;
  return law;
}

ControlLawOptions PoseLaw(PoseSource source) {
  ControlLawOptions law;
  law.mode = ControlMode::kPose;
  law.pose_source = source;
  return law;
}

enum class Belief { kDrawing, kCalibrated, kTruth };

// One row of a table before it is run.
struct Plan {
  std::string label;
  Belief belief = Belief::kDrawing;
  LabCase lab_case;
};

struct Rigs {
  std::vector<LabRig> rigs;
  std::vector<SimulationTruth> calibrated;
};

Rigs DrawRigs() {
  Rigs all{std::vector<LabRig>(kRuns), std::vector<SimulationTruth>(kRuns)};
  tbb::parallel_for(0, kRuns, [&](int i) {
    const auto at = static_cast<size_t>(i);
    all.rigs[at] = DrawLabRig(at + 1);
    all.calibrated[at] = Calibrated(all.rigs[at]);
  });
  return all;
}

LabServo ServoOf(const Plan& plan, const Rigs& rigs, size_t at) {
  const LabRig& rig = rigs.rigs[at];
  const SimulationTruth& model = plan.belief == Belief::kDrawing      ? rig.nominal
                                 : plan.belief == Belief::kCalibrated ? rigs.calibrated[at]
                                                                      : rig.truth;
  return RoughLabServo(rig, model, plan.lab_case, at + 1);
}

std::vector<LabRow> RunPlans(const std::vector<Plan>& plans, const Rigs& rigs) {
  std::vector<LabRow> rows;
  rows.reserve(plans.size());
  for (const Plan& plan : plans) rows.push_back({plan.label, std::vector<LabOutcome>(kRuns)});
  tbb::parallel_for(0, kRuns, [&](int i) {
    const auto at = static_cast<size_t>(i);
    for (size_t row = 0; row < plans.size(); ++row) {
      rows[row].outcomes[at] = RunCase(ServoOf(plans[row], rigs, at));
    }
  });
  return rows;
}

std::vector<Plan> NoisyPlans(double edge_noise_px) {
  const auto kSeen = DirectionSource::kEdges, kModel = DirectionSource::kModel;
  const auto kEdges = ControlMode::kEdges, kDirections = ControlMode::kDirections;
  std::vector<Plan> plans;
  const auto add = [&](const std::string& label, const ControlLawOptions& law) {
    Plan plan{label, Belief::kDrawing, {}};
    plan.lab_case.law = law;
    plan.lab_case.edge_noise_px = plan.lab_case.goal_noise_px = edge_noise_px;
    plans.push_back(plan);
  };
  add("directions, as in the paper", PaperLaw(kDirections));
  add("edges, as in the paper", PaperLaw(kEdges));
  add("directions, interaction by the model's", Law(kDirections, kModel, false));
  add("edges, interaction by the model's directions", Law(kEdges, kModel, false));
  add("directions, as in the paper but weighted", Law(kDirections, kSeen, true));
  add("edges, as in the paper but weighted", Law(kEdges, kSeen, true));
  add("directions, both", Law(kDirections, kModel, true));
  add("edges, both", Law(kEdges, kModel, true));
  return plans;
}

// Both laws of the paper with one disturbance less at a time; nothing ends them but the time.
std::vector<Plan> LimitPlans() {
  std::vector<Plan> plans;
  for (const ControlMode mode : {ControlMode::kDirections, ControlMode::kEdges}) {
    Plan plan{fmt::format("{}, all of them", ToString(mode)), Belief::kDrawing, {}};
    plan.lab_case.law = PaperLaw(mode);
    plan.lab_case.unsupervised_s = 15;
    plans.push_back(plan);
    Plan less = plan;
    less.label = fmt::format("{}, without friction", ToString(mode));
    less.lab_case.has_friction = false;
    plans.push_back(less);
    less = plan;
    less.label = fmt::format("{}, perfect model", ToString(mode));
    less.belief = Belief::kTruth;
    plans.push_back(less);
    less = plan;
    less.label = fmt::format("{}, goal without noise", ToString(mode));
    less.lab_case.goal_noise_px = 0;
    plans.push_back(less);
    less.label = fmt::format("{}, noise of 0.001 px in both", ToString(mode));
    less.lab_case.edge_noise_px = less.lab_case.goal_noise_px = 1e-3;
    plans.push_back(less);
  }
  return plans;
}

std::string RatioText(const std::vector<LabRow>& rows) {
  const auto ratio = [&](double LabOutcome::*field) {
    return MedianOf(rows[0], field) / MedianOf(rows[1], field);
  };
  return fmt::format(
      "\nDirections over edges as in the paper, ratio of the medians: position {:.1f}, rotation {:.1f}, "
      "edges {:.1f}.\n",
      ratio(&LabOutcome::position_m), ratio(&LabOutcome::rotation_rad), ratio(&LabOutcome::edge_error_px));
}

// The curves of one rig; nothing ends them but the time.
nlohmann::json NoisyCurves(ControlMode mode, const Rigs& rigs) {
  Plan plan;
  plan.lab_case.law = PaperLaw(mode);
  plan.lab_case.edge_noise_px = plan.lab_case.goal_noise_px = 0.1;
  plan.lab_case.unsupervised_s = 10;
  const LabServo servo = ServoOf(plan, rigs, 0);
  return ErrorCurves(servo, RunInLab(servo));
}

// ---- The drawing against a calibrated model.

std::vector<Plan> CalibrationPlans() {
  constexpr double kNoise_px = 0.05;
  const ControlLawOptions edges = Law(ControlMode::kEdges, DirectionSource::kModel, true),
                          directions = Law(ControlMode::kDirections, DirectionSource::kModel, true);
  std::vector<Plan> plans;
  const auto add = [&](const std::string& label, const ControlLawOptions& law, GoalKind goal) {
    LabCase lab_case;
    lab_case.law = law;
    lab_case.goal = goal;
    lab_case.edge_noise_px = lab_case.goal_noise_px = kNoise_px;
    plans.push_back({label + "; drawing", Belief::kDrawing, lab_case});
    plans.push_back({label + "; calibrated", Belief::kCalibrated, lab_case});
  };
  add("pose as goal, joints by forward kinematics", PoseLaw(PoseSource::kReadings), GoalKind::kPose);
  add("pose as goal, pose by the edges", PoseLaw(PoseSource::kEdges), GoalKind::kPose);
  add("pose as goal, edges", edges, GoalKind::kPose);
  add("pose as goal, directions", directions, GoalKind::kPose);
  add("image as goal, pose by the edges", PoseLaw(PoseSource::kEdges), GoalKind::kImage);
  add("image as goal, edges", edges, GoalKind::kImage);
  add("image as goal, directions", directions, GoalKind::kImage);
  return plans;
}

// ---- All of it.

void Write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

class Writer {
 public:
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
  }
  void Table(const std::string& name, const std::string& title, const std::string& text) const {
    Write(folder_ / (name + ".md"), text);
    std::cout << "\n## " << title << "\n\n" << text << std::flush;
  }
  void Json(const std::string& name, const nlohmann::json& json) const {
    Write(folder_ / (name + ".json"), json.dump(1) + "\n");
  }

 private:
  std::filesystem::path folder_;
};

void ReproducePerfect(const Writer& writer) {
  const std::vector<PerfectRun> runs = {RunPerfect(ControlMode::kDirections),
                                        RunPerfect(ControlMode::kEdges)};
  writer.Table("perfect", "Without noise, perfect model", PerfectTable(runs));
  nlohmann::json paths;
  for (const PerfectRun& run : runs) paths[run.name] = SideView(run.servo, run.run);
  writer.Json("side_view", paths);
}

void ReproduceNoisy(const Writer& writer, const Rigs& rigs) {
  writer.Json("error_curves", {{"directions", NoisyCurves(ControlMode::kDirections, rigs)},
                               {"edges", NoisyCurves(ControlMode::kEdges, rigs)}});
  for (const double noise_px : {0.3, 0.1}) {
    const std::vector<LabRow> rows = RunPlans(NoisyPlans(noise_px), rigs);
    const std::string name = fmt::format("noise_{}", noise_px);
    writer.Table(name, fmt::format("Edge noise {} px, approximate model, friction", noise_px),
                 Markdown(rows) + RatioText(rows));
    writer.Json(name, Json(rows));
  }
}

void ReproduceLimits(const Writer& writer, const Rigs& rigs) {
  const std::vector<LabRow> rows = RunPlans(LimitPlans(), rigs);
  writer.Table("limits", "One disturbance less, edge noise 0.3 px, 15 s without a supervisor",
               Markdown(rows));
  writer.Json("limits", Json(rows));
}

void ReproduceCalibration(const Writer& writer, const Rigs& rigs) {
  const std::vector<LabRow> rows = RunPlans(CalibrationPlans(), rigs);
  writer.Table("calibration", "What calibration buys", Markdown(rows));
  writer.Json("calibration", Json(rows));
}

int Main(const std::filesystem::path& folder) {
  const Writer writer(folder);
  ReproducePerfect(writer);
  const Rigs rigs = DrawRigs();
  ReproduceNoisy(writer, rigs);
  ReproduceLimits(writer, rigs);
  ReproduceCalibration(writer, rigs);
  return 0;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " FOLDER\n";
    return 2;
  }
  try {
    return legible::Main(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << '\n';
    return 1;
  }
}
