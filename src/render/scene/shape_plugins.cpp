// SPDX-License-Identifier: MIT
#include "render/scene/shape_plugins.h"

#include <cmath>

#include "render/geometry/mesh_data.h"
#include "render/image/color_encoding.h"

namespace h2mc {
namespace {

using enum ParameterType;

constexpr Parameter kToWorld = {"toWorld", kTransform, "",
                                "from object to world space; may be an <animation>"};
constexpr Parameter kFlipNormals = {"flipNormals", kBoolean, "false", "turns the normals round"};
constexpr Parameter kFilename = {"filename", kString, "", "the mesh's file"};
constexpr Parameter kFaceNormals = {"faceNormals", kBoolean, "false",
                                    "flat faces: no interpolated normals"};
constexpr Parameter kFlipTexCoords = {"flipTexCoords", kBoolean, "true", "v grows upwards"};
constexpr Parameter ignoredParameter(std::string_view name, ParameterType type) {
  return {name, type, "", "accepted and not used", "", "", true};
}
constexpr Parameter kMaxSmoothAngle = ignoredParameter("maxSmoothAngle", kNumber);

constexpr Parameter kSerialized[] = {
    kFilename,    {"shapeIndex", kInteger, "0", "which mesh of the file"},
    kToWorld,     kFaceNormals,
    kFlipNormals, kMaxSmoothAngle};
constexpr Parameter kObj[] = {kFilename,
                              kToWorld,
                              kFaceNormals,
                              kFlipNormals,
                              kFlipTexCoords,
                              kMaxSmoothAngle,
                              ignoredParameter("collapse", kBoolean),
                              ignoredParameter("loadMaterials", kBoolean)};
constexpr Parameter kPly[] = {
    kFilename,
    kToWorld,
    kFaceNormals,
    kFlipNormals,
    {"flipTexCoords", kBoolean, "false", "v grows upwards"},
    kMaxSmoothAngle,
    {"srgb", kBoolean, "",
     "whether vertex colours are sRGB; in files of version 0.x all, else those that are integers"}};
constexpr Parameter kFlat[] = {kToWorld, kFlipNormals};
constexpr Parameter kInstance[] = {
    {"toWorld", kTransform, "", "from the group's space to the world; may be an <animation>"}};
constexpr Parameter kDeforming[] = {
    {"startTime", kNumber, "", "when it has the first nested shape's form; the shutter's opening"},
    {"endTime", kNumber, "", "when it has the last one's; the shutter's closing"}};
constexpr Parameter kSphereParameters[] = {
    {"center", kPoint, "0, 0, 0", "the middle, in object space"},
    {"radius", kNumber, "1", "in object space"},
    {"toWorld", kTransform, "", "from object to world space; scales alike in all directions"},
    kFlipNormals};

constexpr Parameter kCylinderParameters[] = {
    {"p0", kPoint, "0, 0, 0", "the centre of its first end, in object space"},
    {"p1", kPoint, "0, 0, 1", "that of the other end"},
    {"radius", kNumber, "1", "in object space"},
    {"toWorld", kTransform, "", "from object to world space; scales alike in all directions"},
    kFlipNormals};

// The transforms at a motion's steps, for what lies in the box [low, high].
std::vector<Mat4> motionSteps(const Motion& motion, const glm::dvec3& low, const glm::dvec3& high,
                              double& error) {
  const int segments = motionSegments(motion, low, high, error);
  std::vector<Mat4> steps;
  for (int i = 0; i <= segments; ++i)
    steps.emplace_back(motion.at(static_cast<double>(i) / segments));
  return steps;
}

ShapeGeometry finished(const Properties& p, MeshData data, MeshOptions options) {
  const Motion motion = p.motion("toWorld");
  options.toWorld = Mat4(motion.at(0));
  options.flipNormals = p.boolean("flipNormals");
  ShapeGeometry result;
  if (motion.moves()) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const Vec3f& v : data.positions) {
      low = glm::min(low, glm::dvec3(v));
      high = glm::max(high, glm::dvec3(v));
    }
    result.geometry = finishMovingMesh(
        data, options, motionSteps(motion, low, high, result.motionError), result.dropped);
  } else {
    result.geometry = finishMesh(std::move(data), options, result.dropped);
  }
  return result;
}

// Of a mesh from a file.
ShapeGeometry finished(const Properties& p, MeshData data, bool rewindMirrored) {
  MeshOptions options;
  options.faceNormals = p.boolean("faceNormals");
  options.rewindMirrored = rewindMirrored;
  return finished(p, std::move(data), options);
}

