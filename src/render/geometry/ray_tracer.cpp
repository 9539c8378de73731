#include "render/geometry/ray_tracer.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "render/geometry/surface.h"

#ifndef H2MC_EMBREE_MAJOR
#define H2MC_EMBREE_MAJOR 3
#endif
#if H2MC_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace h2mc {
namespace {

// How far rays start off a surface, relative to the largest coordinate of their origin: 16 units in
// the last place, when a point on a surface is off by half of one [after Waechter and Binder 2019,
// "A Fast and Robust Method for Avoiding Self-Intersection", but without absolute lengths].
constexpr float kRelativeOffset = 0x1p-20f;
// The same relative to the largest triangle whose plane is not parallel to a coordinate plane:
// Embree finds such a plane only to a few units in the last place of its corners.
constexpr float kTriangleOffset = 0x1p-22f;
// The same relative to the largest coordinate of the scene, for origins at (0, 0, 0).
constexpr float kLeastOffset = 0x1p-36f;
// The share of a segment's length by which shadow rays fall short of its end, besides the offset.
constexpr float kShortening = 0x1p-20f;

void checkDevice(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(error)));
}

bool intersect1(RTCScene scene, RTCRayHit& ray) {
#if H2MC_EMBREE_MAJOR >= 4
  rtcIntersect1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#endif
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool occluded1(RTCScene scene, RTCRay& ray) {
#if H2MC_EMBREE_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
  return ray.tfar < 0;
}

RTCRay makeRay(const Vec3f& origin, const Vec3f& direction, float near, float far, float time) {
  RTCRay ray;
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.tnear = near;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.time = time;
  ray.tfar = far;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
  return ray;
}

struct Line {
  glm::dvec3 origin, direction;
  double near, far;
  float time;
};

Line lineOf(RTCRayN* ray) {
  return {{RTCRayN_org_x(ray, 1, 0), RTCRayN_org_y(ray, 1, 0), RTCRayN_org_z(ray, 1, 0)},
          {RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0), RTCRayN_dir_z(ray, 1, 0)},
          RTCRayN_tnear(ray, 1, 0),
          RTCRayN_tfar(ray, 1, 0),
          RTCRayN_time(ray, 1, 0)};
}

// The roots in double: an origin that is off the sphere by a few ulps of float is clearly inside or
// outside.
bool hitSphere(const detail::SphereView<float>& sphere, const Line& line, double& t, int& root) {
  const glm::dvec3 toCenter = sphere.exactCenter - line.origin;
  const double length2 = glm::dot(line.direction, line.direction);
  const double closest = glm::dot(toCenter, line.direction) / length2;
  const glm::dvec3 perpendicular = toCenter - line.direction * closest;
  const double radius = static_cast<double>(sphere.radius);
  const double discriminant = radius * radius - glm::dot(perpendicular, perpendicular);
  if (!(discriminant >= 0)) return false;
  const double half = std::sqrt(discriminant / length2);
  const double larger = closest >= 0 ? closest + half : closest - half;
  if (larger == 0) return false;
  const double smaller = (glm::dot(toCenter, toCenter) - radius * radius) / (larger * length2);
  const double roots[2] = {closest >= 0 ? smaller : larger, closest >= 0 ? larger : smaller};
  for (root = 0; root < 2; ++root) {
    t = roots[root];
    if (t > line.near && t < line.far) return true;
  }
  return false;
}

bool hitDisk(const detail::DiskView<float>& disk, const Line& line, double& t) {
  const glm::dvec3 &ax = disk.exactX, &ay = disk.exactY, n = glm::cross(ax, ay);
  const glm::dvec3 start = line.origin - disk.exactCenter;
  t = -glm::dot(start, n) / glm::dot(line.direction, n);
  if (!(t > line.near && t < line.far)) return false;
  const glm::dvec3 p = start + line.direction * t;
  const double n2 = glm::dot(n, n);
  const double x = glm::dot(p, glm::cross(ay, n)) / n2, y = glm::dot(p, glm::cross(n, ax)) / n2;
  return x * x + y * y <= 1;
}

