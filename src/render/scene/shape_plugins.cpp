#include "render/scene/shape_plugins.h"

#include <cmath>

#include "render/geometry/mesh_data.h"

namespace h2mc {
namespace {

using enum ParameterType;

constexpr Parameter kToWorld = {"toWorld", kTransform, "", "from object to world space"};
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
constexpr Parameter kPly[] = {kFilename,
                              kToWorld,
                              kFaceNormals,
                              kFlipNormals,
                              {"flipTexCoords", kBoolean, "false", "v grows upwards"},
                              kMaxSmoothAngle,
                              ignoredParameter("srgb", kBoolean)};
constexpr Parameter kFlat[] = {kToWorld, kFlipNormals};
constexpr Parameter kSphereParameters[] = {
    {"center", kPoint, "0, 0, 0", "the middle, in object space"},
    {"radius", kNumber, "1", "in object space"},
    {"toWorld", kTransform, "", "from object to world space; scales alike in all directions"},
    kFlipNormals};

ShapeGeometry finished(const Properties& p, MeshData data, bool rewindMirrored) {
  MeshOptions options;
  options.toWorld = p.transform("toWorld");
  options.faceNormals = p.boolean("faceNormals");
  options.flipNormals = p.boolean("flipNormals");
  options.rewindMirrored = rewindMirrored;
  ShapeGeometry result;
  result.geometry = finishMesh(std::move(data), options, result.dropped);
  return result;
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
  return finished(p, loaded(p, [&](const std::string& path) { return loadPly(path, flip); }),
                  false);
}

ShapeGeometry createRectangle(const Properties& p) {
  return {makeRectangle(p.transform("toWorld"), p.boolean("flipNormals")), 0};
}

ShapeGeometry createCube(const Properties& p) {
  MeshOptions options;
  options.toWorld = p.transform("toWorld");
  options.flipNormals = p.boolean("flipNormals");
  ShapeGeometry result;
  result.geometry = finishMesh(makeCube(), options, result.dropped);
  return result;
}

ShapeGeometry createSphere(const Properties& p) {
  const glm::dmat4 toWorld(p.transform("toWorld"));
  const glm::dmat3 linear(toWorld);
  const double scale = glm::length(linear[0]);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(linear[i]);
    const double skew = glm::dot(linear[i], linear[(i + 1) % 3]);
    if (std::fabs(length - scale) > 1e-4 * scale || std::fabs(skew) > 1e-4 * scale * scale)
      p.fail("toWorld",
             "the transformation makes an ellipsoid of the sphere: only the same scale in all "
             "directions is supported");
  }
  const double radius = static_cast<double>(p.number("radius")) * scale;
  if (!(radius > 0) || !std::isfinite(static_cast<float>(radius)))
    p.fail("radius", "the radius of a sphere must be positive");
  Sphere sphere;
  sphere.center = Vec3f(glm::dvec3(toWorld * glm::dvec4(glm::dvec3(p.vector("center")), 1)));
  sphere.radius = static_cast<float>(radius);
  sphere.flipNormals = p.boolean("flipNormals");
  sphere.toLocal = glm::mat3(glm::transpose(linear / scale));
  return {sphere, 0};
}

ShapeGeometry createDisk(const Properties& p) {
  const Mat4 toWorld = p.transform("toWorld");
  Disk disk;
  disk.center = Vec3f(toWorld[3]);
  disk.axisX = Vec3f(toWorld[0]);
  disk.axisY = Vec3f(toWorld[1]);
  const glm::dvec3 normal = glm::normalize(normalTransform(toWorld)[2]);
  disk.normal = Vec3f(p.boolean("flipNormals") ? -normal : normal);
  return {disk, 0};
}

}  // namespace

std::span<const Plugin<ShapeGeometry>> shapePlugins() {
  static constexpr Plugin<ShapeGeometry> kPlugins[] = {
      {"serialized", "a mesh of Mitsuba's binary format", kSerialized, createSerialized},
      {"obj", "a Wavefront OBJ mesh", kObj, createObj},
      {"ply", "a Stanford polygon mesh", kPly, createPly},
      {"rectangle", "the square [-1, 1]^2 in z = 0, its normal along +z", kFlat, createRectangle},
      {"cube", "the cube [-1, 1]^3", kFlat, createCube},
      {"sphere", "a sphere", kSphereParameters, createSphere},
      {"disk", "the unit disk in z = 0, its normal along +z", kFlat, createDisk},
  };
  return kPlugins;
}

}  // namespace h2mc
