#include "tests/testing/render_legs.h"

#include <algorithm>
#include <cmath>

namespace legible {
namespace {

// A cylinder prepared for sight lines x = s * sight from the camera centre.
class Cylinder {
 public:
  explicit Cylinder(const LegInCamera& leg)
      : radius_m_(leg.radius_m),
        a_(leg.a_in_camera),
        direction_((leg.b_in_camera - leg.a_in_camera).normalized()),
        length_m_((leg.b_in_camera - leg.a_in_camera).norm()),
        a_across_(Across(a_)),
        normals_(CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera), leg.radius_m)) {}

  struct Hit {
    double depth;
    Eigen::Vector3d normal;
  };
  std::optional<Hit> Intersect(const Eigen::Vector3d& sight) const {
    const Eigen::Vector3d across = Across(sight);
    const double p = across.squaredNorm(), q = across.dot(a_across_);
    const double discriminant = q * q - p * (a_across_.squaredNorm() - radius_m_ * radius_m_);
    if (discriminant < 0) return std::nullopt;
    const double depth = (q - std::sqrt(discriminant)) / p;
    const double along_m = (depth * sight - a_).dot(direction_);
    if (depth <= 0 || along_m < 0 || along_m > length_m_) return std::nullopt;
    return Hit{depth, (depth * across - a_across_) / radius_m_};
  }

  bool HasEdgeNear(const Eigen::Vector2d& x, double distance) const {
    return std::any_of(normals_.begin(), normals_.end(), [&](const Eigen::Vector3d& normal) {
      return std::abs(normal.dot(x.homogeneous())) < distance * normal.head<2>().norm();
    });
  }

 private:
  Eigen::Vector3d Across(const Eigen::Vector3d& v) const { return v - v.dot(direction_) * direction_; }

  double radius_m_;
  Eigen::Vector3d a_, direction_;
  double length_m_;
  Eigen::Vector3d a_across_;
  std::array<Eigen::Vector3d, 2> normals_;
};

class LegScene : public RenderedScene {
 public:
  LegScene(const LegsInCamera& legs, const RenderOptions& options) : options_(options) {
    for (const LegInCamera& leg : legs) cylinders_.emplace_back(leg);
  }

  double Brightness(const Eigen::Vector2d& x) const override {
    std::optional<Cylinder::Hit> nearest;
    for (const Cylinder& cylinder : cylinders_) {
      const auto hit = cylinder.Intersect(x.homogeneous());
      if (hit && (!nearest || hit->depth < nearest->depth)) nearest = hit;
    }
    if (!nearest) return options_.background;
    if (!options_.light) return options_.leg;
    const LambertLight& light = *options_.light;
    return light.ambient + light.diffuse * std::max(0.0, nearest->normal.dot(light.towards_light_in_camera));
  }

  // Two pixels off an edge, shading is as good as constant within a pixel.
  bool VariesInPixel(const Eigen::Vector2d& x, double pixel) const override {
    return std::any_of(cylinders_.begin(), cylinders_.end(),
                       [&](const Cylinder& cylinder) { return cylinder.HasEdgeNear(x, 2 * pixel); });
  }

 private:
  const RenderOptions& options_;
  std::vector<Cylinder> cylinders_;
};

}  // namespace

CleanImage RenderLegs(const LegsInCamera& legs, const Camera& camera, const RenderOptions& options) {
  return RenderScene(LegScene(legs, options), camera, options.background, options.blur_px);
}

}  // namespace legible