bool hitShape(const Shape& shape, const Line& line, double& t, int& root) {
  root = 0;
  return detail::withView<float>(shape, &line.time, [&](const auto& view) {
    if constexpr (requires { view.radius; })
      return hitSphere(view, line, t, root);
    else if constexpr (requires { view.axisX; })
      return hitDisk(view, line, t);
    else
      return false;  // meshes are not asked about here
  });
}

void shapeBounds(const RTCBoundsFunctionArguments* arguments) {
  const Geometry& geometry = static_cast<const Shape*>(arguments->geometryUserPtr)->geometry;
  const std::size_t step = arguments->timeStep;
  const auto* sphere = std::get_if<Sphere>(&geometry);
  if (const auto* moving = std::get_if<MovingSphere>(&geometry)) sphere = &moving->steps[step];
  Vec3f center, extent;
  if (sphere) {
    center = sphere->center;
    extent = Vec3f(sphere->radius);
  } else {
    const auto* disk = std::get_if<Disk>(&geometry);
    if (const auto* moving = std::get_if<MovingDisk>(&geometry)) disk = &moving->steps[step];
    center = disk->center;
    extent = glm::sqrt(disk->axisX * disk->axisX + disk->axisY * disk->axisY);
  }
  // Rounding of this and of the traversal.
  extent += (glm::abs(center) + extent) * 1e-6f;
  RTCBounds& b = *arguments->bounds_o;
  b.lower_x = center.x - extent.x;
  b.lower_y = center.y - extent.y;
  b.lower_z = center.z - extent.z;
  b.upper_x = center.x + extent.x;
  b.upper_y = center.y + extent.y;
  b.upper_z = center.z + extent.z;
}

void shapeIntersect(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  RTCRayN* ray = RTCRayHitN_RayN(arguments->rayhit, 1);
  double t;
  int root;
  if (!hitShape(*static_cast<const Shape*>(arguments->geometryUserPtr), lineOf(ray), t, root))
    return;
  RTCHitN* hit = RTCRayHitN_HitN(arguments->rayhit, 1);
  RTCRayN_tfar(ray, 1, 0) = static_cast<float>(t);
  RTCHitN_u(hit, 1, 0) = static_cast<float>(root);
  RTCHitN_geomID(hit, 1, 0) = arguments->geomID;
  RTCHitN_primID(hit, 1, 0) = arguments->primID;
}

void shapeOccluded(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  double t;
  int root;
  if (hitShape(*static_cast<const Shape*>(arguments->geometryUserPtr), lineOf(arguments->ray), t,
               root))
    RTCRayN_tfar(arguments->ray, 1, 0) = -std::numeric_limits<float>::infinity();
}

float largestCoordinate(const Vec3f& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// The part of the offset that does not depend on where a ray starts.
float leastOffset(std::span<const Shape> shapes) {
  float tiltedEdge2 = 0, coordinate = 0;
  const auto look = [&](const std::vector<glm::uvec3>& triangles, const Vec3f* positions,
                        bool moves) {
    for (const glm::uvec3& t : triangles) {
      const Vec3f &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
      coordinate =
          std::max({coordinate, largestCoordinate(a), largestCoordinate(b), largestCoordinate(c)});
      // Parallel to a coordinate plane: Embree's arithmetic is exact across it.
      if (!moves &&
          ((a.x == b.x && a.x == c.x) || (a.y == b.y && a.y == c.y) || (a.z == b.z && a.z == c.z)))
        continue;
      const Vec3f e1 = b - a, e2 = c - a, e3 = c - b;
      tiltedEdge2 = std::max({tiltedEdge2, dot(e1, e1), dot(e2, e2), dot(e3, e3)});
    }
  };
  for (const Shape& shape : shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry))
      look(mesh->triangles, mesh->positions.data(), false);
    else if (const auto* moving = std::get_if<MovingMesh>(&shape.geometry))
      for (std::size_t i = 0; i < moving->positions.size(); i += moving->vertices())
        look(moving->triangles, moving->positions.data() + i, true);
  }
  return std::sqrt(tiltedEdge2) * kTriangleOffset + coordinate * kLeastOffset;
}

}  // namespace

