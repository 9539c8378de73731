// SPDX-License-Identifier: MIT
// Shape groups, and the instances that put copies of them into the scene. Meshes are shared by all copies; spheres,
// disks and cylinders, which are small, are copied.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/geometry/placed_mesh.h"
#include "render/geometry/round_meshes.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// The unit mesh that is stretched to what is no sphere or cylinder any more; one with its normals inwards.
struct UnitMeshes {
  std::shared_ptr<const SharedMesh> outwards, inwards;

  explicit UnitMeshes(const MeshData& data)
      : outwards(shared(data, false)), inwards(shared(data, true)) {}
  const std::shared_ptr<const SharedMesh>& facing(bool in) const { return in ? inwards : outwards; }

 private:
  static std::shared_ptr<const SharedMesh> shared(const MeshData& data, bool flip) {
    MeshOptions options;
    options.flipNormals = flip;
    std::size_t dropped = 0;
    return std::make_shared<const SharedMesh>(finishMesh(data, options, dropped));
  }
};
const UnitMeshes& unitSpheres() {
  static const UnitMeshes meshes(makeUnitSphere());
  return meshes;
}
const UnitMeshes& unitCylinders() {
  static const UnitMeshes meshes(makeUnitCylinder());
  return meshes;
}

bool mirrors(const glm::dmat3& m) { return !(glm::determinant(m) > 0); }

std::optional<Sphere> placed(const Sphere& sphere, const Placement& placement) {
  const glm::dmat3 m(placement.toWorld());
  const auto scale = uniformScale(m);
  if (!scale || mirrors(m)) return std::nullopt;
  Sphere result = sphere;
  result.center = Vec3f(placement.point(glm::dvec3(sphere.center)));
  result.radius = static_cast<float>(static_cast<double>(sphere.radius) * *scale);
  result.toLocal = glm::mat3(glm::dmat3(sphere.toLocal) * glm::transpose(m / *scale));
  return result;
}

std::optional<Disk> placed(const Disk& disk, const Placement& placement) {
  const glm::dmat3 m(placement.toWorld());
  Disk result = disk;
  result.center = Vec3f(placement.point(glm::dvec3(disk.center)));
  result.axisX = Vec3f(m * glm::dvec3(disk.axisX));
  result.axisY = Vec3f(m * glm::dvec3(disk.axisY));
  result.normal = Vec3f(placement.normal(disk.normal));
  return result;
}

std::optional<Cylinder> placed(const Cylinder& cylinder, const Placement& placement) {
  const glm::dmat3 m(placement.toWorld());
  const glm::dvec3 way = glm::dvec3(cylinder.end) - glm::dvec3(cylinder.start);
  const auto scale = roundScale(m, glm::normalize(way), glm::dvec3(cylinder.axisX));
  if (!scale || mirrors(m)) return std::nullopt;
  Cylinder result = cylinder;
  result.start = Vec3f(placement.point(glm::dvec3(cylinder.start)));
  result.end = Vec3f(placement.point(glm::dvec3(cylinder.end)));
  result.radius = static_cast<float>(static_cast<double>(cylinder.radius) * *scale);
  result.axisX = Vec3f(m * glm::dvec3(cylinder.axisX) / *scale);
  return result;
}

// The shape at each step; none where one can't be had.
template <class Moving, class Still>
std::optional<Geometry> placedAtAll(const Still& still, const std::vector<Placement>& steps) {
  Moving moving;
  for (const Placement& step : steps) {
    auto one = placed(still, step);
    if (!one) return std::nullopt;
    if (steps.size() == 1) return *one;
    moving.steps.push_back(*std::move(one));
  }
  return moving;
}

Geometry instanceOf(std::shared_ptr<const SharedMesh> shared, std::vector<Placement> steps) {
  if (steps.size() == 1) return MeshInstance{std::move(shared), steps[0]};
  return MovingMeshInstance{std::move(shared), std::move(steps)};
}

// What toWorld makes of a group's shape.
Geometry placedGeometry(const Shape& shape, const std::vector<Placement>& steps) {
  if (const SharedMesh* shared = shape.sharedMesh(); shared)
    return instanceOf(std::get<MeshInstance>(shape.geometry).shared, steps);
  if (const auto* disk = std::get_if<Disk>(&shape.geometry))
    return *placedAtAll<MovingDisk>(*disk, steps);
  // What the unit mesh becomes, where it is no sphere or cylinder any more.
  const auto stretched = [&](const UnitMeshes& meshes, bool inwards, const glm::dmat4& toGroup) {
    std::vector<Placement> ofUnit;
    ofUnit.reserve(steps.size());
    for (const Placement& step : steps) ofUnit.emplace_back(Mat4(step.toWorld() * toGroup));
    return instanceOf(meshes.facing(inwards), std::move(ofUnit));
  };
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) {
    if (auto made = placedAtAll<MovingCylinder>(*cylinder, steps)) return *std::move(made);
    const glm::dvec3 start(cylinder->start), way = glm::dvec3(cylinder->end) - start;
    const glm::dvec3 x = glm::dvec3(cylinder->axisX) * static_cast<double>(cylinder->radius);
    glm::dmat4 toGroup(1);
    toGroup[0] = glm::dvec4(x, 0);
    toGroup[1] = glm::dvec4(glm::cross(glm::normalize(way), x), 0);
    toGroup[2] = glm::dvec4(way, 0);
    toGroup[3] = glm::dvec4(start, 1);
    return stretched(unitCylinders(), cylinder->flipNormals, toGroup);
  }
  const auto& sphere = std::get<Sphere>(shape.geometry);
  if (auto made = placedAtAll<MovingSphere>(sphere, steps)) return *std::move(made);
  glm::dmat4 toGroup(glm::transpose(glm::dmat3(sphere.toLocal)) *
                     static_cast<double>(sphere.radius));
  toGroup[3] = glm::dvec4(glm::dvec3(sphere.center), 1);
  return stretched(unitSpheres(), sphere.flipNormals, toGroup);
}