// What a loader finds wrong is said at the file's name.
template <class Load>
MeshData loaded(const Properties& p, Load load) {
  const std::string path = p.file("filename");
  try {
    return load(path);
  } catch (const MeshError& e) {
    p.fail("filename", std::string("broken mesh: ") + e.what());
    throw;  // not reached
  }
}

ShapeGeometry createSerialized(const Properties& p) {
  const int index = p.integer("shapeIndex");
  if (index < 0) p.fail("shapeIndex", "shapeIndex must not be negative");
  return finished(
      p, loaded(p, [&](const std::string& path) { return loadSerialized(path, index); }), true);
}

ShapeGeometry createObj(const Properties& p) {
  const bool flip = p.boolean("flipTexCoords");
  return finished(p, loaded(p, [&](const std::string& path) { return loadObj(path, flip); }),
                  false);
}

ShapeGeometry createPly(const Properties& p) {
  const bool flip = p.boolean("flipTexCoords");
  MeshData data = loaded(p, [&](const std::string& path) { return loadPly(path, flip); });
  if (p.given("srgb") ? p.boolean("srgb") : p.isOldVersion() || data.integerColors)
    for (Rgbf& c : data.colors) c = {srgbToLinear(c.x), srgbToLinear(c.y), srgbToLinear(c.z)};
  return finished(p, std::move(data), false);
}

ShapeGeometry createRectangle(const Properties& p) {
  const Motion motion = p.motion("toWorld");
  const bool flip = p.boolean("flipNormals");
  ShapeGeometry result;
  if (motion.moves()) {
    std::vector<TriangleMesh> steps;
    for (const Mat4& m : motionSteps(motion, {-1, -1, 0}, {1, 1, 0}, result.motionError))
      steps.push_back(makeRectangle(m, flip));
    result.geometry = joinSteps(std::move(steps));
  } else {
    result.geometry = makeRectangle(Mat4(motion.at(0)), flip);
  }
  return result;
}

ShapeGeometry createCube(const Properties& p) { return finished(p, makeCube(), MeshOptions()); }

// The one scale of a transform's linear part; fails where there are several. `made`: what it would make.
double uniformScale(const Properties& p, const glm::dmat3& linear, const std::string& made) {
  const double scale = glm::length(linear[0]);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(linear[i]);
    const double skew = glm::dot(linear[i], linear[(i + 1) % 3]);
    if (std::fabs(length - scale) > 1e-4 * scale || std::fabs(skew) > 1e-4 * scale * scale)
      p.fail("toWorld", "the transformation makes " + made +
                            ": only the same scale in all directions is supported");
  }
  return scale;
}

Sphere makeSphere(const Properties& p, const Mat4& matrix) {
  const glm::dmat4 toWorld(matrix);
  const glm::dmat3 linear(toWorld);
  const double scale = uniformScale(p, linear, "an ellipsoid of the sphere");
  const double radius = static_cast<double>(p.number("radius")) * scale;
  if (!(radius > 0) || !std::isfinite(static_cast<float>(radius)))
    p.fail("radius", "the radius of a sphere must be positive");
  Sphere sphere;
  sphere.center = Vec3f(glm::dvec3(toWorld * glm::dvec4(glm::dvec3(p.vector("center")), 1)));
  sphere.radius = static_cast<float>(radius);
  sphere.flipNormals = p.boolean("flipNormals");
  sphere.toLocal = glm::mat3(glm::transpose(linear / scale));
  return sphere;
}

ShapeGeometry createSphere(const Properties& p) {
  const Motion motion = p.motion("toWorld");
  if (!motion.moves()) return {makeSphere(p, Mat4(motion.at(0)))};
  ShapeGeometry result;
  const glm::dvec3 center(p.vector("center")), radius(static_cast<double>(p.number("radius")));
  MovingSphere moving;
  for (const Mat4& m : motionSteps(motion, center - radius, center + radius, result.motionError))
    moving.steps.push_back(makeSphere(p, m));
  result.geometry = std::move(moving);
  return result;
}

Disk makeDisk(const Properties& p, const Mat4& toWorld) {
  Disk disk;
  disk.center = Vec3f(toWorld[3]);
  disk.axisX = Vec3f(toWorld[0]);
  disk.axisY = Vec3f(toWorld[1]);
  const glm::dvec3 normal = glm::normalize(normalTransform(toWorld)[2]);
  disk.normal = Vec3f(p.boolean("flipNormals") ? -normal : normal);
  return disk;
}

