#include "core/rig/tracked_edges.h"

#include <utility>

#include "core/stopwatch.h"

namespace legible {

TrackedEdgeSource::TrackedEdgeSource(Rig& rig, const GoughStewart& robot, const Camera& camera,
                                     const Rigid3& camera_from_base, const EdgeTrackerOptions& options)
    : rig_(rig),
      robot_(robot),
      tracker_(robot, camera, camera_from_base, options),
      base_from_platform_(robot.home) {}

SeenEdges TrackedEdgeSource::See(const MotionNow& motion) {
  StampedImage image = rig_.Grab();
  const Stopwatch watch;
  if (!newest_ || image.time_s != image_.time_s) Look(std::move(image), motion);
  track_s_ = watch.Seconds();
  return newest_->seen;
}

void TrackedEdgeSource::Look(StampedImage image, const MotionNow& motion) {
  const bool repeats = newest_ && image.image.pixels == image_.image.pixels;
  image_ = std::move(image);
  if (repeats) {
    newest_->seen.time_s = image_.time_s;
    return;
  }
  const Vector6d readings_m =
      motion.joint_readings_m + (image_.time_s - motion.time_s) * motion.joint_speeds_m_per_s;
  const auto forward = ForwardKinematics(robot_, readings_m, base_from_platform_);
  if (forward.status == ForwardKinematicsStatus::kConverged) base_from_platform_ = forward.base_from_platform;
  newest_ = tracker_.Track(image_.image, image_.time_s, base_from_platform_);
}

}  // namespace legible
