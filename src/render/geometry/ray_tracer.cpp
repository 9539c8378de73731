// SPDX-License-Identifier: MIT
#include "render/geometry/ray_tracer.h"

#include <tbb/global_control.h>

#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/geometry/exact_hit.h"
#include "render/geometry/ray_offset.h"

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

Segment segmentOf(RTCRayN* ray) {
  return {{RTCRayN_org_x(ray, 1, 0), RTCRayN_org_y(ray, 1, 0), RTCRayN_org_z(ray, 1, 0)},
          {RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0), RTCRayN_dir_z(ray, 1, 0)},
          RTCRayN_tnear(ray, 1, 0),
          RTCRayN_tfar(ray, 1, 0),
          RTCRayN_time(ray, 1, 0)};
}

// The box, a little larger: for rounding of this and of the traversal.
void setBounds(const Vec3f& lower, const Vec3f& upper, RTCBounds& b) {
  const Vec3f margin = (glm::max(glm::abs(lower), glm::abs(upper)) + (upper - lower)) * 1e-6f;
  b.lower_x = lower.x - margin.x;
  b.lower_y = lower.y - margin.y;
  b.lower_z = lower.z - margin.z;
  b.upper_x = upper.x + margin.x;
  b.upper_y = upper.y + margin.y;
  b.upper_z = upper.z + margin.z;
}

void setHit(const RTCIntersectFunctionNArguments* arguments, double t, std::uint32_t root) {
  RTCHitN* hit = RTCRayHitN_HitN(arguments->rayhit, 1);
  RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, 1), 1, 0) = static_cast<float>(t);
  RTCHitN_u(hit, 1, 0) = static_cast<float>(root);
  RTCHitN_geomID(hit, 1, 0) = arguments->geomID;
  RTCHitN_primID(hit, 1, 0) = arguments->primID;
}

void setOccluded(RTCRayN* ray) {
  RTCRayN_tfar(ray, 1, 0) = -std::numeric_limits<float>::infinity();
}

// Spheres, disks and cylinders: the user's data is the Shape.

void roundBounds(const RTCBoundsFunctionArguments* arguments) {
  const Geometry& geometry = static_cast<const Shape*>(arguments->geometryUserPtr)->geometry;
  const std::size_t step = arguments->timeStep;
  const auto* sphere = std::get_if<Sphere>(&geometry);
  if (const auto* moving = std::get_if<MovingSphere>(&geometry)) sphere = &moving->steps[step];
  const auto* cylinder = std::get_if<Cylinder>(&geometry);
  if (const auto* moving = std::get_if<MovingCylinder>(&geometry)) cylinder = &moving->steps[step];
  Vec3f center, extent;
  if (cylinder) {
    center = (cylinder->start + cylinder->end) * 0.5f;
    extent = glm::abs(cylinder->end - cylinder->start) * 0.5f + cylinder->radius;
  } else if (sphere) {
    center = sphere->center;
    extent = Vec3f(sphere->radius);
  } else {
    const auto* disk = std::get_if<Disk>(&geometry);
    if (const auto* moving = std::get_if<MovingDisk>(&geometry)) disk = &moving->steps[step];
    center = disk->center;
    extent = glm::sqrt(disk->axisX * disk->axisX + disk->axisY * disk->axisY);
  }
  setBounds(center - extent, center + extent, *arguments->bounds_o);
}

void roundIntersect(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  double t;
  std::uint32_t root;
  if (hitRound(*static_cast<const Shape*>(arguments->geometryUserPtr),
               segmentOf(RTCRayHitN_RayN(arguments->rayhit, 1)), t, root))
    setHit(arguments, t, root);
}

void roundOccluded(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  double t;
  std::uint32_t root;
  if (hitRound(*static_cast<const Shape*>(arguments->geometryUserPtr), segmentOf(arguments->ray), t,
               root))
    setOccluded(arguments->ray);
}

// A mesh's vast triangles: a geometry of their own beside the rest of the mesh.
struct VastTriangles {
  const Shape* shape;
  std::uint32_t index;  // of the shape
  std::span<const std::uint32_t> triangles;
};

void vastBounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& vast = *static_cast<const VastTriangles*>(arguments->geometryUserPtr);
  const std::uint32_t triangle = vast.triangles[arguments->primID];
  const auto bound = [&](const glm::uvec3& t, const Vec3f* p) {
    setBounds(glm::min(p[t.x], glm::min(p[t.y], p[t.z])),
              glm::max(p[t.x], glm::max(p[t.y], p[t.z])), *arguments->bounds_o);
  };
  if (const auto* mesh = std::get_if<TriangleMesh>(&vast.shape->geometry)) {
    bound(mesh->triangles[triangle], mesh->positions.data());
  } else {
    const auto& moving = std::get<MovingMesh>(vast.shape->geometry);
    bound(moving.triangles[triangle],
          moving.positions.data() + arguments->timeStep * moving.vertices());
  }
}

void vastIntersect(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const auto& vast = *static_cast<const VastTriangles*>(arguments->geometryUserPtr);
  double t;
  if (hitTriangle(*vast.shape, vast.triangles[arguments->primID],
                  segmentOf(RTCRayHitN_RayN(arguments->rayhit, 1)), t))
    setHit(arguments, t, 0);
}

void vastOccluded(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const auto& vast = *static_cast<const VastTriangles*>(arguments->geometryUserPtr);
  double t;
  if (hitTriangle(*vast.shape, vast.triangles[arguments->primID], segmentOf(arguments->ray), t))
    setOccluded(arguments->ray);
}

}  // namespace

struct RayTracer::Impl {
  explicit Impl(std::span<const Shape> s) : shapes(s), offset(s) {}
  ~Impl() {
    for (const auto& [mesh, shared] : meshes) rtcReleaseScene(shared);
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void attach(std::size_t index);
  void attachMesh(std::size_t index);
  void attachVast(std::size_t index);
  void attachInstance(std::size_t index);
  RTCScene newScene() const;
  // A geometry of triangles, their vertices at `steps` moments one after another.
  RTCGeometry triangles(std::span<const glm::uvec3> indices, const std::vector<Vec3f>& positions,
                        unsigned steps) const;
  // Commits it and gives it up to a scene.
  static void add(RTCScene to, RTCGeometry geometry, std::size_t id);

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::span<const Shape> shapes;
  RayOffset offset;
  std::deque<VastTriangles> vast;  // geometries shapes.size() and on
  std::map<const SharedMesh*, RTCScene> meshes;
};

RTCScene RayTracer::Impl::newScene() const {
  const RTCScene made = rtcNewScene(device);
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
  return made;
}

void RayTracer::Impl::add(RTCScene to, RTCGeometry geometry, std::size_t id) {
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to, geometry, static_cast<unsigned>(id));
  rtcReleaseGeometry(geometry);
}

void RayTracer::Impl::attachMesh(std::size_t index) {
  const Shape& shape = shapes[index];
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  const auto* moving = std::get_if<MovingMesh>(&shape.geometry);
  std::vector<glm::uvec3> triangles = mesh ? mesh->triangles : moving->triangles;
  if (triangles.size() == offset.vast(index).size()) return;
  // Points, which no ray meets.
  for (const std::uint32_t i : offset.vast(index)) triangles[i] = glm::uvec3(triangles[i].x);
  add(scene,
      this->triangles(triangles, mesh ? mesh->positions : moving->positions,
                      static_cast<unsigned>(shape.motionSegments() + 1)),
      index);
}

RTCGeometry RayTracer::Impl::triangles(std::span<const glm::uvec3> indices,
                                       const std::vector<Vec3f>& positions, unsigned steps) const {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryTimeStepCount(geometry, steps);
  // Copies: Embree reads a few bytes beyond the last vertex.
  const auto copy = [&](RTCBufferType type, unsigned slot, RTCFormat format, const auto& from,
                        std::size_t first, std::size_t count) {
    void* to = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(from[0]), count);
    if (to) std::memcpy(to, from.data() + first, count * sizeof(from[0]));
  };
  const std::size_t vertices = positions.size() / steps;
  for (unsigned k = 0; k < steps; ++k)
    copy(RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT3, positions, k * vertices, vertices);
  copy(RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices, 0, indices.size());
  return geometry;
}

