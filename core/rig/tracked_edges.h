// Edges followed in the images of a rig.
#pragma once

#include <optional>

#include "core/rig/edge_source.h"
#include "core/rig/rig.h"
#include "core/vision/edge_tracker.h"

namespace legible {

class TrackedEdgeSource : public EdgeSource {
 public:
  // The rig must outlive this. The legs are expected where the model has them by the readings, carried on to
  // the image's time by the commanded speeds. Throws std::invalid_argument where the options are wrong.
  TrackedEdgeSource(Rig& rig, const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base,
                    const EdgeTrackerOptions& options);

  // An image whose pixels are those of the last one shows the same edges to the last bit: a camera that is
  // frozen must look so.
  SeenEdges See(const MotionNow& motion) override;

  // The newest image and what was made of it; nothing before the first See.
  const StampedImage& image() const { return image_; }
  const std::optional<TrackedEdges>& newest() const { return newest_; }
  // Time that the last See took without the rig's part, s.
  double track_s() const { return track_s_; }

 private:
  void Look(StampedImage image, const MotionNow& motion);

  Rig& rig_;
  GoughStewart robot_;
  EdgeTracker tracker_;
  Rigid3 base_from_platform_;  // as last predicted
  StampedImage image_;
  std::optional<TrackedEdges> newest_;
  double track_s_ = 0;
};

}  // namespace legible
