#include "core/rig/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace legible {
namespace {

constexpr float kShadowStart_m = 1e-3F;  // beyond what rounding makes of a surface's own outside
constexpr double kBoundsMargin_m = 1e-4;

struct Ray {
  Eigen::Vector3d origin, direction;
  double from, to;  // in lengths of the direction

  bool Reaches(double depth) const { return depth > from && depth < to; }
};

struct Meeting {
  double depth;
  Eigen::Vector3d normal;  // outward, unit
};

// Of the roots of p s^2 - 2 q s + c = 0, in order, the first that `accepts`.
template <typename Accepts>
std::optional<double> FirstRoot(double p, double q, double c, const Accepts& accepts) {
  const double discriminant = q * q - p * c;
  if (!(discriminant >= 0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  if (const double s = (q - root) / p; accepts(s)) return s;
  if (const double s = (q + root) / p; accepts(s)) return s;
  return std::nullopt;
}

class CylinderShape {
 public:
  explicit CylinderShape(const Cylinder& cylinder)
      : start_(cylinder.start_in_camera),
        length_m_((cylinder.end_in_camera - cylinder.start_in_camera).norm()),
        radius_m_(cylinder.radius_m) {
    axis_.setUnit(2);
    if (length_m_ > 0) axis_ = (cylinder.end_in_camera - start_) / length_m_;
  }

  std::optional<Meeting> Meet(const Ray& ray) const {
    const Eigen::Vector3d to_start = start_ - ray.origin;
    const double along_ray = ray.direction.dot(axis_), along_start = to_start.dot(axis_);
    // Squares and products of what is across the axis.
    const Eigen::Vector3d ray_across = ray.direction - along_ray * axis_;
    const Eigen::Vector3d start_across = to_start - along_start * axis_;
    const auto depth =
        FirstRoot(ray_across.squaredNorm(), ray_across.dot(start_across),
                  start_across.squaredNorm() - radius_m_ * radius_m_, [&](double s) {
                    const double along_m = s * along_ray - along_start;
                    return ray.Reaches(s) && along_m >= 0 && along_m <= length_m_;
                  });
    if (!depth) return std::nullopt;
    return Meeting{*depth, (*depth * ray_across - start_across) / radius_m_};
  }

  Eigen::AlignedBox3d Bounds() const {
    const Eigen::Vector3d reach = radius_m_ * (1 - axis_.array().square()).max(0).sqrt();
    Eigen::AlignedBox3d box(start_ - reach, start_ + reach);
    const Eigen::Vector3d end = start_ + length_m_ * axis_;
    box.extend(Eigen::AlignedBox3d(end - reach, end + reach));
    return box;
  }

 private:
  Eigen::Vector3d start_, axis_;
  double length_m_, radius_m_;
};

class BallShape {
 public:
  explicit BallShape(const Ball& ball)
      : centre_(ball.centre_in_camera), radius_m_(ball.radius_m) {}

  std::optional<Meeting> Meet(const Ray& ray) const {
    const Eigen::Vector3d to_centre = centre_ - ray.origin;
    const auto depth =
        FirstRoot(ray.direction.squaredNorm(), ray.direction.dot(to_centre),
                  to_centre.squaredNorm() - radius_m_ * radius_m_, [&](double s) { return ray.Reaches(s); });
    if (!depth) return std::nullopt;
    return Meeting{*depth, (*depth * ray.direction - to_centre) / radius_m_};
  }

  Eigen::AlignedBox3d Bounds() const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m_);
    return {centre_ - reach, centre_ + reach};
  }

 private:
  Eigen::Vector3d centre_;
  double radius_m_;
};

template <typename Shape>
void BoundsOf(const RTCBoundsFunctionArguments* arguments) {
  const auto& shapes = *static_cast<const std::vector<Shape>*>(arguments->geometryUserPtr);
  const Eigen::AlignedBox3d box = shapes[arguments->primID].Bounds();
  const Eigen::Vector3f low = (box.min().array() - kBoundsMargin_m).cast<float>();
  const Eigen::Vector3f high = (box.max().array() + kBoundsMargin_m).cast<float>();
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = low.x(), bounds.lower_y = low.y(), bounds.lower_z = low.z();
  bounds.upper_x = high.x(), bounds.upper_y = high.y(), bounds.upper_z = high.z();
}

Ray RayAt(RTCRayN* rays, unsigned int count, unsigned int i) {
  return {{RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i), RTCRayN_org_z(rays, count, i)},
          {RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i), RTCRayN_dir_z(rays, count, i)},
          RTCRayN_tnear(rays, count, i),
          RTCRayN_tfar(rays, count, i)};
}

