#include "tests/testing/render_legs.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace legible {
namespace {

constexpr int kFine = 4;  // fine pixels across a pixel: blurred before the pixels are filled
constexpr int kRays = 13,
              kGenerator = 8;  // Fibonacci's lattice of rays in a fine pixel, even on both sides of an edge
constexpr double kNearEdge_px = 2;  // further off, a leg's brightness is as good as constant within a pixel

// Where a ray of a fine pixel goes, in pixels from the pixel's centre.
Eigen::Vector2d PlaceInPixel(int column, int row, int ray) {
  const Eigen::Vector2d in_fine(ray + 0.5, ray * kGenerator % kRays + 0.5);
  return (Eigen::Vector2d(column, row) + in_fine / kRays) / kFine - Eigen::Vector2d(0.5, 0.5);
}

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

class Renderer {
 public:
  Renderer(const LegsInCamera& legs, const Camera& camera, const RenderOptions& options)
      : camera_(camera), options_(options) {
    for (const LegInCamera& leg : legs) cylinders_.emplace_back(leg);
  }

  // Fills the fine pixels of one pixel.
  void FillPixel(int x, int y, cv::Mat& fine) const {
    cv::Mat block = fine(cv::Rect(kFine * x, kFine * y, kFine, kFine));
    const auto centre = Unproject(camera_, {x, y});
    const bool near_edge =
        centre && std::any_of(cylinders_.begin(), cylinders_.end(), [&](const Cylinder& cylinder) {
          return cylinder.HasEdgeNear(*centre, kNearEdge_px / camera_.fx_px);
        });
    if (!near_edge) {
      block = centre ? Brightness(*centre) : options_.background;
      return;
    }
    const Eigen::Matrix2d d_pixel =
        Eigen::Vector2d(camera_.fx_px, camera_.fy_px).asDiagonal() *
        DistortWithJacobians(camera_.lens, camera_.distortion, *centre).d_point_d_undistorted;
    const Eigen::Matrix2d d_undistorted = d_pixel.inverse();
    for (int row = 0; row < kFine; ++row)
      for (int column = 0; column < kFine; ++column) {
        double sum = 0;
        for (int ray = 0; ray < kRays; ++ray)
          sum += Brightness(*centre + d_undistorted * PlaceInPixel(column, row, ray));
        block.at<float>(row, column) = static_cast<float>(sum / kRays);
      }
  }

 private:
  double Brightness(const Eigen::Vector2d& x) const {
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

  const Camera& camera_;
  const RenderOptions& options_;
  std::vector<Cylinder> cylinders_;
};

}  // namespace

CleanImage RenderLegs(const LegsInCamera& legs, const Camera& camera, const RenderOptions& options) {
  const Renderer renderer(legs, camera, options);
  cv::Mat fine(kFine * camera.height_px, kFine * camera.width_px, CV_32FC1);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) renderer.FillPixel(x, y, fine);
  cv::GaussianBlur(fine, fine, cv::Size(), kFine * options.blur_px);
  CleanImage image{camera.width_px, camera.height_px, {}};
  image.grey.resize(static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px));
  cv::Mat mat(image.height, image.width, CV_32FC1, image.grey.data());
  cv::resize(fine, mat, mat.size(), 0, 0, cv::INTER_AREA);  // the mean of each pixel's fine pixels
  return image;
}

GrayImage WithNoise(const CleanImage& clean, double sigma_grey, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  GrayImage image{clean.width, clean.height, {}};
  for (const float grey : clean.grey)
    image.pixels.push_back(
        static_cast<std::uint8_t>(std::clamp(std::lround(grey + sigma_grey * normal(generator)), 0L, 255L)));
  return image;
}

}  // namespace legible