std::vector<Placement> stepsOf(const Properties& p, const Shape& shape, double& error) {
  const Motion motion = p.motion("toWorld");
  std::vector<Placement> steps;
  if (!motion.moves()) {
    steps.emplace_back(Mat4(motion.at(0)));
    return steps;
  }
  const SceneBounds bounds = boundsOf({&shape, 1});
  const glm::dvec3 center(bounds.center), radius(static_cast<double>(bounds.radius));
  const int segments = motionSegments(motion, center - radius, center + radius, error);
  for (int i = 0; i <= segments; ++i)
    steps.emplace_back(Mat4(motion.at(static_cast<double>(i) / segments)));
  return steps;
}

// What float rays in the group's space can be trusted with.
void checkPlacement(const Properties& p, const Placement& placement) {
  constexpr double kWorst = 1e5;
  if (!(stretchOf(placement).condition <= kWorst))
    p.fail("toWorld", fmt::format("the transformation flattens the group: expected scales that "
                                  "differ by a factor of up to {:g}",
                                  kWorst));
}

// The group's shapes, as if it were the scene.
std::vector<Shape> readGroup(ReaderContext& context, const XmlElement& group) {
  const ElementProperties properties(context, group, {"shape", {}, 0, {"shape"}, false});
  std::vector<Shape> shapes;
  for (const XmlElement& child : group.children) {
    if (child.name != "shape") continue;
    const std::string type = lowerCase(child.require("type"));
    if (isOneOf(type, {"shapegroup", "instance"}))
      throw sourceError(child.place("type"), "\"" + type + "\" inside a shapegroup",
                        "expected shapes of their own");
    for (const XmlElement& part : child.children)
      if (isEmitter(context.resolve(part)))
        throw sourceError(part.place(), "an emitter inside a shapegroup",
                          "expected emitters outside: instances don't emit");
    std::vector<Shape>& all = context.scene.shapes;
    const std::size_t before = all.size();
    readShape(context, child);
    for (std::size_t i = before; i < all.size(); ++i) {
      if (all[i].moves())
        throw sourceError(child.place(), "an <animation> inside a shapegroup",
                          "expected it in the instances");
      checkExtent(child, all[i]);
      if (auto* mesh = std::get_if<TriangleMesh>(&all[i].geometry))
        all[i].geometry =
            MeshInstance{std::make_shared<const SharedMesh>(std::move(*mesh)), Placement(Mat4(1))};
      shapes.push_back(std::move(all[i]));
    }
    all.resize(before);
  }
  if (shapes.empty())
    throw sourceError(group.place(), "a shapegroup without shapes",
                      "expected <shape> elements inside");
  return shapes;
}

}  // namespace

void readInstance(ReaderContext& context, const XmlElement& element) {
  const auto& plugin = findPlugin(shapePlugins(), element, "shape");
  const ElementProperties p(context, element, {"shape", plugin.parameters, 0, {"shape"}, false});
  const XmlElement* group = nullptr;
  for (const XmlElement& child : element.children) {
    const XmlElement& target = context.resolve(child);
    if (target.name != "shape") continue;
    if (group || lowerCase(target.attribute("type")) != "shapegroup")
      throw sourceError(child.place(), "an instance is of one shapegroup",
                        "expected <ref id=\"...\"/> to a <shape type=\"shapegroup\">");
    group = &target;
  }
  if (!group)
    throw sourceError(element.place(), "an instance of nothing",
                      "expected <ref id=\"...\"/> to a <shape type=\"shapegroup\">");
  const auto [entry, isNew] = context.groups.try_emplace(group);
  if (isNew) entry->second = readGroup(context, *group);
  const std::string id = element.attribute("id");
  for (const Shape& shape : entry->second) {
    double error = 0;
    const std::vector<Placement> steps = stepsOf(p, shape, error);
    for (const Placement& step : steps) checkPlacement(p, step);
    Shape copy;
    copy.name = (id.empty() ? "instance" : id) + " of " + shape.name;
    copy.material = shape.material;
    copy.geometry = placedGeometry(shape, steps);
    noteMotionError(context, copy.name, error);
    context.scene.shapes.push_back(std::move(copy));
  }
}

}  // namespace h2mc
