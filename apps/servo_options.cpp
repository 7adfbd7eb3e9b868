#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/option_checks.h"
#include "apps/option_values.h"
#include "apps/servo_command.h"
#include "servo/servo_loop.h"

namespace legible {
namespace {

constexpr char kDescription[] = "Drive a robot to a goal by the edges of its legs";
constexpr char kFooter[] =
    R"(MODEL is the model.yaml of `legible calibrate`; a robot.yaml will do together with --camera.

The goal is a pose, joint readings, or an image that the camera took with the robot at the goal: then no pose
has to be known. The robot stops, and says why, when it has arrived and when it must not go on: the error grows
or no longer falls, too few edges are seen, a singularity or the end of a joint's range is near, images or
readings are missing, old or frozen, the link is lost, the time is up, or ctrl-C.

Written to the folder of --log:
  result.json  status, reason, errors, times
  setup.json   model, goal and options
  cycles.csv   each cycle: readings, errors, commands, limits
  edges.csv    each edge of each cycle
  frames/      each image, with --keep-images
  report.html  all that to look at
The log grows in a folder unfinished-1 in there, and takes the place of an earlier one at the end. If the program
is killed it stays as it is, and `legible replay` reads it.

Exit codes:
  0  converged
  1  stopped before; says why
  2  bad usage or bad input; one line says what; nothing has moved, nothing is written

Examples:
  legible servo result/model.yaml --rig sim:truth.yaml --goal-pose "0.01 0 0.35 0 0.1 0"
  legible servo result/model.yaml --rig sim:truth.yaml --goal-image goal.png --mode edges --gain 6:2:300
  legible servo result/model.yaml --rig sim:truth.yaml --goal-joints "0.38 0.38 0.4 0.4 0.38 0.38" --mode joints)";

void AddGoalOptions(CLI::App& command, ServoSettings& settings) {
  AddText(
      command, "--goal-pose", "\"X Y Z RX RY RZ\"",
      [&settings](const std::string& text) { settings.goal.pose = ParsePose(text); },
      "Pose of the platform in base, m and a rotation vector\nin rad");
  AddText(
      command, "--goal-joints", "\"Q1 ... Q6\"",
      [&settings](const std::string& text) { settings.goal.joints_m = ParseSix(text, "joint readings"); },
      "Joint readings, m; with --goal-image those at which it\nwas taken, if they are known: where to look "
      "for the legs");
  command
      .add_option("--goal-image", settings.goal.image, "Image of the robot at the goal, by the same camera")
      ->type_name("FILE");
}

void AddLawOptions(CLI::App& command, ServoSettings& settings) {
  ControlLawOptions& law = settings.options.step.law;
  AddText(
      command, "--mode", "edges|directions|pose|joints",
      [&law](const std::string& name) {
        for (const ControlMode mode :
             {ControlMode::kEdges, ControlMode::kDirections, ControlMode::kPose, ControlMode::kJoints})
          if (name == ToString(mode)) {
            law.mode = mode;
            return;
          }
        throw std::invalid_argument("\"" + name + "\" is none of edges, directions, pose, joints");
      },
      "What is led to the goal: the legs' edges in the image,\ntheir directions, the pose, or the joint "
      "readings;\nedges without it");
  AddText(
      command, "--pose-from", "readings|edges",
      [&law](const std::string& name) {
        if (name != "readings" && name != "edges")
          throw std::invalid_argument("\"" + name + "\" is neither readings nor edges");
        law.pose_source = name == "edges" ? PoseSource::kEdges : PoseSource::kReadings;
      },
      "Where --mode pose has the pose from: joint readings by\nforward kinematics, or a fit to the edges");
  AddText(
      command, "--directions-from", "edges|model",
      [&law](const std::string& name) {
        if (name != "model" && name != "edges")
          throw std::invalid_argument("\"" + name + "\" is neither edges nor model");
        law.direction_source = name == "edges" ? DirectionSource::kEdges : DirectionSource::kModel;
      },
      "Where the interaction matrices have the legs'\ndirections from: both edges of each leg, as Andreff "
      "et\nal. do, or joint readings by the model; model without it");
  AddText(
      command, "--legs", "N,N,...|auto",
      [&settings, &law](const std::string& text) {
        settings.chooses_legs = text == "auto";
        if (settings.chooses_legs) return;
        law.legs.reset();
        for (const int leg : ParseLegs(text)) law.legs.set(static_cast<size_t>(leg));
      },
      "Legs that are looked at, counted from 1; auto: those\nthat lead to the goal most accurately, as "
      "`legible "
      "legs`\nfinds them; all without it");
  command.add_flag_callback(
      "--unweighted", [&law] { law.is_weighted = false; },
      "All edges count alike, not each by its covariance");
  AddText(
      command, "--damping", "SHARE",
      [&law](const std::string& text) { law.inverse.damping = ParsePositive(text); },
      "Damps the pseudo-inverse: a share of its largest\nsingular value");
  AddText(
      command, "--truncation", "SHARE",
      [&law](const std::string& text) { law.inverse.truncation = ParsePositive(text); },
      "Leaves out what has a smaller singular value than this\nshare of the largest; what is seen has to be "
      "certain\nenough all the same");
}

void AddCertaintyOptions(CLI::App& command, ControlLawOptions& law) {
  AddText(
      command, "--most-motion-sigma", "RADII",
      [&law](const std::string& text) { law.most_motion_sigma = ParsePositive(text); },
      fmt::format(
          "Stops where the noise of one image leaves some motion\nof the platform less certain than this "
          "part of its\nradius; {:g} without it",
          law.most_motion_sigma));
  AddText(
      command, "--least-conditioning", "RATIO",
      [&law](const std::string& text) {
        law.least_conditioning = ParsePositive(text);
        law.Check();
      },
      fmt::format("Stops where what is seen tells some motion of the\nplatform less than this share of the "
                  "best told one; {:g} without it",
                  law.least_conditioning));
}

void AddMotionOptions(CLI::App& command, ServoSettings& settings) {
  ServoStepOptions& step = settings.options.step;
  SupervisorOptions& supervision = settings.options.supervision;
  AddText(
      command, "--gain", "GAIN|ZERO:FAR:SLOPE",
      [&step](const std::string& text) { step.gain = ParseGain(text); },
      "1/s; or adaptive: the gain at the goal, that from afar,\nand how fast it falls by m to go; 4:2:400 "
      "without it");
  const auto add_positive = [&command](const std::string& name, const std::string& unit, double& value,
                                       const std::string& description) {
    AddText(
        command, name, unit, [&value](const std::string& text) { value = ParsePositive(text); },
        fmt::format("{}; {:g} without it", description, value));
  };
  add_positive("--speed-limit", "M/S", step.limits.speed_limit_m_per_s, "No joint goes faster, m/s");
  add_positive("--range-margin", "M", step.limits.range_margin_m,
               "What joints keep from the ends of their ranges, m");
  add_positive("--timeout", "S", supervision.timeout_s, "Stops after so long, s");
  add_positive("--period", "S", settings.period_s,
               fmt::format("From command to command, s, {:g} at most", ServoLoopOptions::kLongestPeriod_s));
  AddText(
      command, "--tolerance", "ERROR",
      [&supervision](const std::string& text) {
        supervision.tolerance = ParsePositive(text);
        supervision.tolerance_in_noise = 0;
      },
      "Converged when the error of the mode stays below: px of\nedges, rad of directions, m of poses and "
      "joints. Without\nit 0.1 px, 2e-3 rad, 1e-4 m, 5e-5 m, or where the error\nno longer falls and is what "
      "the noise of the edges leaves");
}

void AddRigOptions(CLI::App& command, ServoSettings& settings) {
  command.add_option("MODEL", settings.model, "The model that the law uses")->required()->type_name("");
  command.add_option("--rig", settings.rig, "The robot: sim:TRUTH, a simulated one, TRUTH its\nmodel.yaml")
      ->required()
      ->type_name("sim:TRUTH");
  command
      .add_option("--camera", settings.camera,
                  "camera.yaml with camera_from_base, for a MODEL that\nhas no camera")
      ->type_name("FILE");
  command.add_flag(
      "--image-free", settings.is_image_free,
      "A simulated rig gives edges with noise directly,\nwithout images: a hundred times faster");
  command.add_option("--log", settings.log, "Folder for the log and the report")
      ->check([](const std::string& text) { return text.empty() ? "name a folder" : std::string(); })
      ->type_name("DIR")
      ->capture_default_str();
  command.add_flag("--keep-images", settings.keeps_images, "Keep every image in the log");
  AddTableOrJson(command, settings.prints_json,
                 "What goes to standard output: lines for people, or the\ntext of result.json");
}

void DemandOneGoal(const GoalSetting& goal) {
  const int given = goal.pose.has_value() + goal.image.has_value() + (goal.joints_m && !goal.image);
  if (given == 0)
    throw CLI::ValidationError("--goal-pose", "no goal: give --goal-pose, --goal-joints or --goal-image");
  if (given > 1) throw CLI::ValidationError("--goal-pose", "give one goal");
}

}  // namespace

const CLI::App* AddServoCommand(CLI::App& program, ServoSettings& settings) {
  CLI::App* command = program.add_subcommand("servo", kDescription)->group("Commands");
  command->footer(kFooter);
  AddRigOptions(*command, settings);
  AddGoalOptions(*command, settings);
  AddLawOptions(*command, settings);
  AddCertaintyOptions(*command, settings.options.step.law);
  AddMotionOptions(*command, settings);
  command->final_callback([&settings] { DemandOneGoal(settings.goal); });
  return command;
}

}  // namespace legible
