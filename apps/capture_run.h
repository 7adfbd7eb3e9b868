// A calibration session held with a rig, from the user's settings to all there is to say about it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/capture_settings.h"
#include "apps/rig_opening.h"
#include "apps/session_outlook.h"
#include "datasets/growing_session.h"

namespace legible {

struct NamedPose {
  std::string name;
  Rigid3 base_from_platform;
};

// What is needed to begin: nothing has moved, and of a new session nothing is there to see.
struct PreparedCapture {
  CaptureSettings settings;
  OpenedRig rig;
  std::unique_ptr<GrowingSession> session;
  std::vector<NamedPose> poses;  // of --poses
  std::vector<std::string> warnings;
};
// Throws InputError for a drawing, camera, poses or session that cannot be.
PreparedCapture PrepareCapture(const CaptureSettings& settings, OpenedRig rig);

struct CaptureTimes {
  double drive_s = 0, image_s = 0, look_s = 0, store_s = 0, outlook_s = 0, propose_s = 0;
};

struct CapturedImage {
  std::string name;
  Rigid3 base_from_platform;  // where the robot was sent
  Vector6d joint_readings_m = Vector6d::Zero();
  int edges = 0;           // of twelve
  std::string unusable;    // why the image tells nothing; empty: it does
  ExpectedSigma expected;  // of the session so far
  CaptureTimes times;
};

struct RejectedPose {
  std::string name;  // the image's that it was to be
  Rigid3 base_from_platform;
  std::string reason;
};

struct CaptureRun {
  int images_before = 0;  // of the session that was resumed
  std::vector<CapturedImage> images;
  std::vector<RejectedPose> rejected;
  std::vector<std::string> warnings;
  ExpectedSigma expected;  // in the end
  bool is_complete = false;
  std::string reason;  // why it ended, in words
  double rig_time_s = 0;
};

// Told of each step, for whoever waits.
struct CaptureListener {
  std::function<void(const std::string&)> doing;
  std::function<void(const CapturedImage&)> captured;
  std::function<void(const RejectedPose&)> rejected;
  std::function<void(const std::string&)> warned;
};

// Drives, takes and stores until there is what was asked for, or it cannot go on. What has been stored stays.
CaptureRun Capture(PreparedCapture& prepared, const CaptureListener& listener);

}  // namespace legible