struct RayTracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::span<const Shape> shapes;
  float slack = 0;  // the part of the offset that does not depend on where a ray starts

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  // How far from `origin` rays start along the normal.
  float offsetAt(const Vec3f& origin) const {
    return largestCoordinate(origin) * kRelativeOffset + slack;
  }
  // The origin, moved off its surface to the side that `direction` points to.
  Vec3f leave(const Vec3f& origin, const Vec3f& normal, const Vec3f& direction) const {
    const float distance = offsetAt(origin);
    return origin + normal * (dot(normal, direction) < 0 ? -distance : distance);
  }

  void attach(std::size_t index);
};

void RayTracer::Impl::attach(std::size_t index) {
  const Shape& shape = shapes[index];
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  const auto* moving = std::get_if<MovingMesh>(&shape.geometry);
  if ((mesh && mesh->triangles.empty()) || (moving && moving->triangles.empty())) return;
  const RTCGeometry geometry =
      rtcNewGeometry(device, shape.isMesh() ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
  const auto steps = static_cast<unsigned>(shape.motionSegments() + 1);
  rtcSetGeometryTimeStepCount(geometry, steps);
  if (shape.isMesh()) {
    // Copies: Embree reads a few bytes beyond the last vertex.
    const auto copy = [&](RTCBufferType type, unsigned slot, RTCFormat format, const auto& from,
                          std::size_t first, std::size_t count) {
      void* to = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(from[0]), count);
      if (to) std::memcpy(to, from.data() + first, count * sizeof(from[0]));
    };
    const auto& triangles = mesh ? mesh->triangles : moving->triangles;
    const auto& positions = mesh ? mesh->positions : moving->positions;
    const std::size_t vertices = positions.size() / steps;
    for (unsigned k = 0; k < steps; ++k)
      copy(RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT3, positions, k * vertices, vertices);
    copy(RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles, 0, triangles.size());
  } else {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));
    rtcSetGeometryBoundsFunction(geometry, shapeBounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, shapeIntersect);
    rtcSetGeometryOccludedFunction(geometry, shapeOccluded);
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(index));
  rtcReleaseGeometry(geometry);
}

RayTracer::RayTracer(std::span<const Shape> shapes) : impl_(std::make_unique<Impl>()) {
  // Embree's builder may order triangles by how its threads run. One thread always builds the same
  // tree, which gives the same hit where two triangles are equally far.
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  impl_->shapes = shapes;
  impl_->device = rtcNewDevice(nullptr);
  checkDevice(impl_->device);
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  for (std::size_t i = 0; i < shapes.size(); ++i) impl_->attach(i);
  rtcCommitScene(impl_->scene);
  checkDevice(impl_->device);
  impl_->slack = leastOffset(shapes);
}

RayTracer::~RayTracer() = default;

PrimitiveId RayTracer::intersect(const Vec3f& origin, const Vec3f& normal, const Vec3f& direction,
                                 float minDistance, float maxDistance, float time) const {
  RTCRayHit hit;
  hit.ray =
      makeRay(impl_->leave(origin, normal, direction), direction, minDistance, maxDistance, time);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!intersect1(impl_->scene, hit)) return {};
  const bool mesh = impl_->shapes[hit.hit.geomID].isMesh();
  return {hit.hit.geomID, mesh ? hit.hit.primID : static_cast<std::uint32_t>(hit.hit.u)};
}

bool RayTracer::visible(const Vec3f& from, const Vec3f& fromNormal, const Vec3f& to,
                        const Vec3f& toNormal, float time) const {
  const Vec3f segment = to - from;
  const Vec3f start = impl_->leave(from, fromNormal, segment);
  const Vec3f end = impl_->leave(to, toNormal, -segment);
  RTCRay ray = makeRay(start, end - start, 0, 1 - kShortening, time);
  return !occluded1(impl_->scene, ray);
}

bool RayTracer::escapes(const Vec3f& origin, const Vec3f& normal, const Vec3f& direction,
                        float time) const {
  RTCRay ray = makeRay(impl_->leave(origin, normal, direction), direction, 0,
                       std::numeric_limits<float>::infinity(), time);
  return !occluded1(impl_->scene, ray);
}

}  // namespace h2mc
