#include "apps/capture_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "apps/capture_json.h"
#include "apps/capture_run.h"
#include "apps/json_text.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/wording.h"
#include "datasets/input_error.h"

namespace legible {
namespace {

std::string Milli(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.3f} m{}", 1e3 * *value, unit) : "open";
}

// "σ of predicted poses 0.084 mm and 0.310 mrad, of the focal length 2.1 px"
std::string SigmaText(const ExpectedSigma& sigma) {
  if (!sigma.position_m && !sigma.focal_length_px) return "too few yet to determine the model";
  const std::string poses = sigma.position_m ? fmt::format("{} and {}", Milli(sigma.position_m, "m"),
                                                           Milli(sigma.rotation_rad, "rad"))
                                             : "open";
  const std::string focal = sigma.focal_length_px ? fmt::format("{:.2f} px", *sigma.focal_length_px) : "open";
  return fmt::format("expected σ of predicted poses {}, of the focal length {}", poses, focal);
}

// Lines that stay, between which one rewrites itself on a terminal.
class CaptureLines {
 public:
  explicit CaptureLines(const Console& console) : console_(console), progress_(console) {}

  void Doing(const std::string& what) { progress_.Show(what); }
  void Captured(const CapturedImage& image) {
    const std::string use = image.unusable.empty() ? "" : "; " + image.unusable;
    Keep(fmt::format("{}: {} of 12 edges{}; {}", image.name, image.edges, use, SigmaText(image.expected)));
  }
  void Rejected(const RejectedPose& pose) {
    Keep(fmt::format("legible: warning: a pose for {} is passed over: {}", pose.name, pose.reason));
  }
  void Warned(const std::string& sentence) { Keep("legible: warning: " + sentence); }
  void Clear() { progress_.Clear(); }

 private:
  void Keep(const std::string& line) {
    progress_.Clear();
    console_.err << line << std::endl;
  }

  Console console_;
  ProgressLine progress_;
};

std::string Summary(const PreparedCapture& prepared, const CaptureRun& run) {
  const std::string folder = prepared.settings.out.string();
  const int count = static_cast<int>(prepared.session->session().images.size());
  if (count == 0) return "No image was taken, and there is no session.\n";
  const std::string before =
      run.images_before > 0 ? fmt::format(", {} of them before", run.images_before) : "";
  const std::string passed =
      run.rejected.empty()
          ? ""
          : fmt::format("  {} passed over\n", Plural(static_cast<int>(run.rejected.size()), "pose"));
  return fmt::format(
      "{} in {}{}\n"
      "  {}\n"
      "{}"
      "  next: legible calibrate {}\n",
      Plural(count, "image"), folder, before, SigmaText(run.expected), passed, folder);
}

}  // namespace

int RunCapture(const CaptureSettings& settings, const Console& console) {
  return RunCapture(settings, OpenRig(settings.rig), console);
}

int RunCapture(const CaptureSettings& settings, OpenedRig rig, const Console& console) {
  PreparedCapture prepared = PrepareCapture(settings, std::move(rig));
  console.err << WarningsText(prepared.warnings);
  CaptureLines lines(console);
  const CaptureListener listener{[&](const std::string& what) { lines.Doing(what); },
                                 [&](const CapturedImage& image) { lines.Captured(image); },
                                 [&](const RejectedPose& pose) { lines.Rejected(pose); },
                                 [&](const std::string& sentence) { lines.Warned(sentence); }};
  CaptureRun run;
  try {
    lines.Doing("looking for poses");
    run = Capture(prepared, listener);
  } catch (const std::invalid_argument& error) {
    lines.Clear();
    throw InputError(settings.out, 0, "cannot be held with this drawing", error.what());
  }
  lines.Clear();
  if (settings.prints_json)
    console.out << JsonText(CaptureJson(prepared, run));
  else
    console.out << Summary(prepared, run);
  if (!run.is_complete) console.err << "legible: stopped: " << run.reason << "\n";
  return run.is_complete ? kExitSuccess : kExitNoResult;
}

}  // namespace legible
