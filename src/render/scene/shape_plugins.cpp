// SPDX-License-Identifier: MIT
#include "render/scene/shape_plugins.h"

#include <cmath>
#include <optional>

#include "render/geometry/round_meshes.h"
#include "render/image/color_encoding.h"
#include "render/scene/change_note.h"

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
    {"toWorld", kTransform, "", "from object to world space"},
    kFlipNormals};

constexpr Parameter kCylinderParameters[] = {
    {"p0", kPoint, "0, 0, 0", "the centre of its first end, in object space"},
    {"p1", kPoint, "0, 0, 1", "that of the other end"},
    {"radius", kNumber, "1", "in object space"},
    {"toWorld", kTransform, "", "from object to world space"},
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

// The radius, times the transform's scale.
double radiusOf(const Properties& p, double scale) {
  const double radius = static_cast<double>(p.number("radius")) * scale;
  if (!(radius > 0) || !std::isfinite(static_cast<float>(radius)))
    p.fail("radius", "the radius must be positive");
  return radius;
}

// The unit mesh as `toObject` has it, for what is no sphere or cylinder in the world.
ShapeGeometry stretchedMesh(const Properties& p, MeshData mesh, const glm::dmat4& toObject,
                            const char* what) {
  const glm::dmat3 normals = normalTransform(Mat4(toObject));
  for (Vec3f& v : mesh.positions) v = Vec3f(glm::dvec3(toObject * glm::dvec4(glm::dvec3(v), 1)));
  for (Vec3f& n : mesh.normals) n = Vec3f(glm::normalize(normals * glm::dvec3(n)));
  noteChange(p, "toWorld", what,
             "a mesh of " + std::to_string(mesh.triangles.size()) + " triangles");
  MeshOptions options;
  options.rewindMirrored = true;
  return finished(p, std::move(mesh), options);
}

// None where the transform makes an ellipsoid of it.
std::optional<Sphere> makeSphere(const Properties& p, const Mat4& matrix) {
  const glm::dmat4 toWorld(matrix);
  const glm::dmat3 linear(toWorld);
  const auto uniform = uniformScale(linear);
  if (!uniform) return std::nullopt;
  const double scale = *uniform, radius = radiusOf(p, scale);
  Sphere sphere;
  sphere.center = Vec3f(glm::dvec3(toWorld * glm::dvec4(glm::dvec3(p.vector("center")), 1)));
  sphere.radius = static_cast<float>(radius);
  sphere.flipNormals = p.boolean("flipNormals");
  sphere.toLocal = glm::mat3(glm::transpose(linear / scale));
  return sphere;
}

// At rest or at the steps of its motion, within a box in object space; none where `make` has none of one.
template <class Moving, class Make>
std::optional<ShapeGeometry> atAllSteps(const Motion& motion, const glm::dvec3& low,
                                        const glm::dvec3& high, Make&& make) {
  ShapeGeometry result;
  if (!motion.moves()) {
    auto still = make(Mat4(motion.at(0)));
    if (!still) return std::nullopt;
    result.geometry = *std::move(still);
    return result;
  }
  Moving moving;
  for (const Mat4& m : motionSteps(motion, low, high, result.motionError)) {
    auto step = make(m);
    if (!step) return std::nullopt;
    moving.steps.push_back(*std::move(step));
  }
  result.geometry = std::move(moving);
  return result;
}

ShapeGeometry createSphere(const Properties& p) {
  const glm::dvec3 center(p.vector("center")), radius(static_cast<double>(p.number("radius")));
  const auto make = [&](const Mat4& m) { return makeSphere(p, m); };
  if (auto made =
          atAllSteps<MovingSphere>(p.motion("toWorld"), center - radius, center + radius, make))
    return *std::move(made);
  glm::dmat4 toObject(radiusOf(p, 1));
  toObject[3] = glm::dvec4(center, 1);
  return stretchedMesh(p, makeUnitSphere(), toObject, "an ellipsoid");
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

// From the end p0 to p1, in object space.
struct CylinderAxis {
  glm::dvec3 start, way;
  double length;
  glm::dvec3 unit, across;
};
CylinderAxis axisOf(const Properties& p) {
  CylinderAxis axis;
  axis.start = glm::dvec3(p.vector("p0"));
  axis.way = glm::dvec3(p.vector("p1")) - axis.start;
  axis.length = std::sqrt(glm::dot(axis.way, axis.way));
  if (!(axis.length > 0)) p.fail("p1", "the ends of a cylinder must not be one point");
  axis.unit = axis.way / axis.length;
  axis.across = azimuthOrigin(axis.unit);
  return axis;
}

// None where the transform makes something else of it.
std::optional<Cylinder> makeCylinder(const Properties& p, const CylinderAxis& axis,
                                     const Mat4& matrix) {
  const glm::dmat4 toWorld(matrix);
  const glm::dmat3 linear(toWorld);
  const auto scale = roundScale(linear, axis.unit, axis.across);
  if (!scale) return std::nullopt;
  Cylinder c;
  c.start = Vec3f(glm::dvec3(toWorld * glm::dvec4(axis.start, 1)));
  c.end = Vec3f(glm::dvec3(toWorld * glm::dvec4(axis.start + axis.way, 1)));
  c.radius = static_cast<float>(radiusOf(p, *scale));
  c.axisX = Vec3f(linear * axis.across / *scale);
  c.flipNormals = p.boolean("flipNormals");
  return c;
}

ShapeGeometry createCylinder(const Properties& p) {
  const CylinderAxis axis = axisOf(p);
  const glm::dvec3 end = axis.start + axis.way, radius(radiusOf(p, 1));
  const auto make = [&](const Mat4& m) { return makeCylinder(p, axis, m); };
  if (auto made =
          atAllSteps<MovingCylinder>(p.motion("toWorld"), glm::min(axis.start, end) - radius,
                                     glm::max(axis.start, end) + radius, make))
    return *std::move(made);
  glm::dmat4 toObject(1);
  toObject[0] = glm::dvec4(axis.across * radius.x, 0);
  toObject[1] = glm::dvec4(glm::cross(axis.unit, axis.across) * radius.x, 0);
  toObject[2] = glm::dvec4(axis.way, 0);
  toObject[3] = glm::dvec4(axis.start, 1);
  return stretchedMesh(p, makeUnitCylinder(), toObject, "an oval or slanting cylinder");
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