ShapeGeometry createDisk(const Properties& p) {
  const Motion motion = p.motion("toWorld");
  if (!motion.moves()) return {makeDisk(p, Mat4(motion.at(0)))};
  ShapeGeometry result;
  MovingDisk moving;
  for (const Mat4& m : motionSteps(motion, {-1, -1, 0}, {1, 1, 0}, result.motionError))
    moving.steps.push_back(makeDisk(p, m));
  result.geometry = std::move(moving);
  return result;
}

// Across `a`: where Mitsuba 0.6 has its cylinders' azimuth 0, before they are transformed.
glm::dvec3 azimuthOrigin(const glm::dvec3& a) {
  const glm::dvec3 t = std::abs(a.x) > std::abs(a.y)
                           ? glm::dvec3(a.z, 0, -a.x) / std::sqrt(a.x * a.x + a.z * a.z)
                           : glm::dvec3(0, a.z, -a.y) / std::sqrt(a.y * a.y + a.z * a.z);
  return glm::cross(t, a);
}

Cylinder makeCylinder(const Properties& p, const Mat4& matrix) {
  const glm::dmat4 toWorld(matrix);
  const glm::dmat3 linear(toWorld);
  const double scale = uniformScale(p, linear, "a cylinder that is not round");
  const double radius = static_cast<double>(p.number("radius")) * scale;
  if (!(radius > 0) || !std::isfinite(static_cast<float>(radius)))
    p.fail("radius", "the radius of a cylinder must be positive");
  const glm::dvec3 start(p.vector("p0")), way = glm::dvec3(p.vector("p1")) - start;
  const double length = std::sqrt(glm::dot(way, way));
  if (!(length > 0)) p.fail("p1", "the ends of a cylinder must not be one point");
  Cylinder c;
  c.start = Vec3f(glm::dvec3(toWorld * glm::dvec4(start, 1)));
  c.end = Vec3f(glm::dvec3(toWorld * glm::dvec4(start + way, 1)));
  c.radius = static_cast<float>(radius);
  c.axisX = Vec3f(linear * azimuthOrigin(way / length) / scale);
  c.flipNormals = p.boolean("flipNormals");
  return c;
}

ShapeGeometry createCylinder(const Properties& p) {
  const Motion motion = p.motion("toWorld");
  if (!motion.moves()) return {makeCylinder(p, Mat4(motion.at(0)))};
  ShapeGeometry result;
  const glm::dvec3 a(p.vector("p0")), b(p.vector("p1"));
  const glm::dvec3 radius(static_cast<double>(p.number("radius")));
  MovingCylinder moving;
  for (const Mat4& m :
       motionSteps(motion, glm::min(a, b) - radius, glm::max(a, b) + radius, result.motionError))
    moving.steps.push_back(makeCylinder(p, m));
  result.geometry = std::move(moving);
  return result;
}

}  // namespace

std::vector<ShapePart> readObjParts(const Properties& p) {
  const bool flip = p.boolean("flipTexCoords");
  const MeshData whole = loaded(p, [&](const std::string& path) { return loadObj(path, flip); });
  std::vector<ShapePart> parts;
  for (MeshData& part : splitByMaterial(whole)) {
    const std::string name = part.materialNames.empty() ? "" : part.materialNames.front();
    parts.push_back({name, finished(p, std::move(part), false)});
  }
  return parts;
}

std::span<const Plugin<ShapeGeometry>> shapePlugins() {
  static constexpr Plugin<ShapeGeometry> kPlugins[] = {
      {"serialized", "a mesh of Mitsuba's binary format", kSerialized, createSerialized},
      {"obj", "a Wavefront OBJ mesh", kObj, createObj},
      {"ply", "a Stanford polygon mesh", kPly, createPly},
      {"rectangle", "the square [-1, 1]^2 in z = 0, its normal along +z", kFlat, createRectangle},
      {"cube", "the cube [-1, 1]^3", kFlat, createCube},
      {"sphere", "a sphere", kSphereParameters, createSphere},
      {"disk", "the unit disk in z = 0, its normal along +z", kFlat, createDisk},
      {"cylinder", "an open cylinder, its normals outwards", kCylinderParameters, createCylinder},
      {"deforming", "two or more nested meshes of the same triangles, taken in turn at equal times",
       kDeforming, nullptr},
      {"shapegroup",
       "nested shapes that are nowhere themselves, for instances to refer to",
       {},
       nullptr},
      {"instance", "a copy of a shape group, which shares its meshes", kInstance, nullptr},
  };
  return kPlugins;
}

}  // namespace h2mc
