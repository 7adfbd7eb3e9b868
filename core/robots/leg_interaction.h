// How the edges of the legs move in the image with the platform: the interaction matrix, in pixels.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// Of each leg observed both edges, of each edge the shift at both its ends: where the outline passes the base
// joint, and where it passes the platform joint.
inline constexpr int kShiftsPerLeg = 4;

// An edge's end in the image.
struct EdgeEnd {
  int leg = 0;   // from 0
  int edge = 0;  // 0: the paper's edge 1
  bool is_at_platform = false;
};
std::vector<EdgeEnd> EdgeEnds(const std::vector<int>& legs);

// d(shifts, px, across the edge and outward) / d(platform twist in base), (4 legs) x 6, rows as EdgeEnds has
// them: how far each edge moves in the image at the points where it is now seen beside its leg's joints. From
// the edges' normals (Andreff, Dallej, Martinet 2007, eq. 14-16, 21-27) and the exact lens. Nothing where a
// leg has no edges in this camera or one of these points no image.
std::optional<Eigen::Matrix<double, Eigen::Dynamic, 6>> EdgeInteraction(const GoughStewart& robot,
                                                                        const Camera& camera,
                                                                        const Rigid3& camera_from_base,
                                                                        const Rigid3& base_from_platform,
                                                                        const std::vector<int>& legs);

}  // namespace legible
