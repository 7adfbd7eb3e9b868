// What stands before the simulated camera: the robot, what it stands on, the room. Everything in the camera
// frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/rig/simulation_options.h"

namespace legible {

// What a surface looks like: grey levels where the light falls perpendicularly.
struct Paint {
  double grey = 0;
  bool has_texture = false;  // smooth blotches besides
};

// Open at its ends.
struct Cylinder {
  Eigen::Vector3d start_in_camera, end_in_camera;  // of its axis
  double radius_m = 0;
  Paint paint;
};

struct Ball {
  Eigen::Vector3d centre_in_camera;
  double radius_m = 0;
  Paint paint;
};

// Flat, of triangles.
struct Face {
  std::vector<std::array<Eigen::Vector3d, 3>> triangles_in_camera;
  Paint paint;
};

struct SceneParts {
  std::vector<Cylinder> cylinders;
  std::vector<Ball> balls;
  std::vector<Face> faces;
};

// The ground and the dome of the room over it, which cast no shadow on the robot. The ground lies where the
// base stands, or a little below the camera where that is lower.
SceneParts RoomParts(const SimulationTruth& truth, const SceneOptions& options);

// The base plate, on the far side of the base joints, and the joints on it.
SceneParts BaseParts(const SimulationTruth& truth, const SceneOptions& options);

// Legs, platform and its joints, and a board a little before each of the covered legs (0-based). What hides
// the legs lies within what PredictEdges expects to, for cameras up to 35 degrees above the base plane: balls
// of 1.45 leg radii, and a thin plate on the far side of the platform joints that ends 3 mm beyond them.
SceneParts MovingParts(const SimulationTruth& truth, const SceneOptions& options,
                       const Rigid3& base_from_platform, const std::vector<int>& covered_legs);

}  // namespace legible
