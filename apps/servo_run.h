// A servo from the user's settings to all there is to say about it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/interruption.h"
#include "apps/progress.h"
#include "apps/rig_opening.h"
#include "apps/servo_log.h"
#include "apps/servo_settings.h"
#include "core/vision/gray_image.h"

namespace legible {

inline constexpr char kFrameFolder[] = "frames";  // of a log, for the images that are kept

// An image of the run, with the cycle that it belongs to.
struct RunPicture {
  std::string label;
  size_t cycle = 0;
  std::optional<GrayImage> image;  // none: image-free
};

// What is needed to drive: nothing has moved yet.
struct PreparedServo {
  ServoSettings settings;
  OpenedRig rig;
  ServoSetup setup;
  // base_from_platform of the true robot, in the model's frames; of a simulated rig.
  std::optional<Rigid3> true_goal;
  std::vector<std::string> warnings;
};
// Throws InputError for a model without camera, a goal out of the joint ranges or not to be seen, …
PreparedServo PrepareServo(const ServoSettings& settings, OpenedRig rig);

struct FinishedServo {
  ServoRun run;
  ServoLog log;
  std::vector<RunPicture> pictures;  // of the first and the last cycle
  std::optional<Rigid3> true_end;    // at rest, in the model's frames; of a simulated rig
  // Why edges that the last image does not show are missing: [leg][edge]; empty: they are not.
  std::array<std::array<std::string, 2>, kLegCount> missing;
};
// The log grows in the folder, and so do the images in its folder of frames if they are to be kept. Throws
// InputError, having moved nothing, if the log cannot be begun there.
FinishedServo DriveServo(PreparedServo& prepared, const std::filesystem::path& folder,
                         const Interruption& interruption, ProgressLine& progress);

}  // namespace legible