template <typename Shape>
void Intersect(const RTCIntersectFunctionNArguments* arguments) {
  const unsigned int count = arguments->N;
  const Shape& shape =
      (*static_cast<const std::vector<Shape>*>(arguments->geometryUserPtr))[arguments->primID];
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments->rayhit, count);
  for (unsigned int i = 0; i < count; ++i) {
    if (arguments->valid[i] == 0) continue;
    const std::optional<Meeting> meeting = shape.Meet(RayAt(rays, count, i));
    if (!meeting) continue;
    RTCRayN_tfar(rays, count, i) = static_cast<float>(meeting->depth);
    RTCHitN_Ng_x(hits, count, i) = static_cast<float>(meeting->normal.x());
    RTCHitN_Ng_y(hits, count, i) = static_cast<float>(meeting->normal.y());
    RTCHitN_Ng_z(hits, count, i) = static_cast<float>(meeting->normal.z());
    RTCHitN_primID(hits, count, i) = arguments->primID;
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
    RTCHitN_instID(hits, count, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

template <typename Shape>
void Occlude(const RTCOccludedFunctionNArguments* arguments) {
  const Shape& shape =
      (*static_cast<const std::vector<Shape>*>(arguments->geometryUserPtr))[arguments->primID];
  for (unsigned int i = 0; i < arguments->N; ++i)
    if (arguments->valid[i] != 0 && shape.Meet(RayAt(arguments->ray, arguments->N, i)))
      RTCRayN_tfar(arguments->ray, arguments->N, i) = -std::numeric_limits<float>::infinity();
}

// One for the program: making one takes longer than an image.
RTCDevice SharedDevice() {
  struct Device {
    RTCDevice handle = rtcNewDevice(nullptr);
    ~Device() {
      if (handle) rtcReleaseDevice(handle);
    }
  };
  static const Device device;
  if (!device.handle) throw std::runtime_error("Embree does not start on this machine");
  return device.handle;
}

}  // namespace

struct RayScene::Embree {
  std::vector<CylinderShape> cylinders;
  std::vector<BallShape> balls;
  std::vector<int> face_of_triangle;
  RTCScene scene = nullptr;
  // Embree's numbers of the three geometries, and the first surface of each.
  static constexpr unsigned int kCylinders = 0, kBalls = 1, kTriangles = 2;
  int first_cylinder = 0, first_ball = 0, first_face = 0;

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
  }

  int SurfaceOf(unsigned int geometry, unsigned int primitive) const {
    switch (geometry) {
      case kCylinders:
        return first_cylinder + static_cast<int>(primitive);
      case kBalls:
        return first_ball + static_cast<int>(primitive);
      default:
        return first_face + face_of_triangle[primitive];
    }
  }

  template <typename Shape>
  void Attach(std::vector<Shape>& shapes, unsigned int number) {
    RTCGeometry geometry = rtcNewGeometry(SharedDevice(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(shapes.size()));
    rtcSetGeometryUserData(geometry, &shapes);
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* arguments) { BoundsOf<Shape>(arguments); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, Intersect<Shape>);
    rtcSetGeometryOccludedFunction(geometry, Occlude<Shape>);
    AttachAs(geometry, number);
  }

  void AttachFaces(const std::vector<Face>& faces) {
    std::vector<Eigen::Vector3f> corners;
    for (size_t face = 0; face < faces.size(); ++face)
      for (const auto& triangle : faces[face].triangles_in_camera) {
        for (const Eigen::Vector3d& corner : triangle) corners.emplace_back(corner.cast<float>());
        face_of_triangle.push_back(static_cast<int>(face));
      }
    RTCGeometry geometry = rtcNewGeometry(SharedDevice(), RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!corners.empty()) {
      void* const vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                     3 * sizeof(float), corners.size());
      std::copy_n(corners.front().data(), 3 * corners.size(), static_cast<float*>(vertices));
      auto* const indices = static_cast<unsigned int*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                  3 * sizeof(unsigned int), face_of_triangle.size()));
      for (unsigned int i = 0; i < corners.size(); ++i) indices[i] = i;
    }
    AttachAs(geometry, kTriangles);
  }

  void AttachAs(RTCGeometry geometry, unsigned int number) const {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
    rtcReleaseGeometry(geometry);
  }
};

