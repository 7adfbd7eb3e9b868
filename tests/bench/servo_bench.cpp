// Time from features to command and from image to command, beside ViSP's moving edges and vpServo.
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "core/rig/scene_camera.h"
#include "core/rig/simulated_edges.h"
#include "core/rig/simulated_rig.h"
#include "core/vision/edge_tracker.h"
#include "core/vision/leg_edges.h"
#include "servo/servo_controller.h"
#include "servo/servo_loop.h"
#include "tests/bench/bench_table.h"
#include "tests/bench/cpu_time.h"
#include "tests/bench/visp_servo.h"
#include "tests/testing/hexapod_view.h"

namespace legible {
namespace {

constexpr double kGain_per_s = 2;

// ---- From features to command: what servos of a simulated rig are given, over again.

constexpr int kRuns = 40;

// All that a cycle of a servo needs, as it came up in a run.
struct Recorded {
  ServoModel model;
  ServoGoal goal;
  std::vector<CycleInput> cycles;
};

// From home to somewhere near; legs may hide each other on the way.
Recorded RecordRun(std::mt19937_64& generator) {
  const GoughStewart robot = DesktopHexapod();
  const Camera camera = DesktopCamera(false);
  const Rigid3 camera_from_base = SyntheticOptions().camera_from_base;
  Recorded recorded{MakeServoModel(robot, camera, camera_from_base), {}, {}};
  recorded.goal = GoalAtPose(recorded.model, Nearby(robot.home, 0.025, generator));
  SimulatedRig rig({robot, camera, camera_from_base}, SimulationOptions());
  SimulatedEdges source(rig);
  ServoController controller(recorded.model, recorded.goal, ServoOptions());
  RunServo(rig, source, controller, ServoLoopOptions(),
           [&](const ServoCycle& cycle) { recorded.cycles.push_back(cycle.input); });
  return recorded;
}

BenchTable::Row TimeRow(const std::string& label, const std::vector<double>& times_s, double unit_s,
                        const std::string& unit) {
  return {label,
          {{"median_" + unit, QuantileOf(times_s, 0.5) / unit_s},
           {"p90_" + unit, QuantileOf(times_s, 0.9) / unit_s},
           {"p99_" + unit, QuantileOf(times_s, 0.99) / unit_s},
           {"cycles", static_cast<double>(times_s.size())}}};
}

// A whole cycle of the controller: law, limits, supervisor.
BenchTable::Row OwnLawRow(const std::string& label, const std::vector<Recorded>& runs,
                          const ControlLawOptions& law) {
  ServoOptions options;
  options.step.law = law;
  options.step.gain = AdaptiveGain::Constant(kGain_per_s);
  std::vector<double> times_s;
  for (const Recorded& run : runs) {
    ServoController controller(run.model, run.goal, options);
    for (const CycleInput& input : run.cycles) {
      const double before_s = CpuTime_s();
      const CycleOutput output = controller.Cycle(input);
      times_s.push_back(CpuTime_s() - before_s);
      if (output.verdict.end != ServoEnd::kRunning) break;
    }
  }
  return TimeRow(label, times_s, 1e-6, "us");
}

// Directions of all legs: of both their edges.
LegDirections DirectionsOf(const SeenEdges& seen) {
  LegDirections directions;
  const EdgesByLeg edges = ByLeg(seen);
  for (size_t leg = 0; leg < kLegCount; ++leg)
    directions.col(static_cast<Eigen::Index>(leg)) =
        DirectionFromEdges(edges[leg][0]->normal, edges[leg][1]->normal);
  return directions;
}

// The same features in vpServo: no limits, no supervisor.
BenchTable::Row VispLawRow(const std::string& label, const std::vector<Recorded>& runs) {
  std::vector<double> times_s;
  for (const Recorded& run : runs) {
    VispServo visp(run.model, run.goal, kGain_per_s);
    for (const CycleInput& input : run.cycles) {
      if (input.seen.edges.size() != 2 * kLegCount) continue;
      const double before_s = CpuTime_s();
      visp.Speeds(input.seen, DirectionsOf(input.seen),
                  LegLengths(run.model.robot, input.readings.joint_readings_m));
      times_s.push_back(CpuTime_s() - before_s);
    }
  }
  return TimeRow(label, times_s, 1e-6, "us");
}

BenchTable FeaturesToCommand() {
  std::mt19937_64 generator(1);
  std::vector<Recorded> runs;
  runs.reserve(kRuns);
  for (int run = 0; run < kRuns; ++run) runs.push_back(RecordRun(generator));
  const auto law = [](ControlMode mode, bool is_weighted) {
    ControlLawOptions options;
    options.mode = mode;
    options.is_weighted = is_weighted;
    return options;
  };
  ControlLawOptions pose_of_edges = law(ControlMode::kPose, true);
  pose_of_edges.pose_source = PoseSource::kEdges;
  return {"from features to command, processor time (bar: 20 us)",
          {OwnLawRow("edges", runs, law(ControlMode::kEdges, true)),
           OwnLawRow("edges, all alike", runs, law(ControlMode::kEdges, false)),
           OwnLawRow("directions", runs, law(ControlMode::kDirections, true)),
           OwnLawRow("pose by readings", runs, law(ControlMode::kPose, true)),
           OwnLawRow("pose by edges", runs, pose_of_edges),
           OwnLawRow("joints", runs, law(ControlMode::kJoints, true)),
           VispLawRow("ViSP vpServo, twelve edges", runs)}};
}

// ---- From image to command: a robot that moves slowly, about half a pixel from frame to frame.

constexpr int kFrames = 60, kPasses = 5;

struct Film {
  ServoModel model;
  ServoGoal goal;
  std::vector<Rigid3> poses;  // base_from_platform of each frame
  std::vector<GrayImage> images;

