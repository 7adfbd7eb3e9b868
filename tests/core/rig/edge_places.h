// Where edges of evenly bright legs lie in a noiseless image, found without any model of an edge: the sum of
// what a row or column of pixels has of the leg is the length of it that the leg covers.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/geometry/edge_distance.h"
#include "core/rig/sensor.h"
#include "core/vision/predicted_legs.h"

namespace legible {

// A row or column of pixels that an edge crosses.
struct EdgeCrossing {
  double place_px = 0;      // of the true edge along the row or column
  double error_px = 0;      // by which the leg ends farther out in the image than in truth
  double variance_px2 = 0;  // of the brightness's slope about the true place, along the row or column
  double slope = 0;         // of the edge: how far its place moves from one row or column to the next
};

class EdgePlaces {
 public:
  // Rows and columns are looked at to `reach` pixels on both sides of an edge.
  EdgePlaces(const BrightnessImage& image, const Camera& camera, double leg_grey, double background_grey,
             int reach)
      : image_(image),
        camera_(camera),
        leg_grey_(leg_grey),
        background_grey_(background_grey),
        reach_(reach) {}

  // Of the stretches of an edge that nothing is near.
  std::vector<EdgeCrossing> Of(const PredictedEdge& edge) const {
    std::vector<EdgeCrossing> crossings;
    for (size_t i = 1; i < edge.points.size(); ++i) {
      const PredictedEdgePoint &a = edge.points[i - 1], &b = edge.points[i];
      if (a.obstacle != EdgeObstacle::kNone || b.obstacle != EdgeObstacle::kNone) continue;
      const int across = std::abs(a.normal_px.x()) > std::abs(a.normal_px.y()) ? 0 : 1;
      const double from = std::min(a.point_px[1 - across], b.point_px[1 - across]);
      const double to = std::max(a.point_px[1 - across], b.point_px[1 - across]);
      for (int line = static_cast<int>(std::ceil(from)); line < to; ++line)
        crossings.push_back(Cross(edge, a, across, line));
    }
    return crossings;
  }

 private:
  // `across`: 0 along a row, 1 along a column.
  EdgeCrossing Cross(const PredictedEdge& edge, const PredictedEdgePoint& near, int across, int line) const {
    Eigen::Vector2d start = near.point_px;
    start[1 - across] = line;
    start[across] -= (line - near.point_px[1 - across]) * near.normal_px[1 - across] / near.normal_px[across];
    Eigen::Vector2d outward = Eigen::Vector2d::Zero();
    outward[across] = near.normal_px[across] > 0 ? 1 : -1;
    const auto distance = DistanceToEdge(camera_, edge.normal, start, outward);
    EdgeCrossing crossing;
    crossing.place_px = start[across] - distance.value().distance_px * outward[across];
    crossing.slope = -near.normal_px[1 - across] / near.normal_px[across];
    const int middle = static_cast<int>(std::lround(crossing.place_px));
    const int side = static_cast<int>(outward[across]);
    double covered = 0;
    for (int i = -reach_; i <= reach_; ++i) {
      covered += Share(across, line, middle + i);
      const double step = Share(across, line, middle + i) - Share(across, line, middle + i + 1);
      crossing.variance_px2 += side * step * std::pow(middle + i + 0.5 - crossing.place_px, 2);
    }
    // The leg reaches from the inner end of the row outward over `covered` pixels.
    const double inner_end = middle - side * (reach_ + 0.5);
    crossing.error_px = side * (inner_end + side * covered - crossing.place_px);
    return crossing;
  }

  double Share(int across, int line, int place) const {
    const float grey = across == 0 ? image_.Row(line)[place] : image_.Row(place)[line];
    return (grey - background_grey_) / (leg_grey_ - background_grey_);
  }

  const BrightnessImage& image_;
  const Camera& camera_;
  double leg_grey_, background_grey_;
  int reach_;
};

}  // namespace legible
