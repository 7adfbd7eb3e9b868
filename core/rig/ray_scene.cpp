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

// One number a ray of a packet.
using Numbers = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kPacketSize, 1>;
struct NumberVectors {
  Numbers x, y, z;

  Numbers Dot(const Eigen::Vector3d& v) const { return v.x() * x + v.y() * y + v.z() * z; }
  Numbers Dot(const NumberVectors& other) const { return x * other.x + y * other.y + z * other.z; }
  Eigen::Vector3d operator[](Eigen::Index i) const { return {x[i], y[i], z[i]}; }
};

// As Embree hands them over.
struct Rays {
  NumberVectors origin, direction;

  Rays(RTCRayN* rays, unsigned int count)
      : origin{Read(&RTCRayN_org_x(rays, count, 0), count), Read(&RTCRayN_org_y(rays, count, 0), count),
               Read(&RTCRayN_org_z(rays, count, 0), count)},
        direction{Read(&RTCRayN_dir_x(rays, count, 0), count), Read(&RTCRayN_dir_y(rays, count, 0), count),
                  Read(&RTCRayN_dir_z(rays, count, 0), count)} {}

 private:
  static Numbers Read(const float* numbers, unsigned int count) {
    return Eigen::Map<const Eigen::ArrayXf>(numbers, count).cast<double>();
  }
};

// A ray meets a surface where p s^2 - 2 q s + c = 0; the discriminant is q^2 - p c.
struct Quadratics {
  Numbers p, q, discriminant;
};

class CylinderShape {
 public:
  explicit CylinderShape(const Cylinder& cylinder)
      : start_(cylinder.start_in_camera),
        length_m_((cylinder.end_in_camera - cylinder.start_in_camera).norm()),
        radius_m_(cylinder.radius_m) {
    axis_.setUnit(2);
    if (length_m_ > 0) axis_ = (cylinder.end_in_camera - start_) / length_m_;
  }

  Quadratics Equations(const Rays& rays) const {
    const NumberVectors to_start{start_.x() - rays.origin.x, start_.y() - rays.origin.y,
                                 start_.z() - rays.origin.z};
    const Numbers along_ray = rays.direction.Dot(axis_), along_start = to_start.Dot(axis_);
    const Numbers p = rays.direction.Dot(rays.direction) - along_ray.square();
    const Numbers q = rays.direction.Dot(to_start) - along_ray * along_start;
    const Numbers c = to_start.Dot(to_start) - along_start.square() - radius_m_ * radius_m_;
    return {p, q, q.square() - p * c};
  }
  bool Holds(const Eigen::Vector3d& x) const {
    const double along_m = (x - start_).dot(axis_);
    return along_m >= 0 && along_m <= length_m_;
  }
  Eigen::Vector3d NormalAt(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d from_start = x - start_;
    return (from_start - from_start.dot(axis_) * axis_) / radius_m_;
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
  explicit BallShape(const Ball& ball) : centre_(ball.centre_in_camera), radius_m_(ball.radius_m) {}

  Quadratics Equations(const Rays& rays) const {
    const NumberVectors to_centre{centre_.x() - rays.origin.x, centre_.y() - rays.origin.y,
                                  centre_.z() - rays.origin.z};
    const Numbers p = rays.direction.Dot(rays.direction), q = rays.direction.Dot(to_centre);
    return {p, q, q.square() - p * (to_centre.Dot(to_centre) - radius_m_ * radius_m_)};
  }
  bool Holds(const Eigen::Vector3d& /*x*/) const { return true; }
  Eigen::Vector3d NormalAt(const Eigen::Vector3d& x) const { return (x - centre_) / radius_m_; }

  Eigen::AlignedBox3d Bounds() const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m_);
    return {centre_ - reach, centre_ + reach};
  }

 private:
  Eigen::Vector3d centre_;
  double radius_m_;
};

template <typename Shape>
const Shape& ShapeOf(const void* shapes, unsigned int index) {
  return (*static_cast<const std::vector<Shape>*>(shapes))[index];
}

template <typename Shape>
void BoundsOf(const RTCBoundsFunctionArguments* arguments) {
  const Eigen::AlignedBox3d box = ShapeOf<Shape>(arguments->geometryUserPtr, arguments->primID).Bounds();
  const Eigen::Vector3f low = (box.min().array() - kBoundsMargin_m).cast<float>();
  const Eigen::Vector3f high = (box.max().array() + kBoundsMargin_m).cast<float>();
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = low.x(), bounds.lower_y = low.y(), bounds.lower_z = low.z();
  bounds.upper_x = high.x(), bounds.upper_y = high.y(), bounds.upper_z = high.z();
}

// Calls met(i, depth, x) for each valid ray that meets the shape, with the first place where it does.
template <typename Shape, typename Met>
void ForEachMeeting(const Shape& shape, RTCRayN* packet, unsigned int count, const int* valid,
                    const Met& met) {
  const Rays rays(packet, count);
  const Quadratics equations = shape.Equations(rays);
  for (unsigned int i = 0; i < count; ++i) {
    if (valid[i] == 0 || !(equations.discriminant[i] >= 0)) continue;
    const double root = std::sqrt(equations.discriminant[i]);
    for (const double numerator : {equations.q[i] - root, equations.q[i] + root}) {
      const double depth = numerator / equations.p[i];
      if (!(depth > RTCRayN_tnear(packet, count, i) && depth < RTCRayN_tfar(packet, count, i))) continue;
      const Eigen::Vector3d x = rays.origin[i] + depth * rays.direction[i];
      if (!shape.Holds(x)) continue;
      met(i, depth, x);
      break;
    }
  }
}

template <typename Shape>
void Intersect(const RTCIntersectFunctionNArguments* arguments) {
  const unsigned int count = arguments->N;
  const Shape& shape = ShapeOf<Shape>(arguments->geometryUserPtr, arguments->primID);
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments->rayhit, count);
  ForEachMeeting(shape, rays, count, arguments->valid,
                 [&](unsigned int i, double depth, const Eigen::Vector3d& x) {
                   const Eigen::Vector3f normal = shape.NormalAt(x).template cast<float>();
                   RTCRayN_tfar(rays, count, i) = static_cast<float>(depth);
                   RTCHitN_Ng_x(hits, count, i) = normal.x();
                   RTCHitN_Ng_y(hits, count, i) = normal.y();
                   RTCHitN_Ng_z(hits, count, i) = normal.z();
                   RTCHitN_primID(hits, count, i) = arguments->primID;
                   RTCHitN_geomID(hits, count, i) = arguments->geomID;
                   RTCHitN_instID(hits, count, i, 0) = RTC_INVALID_GEOMETRY_ID;
                 });
}

template <typename Shape>
void Occlude(const RTCOccludedFunctionNArguments* arguments) {
  const unsigned int count = arguments->N;
  RTCRayN* const rays = arguments->ray;
  ForEachMeeting(ShapeOf<Shape>(arguments->geometryUserPtr, arguments->primID), rays, count, arguments->valid,
                 [&](unsigned int i, double /*depth*/, const Eigen::Vector3d& /*x*/) {
                   RTCRayN_tfar(rays, count, i) = -std::numeric_limits<float>::infinity();
                 });
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