  LegsInCamera LegsAt(size_t frame) const {
    return PlaceLegs(model.robot, model.camera_from_base, poses[frame]);
  }
};

// 1280 x 960, of every edge enough in sight; by the simulated rig's camera.
Film MakeFilm() {
  const GoughStewart robot = DesktopHexapod();
  const Camera camera = DesktopCamera(false);
  const Rigid3 camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
  Film film{MakeServoModel(robot, camera, camera_from_base), {}, {}, {}};
  const SceneCamera scene({robot, camera, camera_from_base}, {}, 1);
  Vector6d per_frame;
  per_frame << 2e-4, 3e-4, 2e-4, 3e-4, -5e-4, 5e-4;
  film.goal = GoalAtPose(film.model, Displaced(robot.home, 2 * kFrames * per_frame));
  for (int frame = 0; frame < kFrames; ++frame) {
    film.poses.push_back(Displaced(robot.home, frame * per_frame));
    film.images.push_back(scene.Take(film.poses.back(), {}, static_cast<std::uint64_t>(frame)));
  }
  return film;
}

// What it makes of a film: times, and how far the edges are off the true ones at the ends of the legs (the
// root mean square of both).
struct ImageScore {
  std::vector<double> times_s, offs_px;

  void Add(const Film& film, size_t frame, const SeenEdges& seen) {
    const EdgesByLeg truth = ByLeg(EdgesOf(film.model.robot, film.model.camera_from_base, film.poses[frame]));
    for (const SeenEdge& edge : seen.edges) {
      const SeenEdge& exact = *truth[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
      double squares = 0;
      for (const Eigen::Vector2d& end : exact.ends)
        squares += std::pow(edge.normal.dot(end.homogeneous()) / edge.normal.head<2>().norm(), 2);
      offs_px.push_back(film.model.focal_px * std::sqrt(squares / 2));
    }
  }

  BenchTable::Row Row(const std::string& label) const {
    BenchTable::Row row = TimeRow(label, times_s, 1e-3, "ms");
    const auto cycles = static_cast<double>(times_s.size()), edges = static_cast<double>(offs_px.size());
    row.figures.emplace_back("edges", edges / cycles);
    row.figures.emplace_back("edge_median_px", QuantileOf(offs_px, 0.5));
    row.figures.emplace_back(
        "edge_rms_px",
        std::sqrt(std::inner_product(offs_px.begin(), offs_px.end(), offs_px.begin(), 0.0) / edges));
    return row;
  }
};

// The edges of a frame, where it is known what the frame before was like; `readings_m` are the frame's.
using Look = std::function<SeenEdges(const Film& film, size_t frame, const Vector6d& readings_m)>;

// As a servo has them: expected by the readings, corrected, checked against each other. Knows the first
// frame.
Look LookByTracker(const Film& film) {
  const ServoModel& model = film.model;
  auto tracker =
      std::make_shared<EdgeTracker>(model.robot, model.camera, model.camera_from_base, EdgeTrackerOptions());
  tracker->Track(film.images[0], 0, film.poses[0]);
  return [tracker](const Film& of, size_t frame, const Vector6d& readings_m) {
    const auto forward = ForwardKinematics(of.model.robot, readings_m, of.poses[frame - 1]);
    return tracker->Track(of.images[frame], 0.02 * static_cast<double>(frame), forward.base_from_platform)
        .seen;
  };
}

// Each image by itself, but for the prediction and the blur.
Look LookByMeasuring(const Film& /*film*/) {
  LegEdgeOptions options;
  options.lock.reset();
  options.blur_px = SceneOptions().blur_px;
  return [options](const Film& of, size_t frame, const Vector6d& /*readings_m*/) {
    const LegsInCamera before = of.LegsAt(frame == 0 ? 0 : frame - 1);
    SeenEdges seen;
    for (const LegEdge& edge : MeasureLegEdges(of.images[frame], before, of.model.camera, options).edges)
      if (edge.left_out.empty()) seen.edges.push_back(ToSeenEdge(of.model.camera, edge));
    return seen;
  };
}

BenchTable::Row OwnImageRow(const std::string& label, const Film& film,
                            const std::function<Look(const Film&)>& begin) {
  ImageScore score;
  ServoStepOptions options;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Look look = begin(film);
    for (size_t frame = 1; frame < film.images.size(); ++frame) {
      const Vector6d readings_m = InverseKinematics(film.model.robot, film.poses[frame]);
      const double before_s = CpuTime_s();
      const SeenEdges seen = look(film, frame, readings_m);
      EvaluateStep(film.model, film.goal, {seen, readings_m, Vector6d::Zero(), film.poses[frame - 1]},
                   options);
      score.times_s.push_back(CpuTime_s() - before_s);
      score.Add(film, frame, seen);
    }
  }
  return score.Row(label);
}

// The true edges of a frame, between the ends of stretches that were in sight.
SeenEdges KnownEdges(const Film& film, size_t frame, const SeenEdges& in_sight) {
  EdgesByLeg stretches = ByLeg(in_sight);
  SeenEdges known = EdgesOf(film.model.robot, film.model.camera_from_base, film.poses[frame]);
  for (SeenEdge& edge : known.edges)
    edge.ends = stretches[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)].value().ends;
  return known;
}

// vpMeLine, begun where the first image shows the edges.
BenchTable::Row VispImageRow(const std::string& label, const Film& film) {
  ImageScore score;
  const SeenEdges in_sight = LookByMeasuring(film)(film, 0, Vector6d::Zero());
  int lost = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    VispEdges edges(film.model);
    VispServo servo(film.model, film.goal, kGain_per_s);
    edges.Load(film.images[0].pixels.data());
    edges.Start(KnownEdges(film, 0, in_sight));
    for (size_t frame = 1; frame < film.images.size(); ++frame) {
      edges.Load(film.images[frame].pixels.data());
      const SeenEdges known = KnownEdges(film, frame, in_sight);
      const Vector6d lengths_m =
          LegLengths(film.model.robot, InverseKinematics(film.model.robot, film.poses[frame]));
      const double before_s = CpuTime_s();
      const SeenEdges seen = edges.Track(known);
      servo.Speeds(seen, DirectionsOf(seen), lengths_m);
      score.times_s.push_back(CpuTime_s() - before_s);
      score.Add(film, frame, seen);
    }
    lost += edges.lost();
  }
  BenchTable::Row row = score.Row(label);
  row.label += ", " + std::to_string(lost) + " lines lost";
  return row;
}

BenchTable ImageToCommand() {
  const Film film = MakeFilm();
  return {"from image to command, 1280 x 960, one core, processor time (bar: 5 ms at p99)",
          {OwnImageRow("EdgeTracker, edge law", film, LookByTracker),
           OwnImageRow("MeasureLegEdges, edge law", film, LookByMeasuring),
           VispImageRow("ViSP vpMeLine, vpServo", film)}};
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) {
  return legible::Report({legible::FeaturesToCommand(), legible::ImageToCommand()}, argc, argv);
}