RayScene::RayScene(const SceneParts& parts, int first_surface) : embree_(std::make_unique<Embree>()) {
  Embree& embree = *embree_;
  for (const Cylinder& cylinder : parts.cylinders) embree.cylinders.emplace_back(cylinder);
  for (const Ball& ball : parts.balls) embree.balls.emplace_back(ball);
  embree.first_cylinder = first_surface;
  embree.first_ball = first_surface + static_cast<int>(parts.cylinders.size());
  embree.first_face = embree.first_ball + static_cast<int>(parts.balls.size());
  embree.scene = rtcNewScene(SharedDevice());
  rtcSetSceneFlags(embree.scene, RTC_SCENE_FLAG_ROBUST);
  embree.Attach(embree.cylinders, Embree::kCylinders);
  embree.Attach(embree.balls, Embree::kBalls);
  embree.AttachFaces(parts.faces);
  rtcCommitScene(embree.scene);
  if (rtcGetDeviceError(SharedDevice()) != RTC_ERROR_NONE)
    throw std::runtime_error("Embree could not take the scene");
}

RayScene::~RayScene() = default;

void RayScene::Trace(SightPacket& packet) const {
  alignas(64) int valid[kPacketSize];
  RTCRayHit16 rays;
  for (size_t i = 0; i < kPacketSize; ++i) {
    valid[i] = -1;
    rays.ray.org_x[i] = rays.ray.org_y[i] = rays.ray.org_z[i] = 0;
    rays.ray.dir_x[i] = packet.direction.x[i];
    rays.ray.dir_y[i] = packet.direction.y[i];
    rays.ray.dir_z[i] = packet.direction.z[i];
    rays.ray.tnear[i] = 0;
    rays.ray.tfar[i] = packet.depth[i];
    rays.ray.time[i] = 0;
    rays.ray.mask[i] = ~0U;
    rays.ray.id[i] = rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, embree_->scene, &context, &rays);
  for (size_t i = 0; i < kPacketSize; ++i) {
    if (rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    packet.depth[i] = rays.ray.tfar[i];
    packet.surface[i] = embree_->SurfaceOf(rays.hit.geomID[i], rays.hit.primID[i]);
    const Eigen::Vector3f normal =
        Eigen::Vector3f(rays.hit.Ng_x[i], rays.hit.Ng_y[i], rays.hit.Ng_z[i]).normalized();
    packet.normal.Set(i, normal.dot(packet.direction[i]) > 0 ? Eigen::Vector3f(-normal) : normal);
  }
}

void RayScene::TraceShadows(const Eigen::Vector3f& towards_light, ShadowPacket& packet) const {
  alignas(64) int valid[kPacketSize];
  RTCRay16 rays;
  for (size_t i = 0; i < kPacketSize; ++i) {
    valid[i] = packet.is_wanted[i] && !packet.is_dark[i] ? -1 : 0;
    rays.org_x[i] = packet.origin.x[i];
    rays.org_y[i] = packet.origin.y[i];
    rays.org_z[i] = packet.origin.z[i];
    rays.dir_x[i] = towards_light.x();
    rays.dir_y[i] = towards_light.y();
    rays.dir_z[i] = towards_light.z();
    rays.tnear[i] = kShadowStart_m;
    rays.tfar[i] = std::numeric_limits<float>::infinity();
    rays.time[i] = 0;
    rays.mask[i] = ~0U;
    rays.id[i] = rays.flags[i] = 0;
  }
  if (std::none_of(std::begin(valid), std::end(valid), [](int v) { return v != 0; })) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, embree_->scene, &context, &rays);
  for (size_t i = 0; i < kPacketSize; ++i)
    if (valid[i] != 0 && rays.tfar[i] < 0) packet.is_dark[i] = true;
}

}  // namespace legible