// The mesh is a scene of its own, once for all its instances.
void RayTracer::Impl::attachInstance(std::size_t index) {
  const SharedMesh* const shared = shapes[index].sharedMesh();
  RTCScene& inner = meshes[shared];
  if (!inner) {
    inner = newScene();
    add(inner, triangles(shared->mesh.triangles, shared->mesh.positions, 1), 0);
    rtcCommitScene(inner);
  }
  const std::span<const Placement> steps = shapes[index].placements();
  const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, inner);
  rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(steps.size()));
  for (unsigned k = 0; k < steps.size(); ++k) {
    const Mat4 toWorld(steps[k].toWorld());
    rtcSetGeometryTransform(instance, k, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &toWorld[0][0]);
  }
  add(scene, instance, index);
}

void RayTracer::Impl::attachVast(std::size_t index) {
  const std::span<const std::uint32_t> triangles = offset.vast(index);
  if (triangles.empty()) return;
  vast.push_back({&shapes[index], static_cast<std::uint32_t>(index), triangles});
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(shapes[index].motionSegments() + 1));
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(triangles.size()));
  rtcSetGeometryUserData(geometry, &vast.back());
  rtcSetGeometryBoundsFunction(geometry, vastBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, vastIntersect);
  rtcSetGeometryOccludedFunction(geometry, vastOccluded);
  add(scene, geometry, shapes.size() + vast.size() - 1);
}

void RayTracer::Impl::attach(std::size_t index) {
  const Shape& shape = shapes[index];
  if (shape.isInstance()) {
    attachInstance(index);
    return;
  }
  if (shape.isMesh()) {
    attachMesh(index);
    attachVast(index);
    return;
  }
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(shape.motionSegments() + 1));
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));
  rtcSetGeometryBoundsFunction(geometry, roundBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, roundIntersect);
  rtcSetGeometryOccludedFunction(geometry, roundOccluded);
  add(scene, geometry, index);
}

RayTracer::RayTracer(std::span<const Shape> shapes) : impl_(std::make_unique<Impl>(shapes)) {
  // Embree's builder may order triangles by how its threads run. One thread always builds the same
  // tree, which gives the same hit where two triangles are equally far.
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  impl_->device = rtcNewDevice(nullptr);
  checkDevice(impl_->device);
  impl_->scene = impl_->newScene();
  for (std::size_t i = 0; i < shapes.size(); ++i) impl_->attach(i);
  rtcCommitScene(impl_->scene);
  checkDevice(impl_->device);
}

RayTracer::~RayTracer() = default;

PrimitiveId RayTracer::intersect(const RayEnd& from, const Vec3f& direction, float minDistance,
                                 float maxDistance, float time) const {
  RTCRayHit hit;
  hit.ray =
      makeRay(impl_->offset.leave(from, direction), direction, minDistance, maxDistance, time);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!intersect1(impl_->scene, hit)) return {};
  if (const std::size_t shapes = impl_->shapes.size();
      hit.hit.instID[0] == RTC_INVALID_GEOMETRY_ID && hit.hit.geomID >= shapes) {
    const VastTriangles& vast = impl_->vast[hit.hit.geomID - shapes];
    return {vast.index, vast.triangles[hit.hit.primID]};
  }
  if (hit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) return {hit.hit.instID[0], hit.hit.primID};
  const bool mesh = impl_->shapes[hit.hit.geomID].isMesh();
  return {hit.hit.geomID, mesh ? hit.hit.primID : static_cast<std::uint32_t>(hit.hit.u)};
}

bool RayTracer::visible(const RayEnd& from, const RayEnd& to, float time) const {
  if (RayOffset::inPlane(from, to.p) || RayOffset::inPlane(to, from.p)) return false;
  const Vec3f segment = to.p - from.p;
  const Vec3f start = impl_->offset.leave(from, segment);
  const Vec3f end = impl_->offset.leave(to, -segment);
  RTCRay ray = makeRay(start, end - start, 0, 1 - kShortening, time);
  return !occluded1(impl_->scene, ray);
}

bool RayTracer::escapes(const RayEnd& from, const Vec3f& direction, float time) const {
  RTCRay ray = makeRay(impl_->offset.leave(from, direction), direction, 0,
                       std::numeric_limits<float>::infinity(), time);
  return !occluded1(impl_->scene, ray);
}

}  // namespace h2mc
