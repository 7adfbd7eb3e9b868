// Rays against the parts of a scene, sixteen at a time.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "core/rig/scene_parts.h"

namespace legible {

inline constexpr size_t kPacketSize = 16;
using Lanes = std::array<float, kPacketSize>;

// Three coordinates a lane.
struct alignas(64) LaneVectors {
  Lanes x, y, z;

  Eigen::Vector3f operator[](size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void Set(size_t lane, const Eigen::Vector3f& v) { x[lane] = v.x(), y[lane] = v.y(), z[lane] = v.z(); }
};

// Sight lines depth * direction from the camera centre, and what they meet.
struct alignas(64) SightPacket {
  LaneVectors direction;
  Lanes depth;                           // nothing nearer than this was met: large in the beginning
  std::array<int, kPacketSize> surface;  // what lies at that depth; -1: nothing
  LaneVectors normal;                    // there, unit, towards the camera
};

// Lines from points towards the light, and whether something stands in them.
struct alignas(64) ShadowPacket {
  LaneVectors origin;
  std::array<bool, kPacketSize> is_wanted;
  std::array<bool, kPacketSize> is_dark;
};

// Cylinders and balls are met where they are in double precision: their outlines are no polygons. Surfaces
// count from first_surface: cylinders, then balls, then faces, in their order. May be used by several
// threads.
class RayScene {
 public:
  RayScene(const SceneParts& parts, int first_surface);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Brings a packet to what this scene has nearer than what the packet has met already.
  void Trace(SightPacket& packet) const;
  // Sets is_dark where something stands between the origin and a light infinitely far away.
  void TraceShadows(const Eigen::Vector3f& towards_light, ShadowPacket& packet) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace legible
