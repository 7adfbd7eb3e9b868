// An image of a robot that stands still, with the joint readings of the same moment.
#pragma once

#include <functional>
#include <string>

#include "core/rig/rig.h"

namespace legible {

struct RestOptions {
  double period_s = 0.02;                                   // from reading to reading
  int readings = 10;                                        // that show whether something moves
  double reading_sigma_m = 1e-6;                            // noise of one reading
  double timeout_s = 5;                                     // to come to rest, and for the image to come
  std::function<bool()> is_stopped = [] { return false; };  // true: the user wants it stopped

  void Check() const;  // throws std::invalid_argument
};

struct ImageAtRest {
  std::string missing;  // why there is none, in words; empty: there is one
  StampedImage image;
  StampedReadings readings;  // those nearest in time to the exposure; the newest where there is no image
};

// Reads the joints until the means of both halves of the last readings agree within their noise, for every
// joint; then takes the first image that was exposed after they began to. To be called with the robot told to
// stand still. May throw RigError.
ImageAtRest TakeImageAtRest(Rig& rig, const RestOptions& options);

}  // namespace legible
