// SPDX-License-Identifier: MIT
// What the readers of a scene's parts share.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "render/scene/problems.h"
#include "render/scene/scene.h"
#include "render/scene/scene_document.h"

namespace h2mc {

class ElementProperties;

class ReaderContext {
 public:
  ReaderContext(const SceneDocument& sceneDocument, Scene& readScene, Strictness strictness)
      : document(sceneDocument),
        scene(readScene),
        problems(strictness, isOldVersion(sceneDocument.root), readScene.warnings) {}

  const SceneDocument& document;
  Scene& scene;
  Problems problems;
  std::map<const XmlElement*, std::vector<Shape>>
      groups;                 // shapes of those that instances refer to
  SourcePlace hidesEmitters;  // where the scene says that the camera does not see lamps

  using MeshPtr = std::shared_ptr<const MeshAttributes>;
  // The mesh that what is read now is on, if that has MeshPlaces for texture coordinates: textures and materials
  // are made for it alone.
  MeshPtr mesh;

  // Adds a line to the scene's notes, once.
  void note(const std::string& text);

  // The element that a <ref> leads to, or the element itself. SceneError for an unknown id.
  const XmlElement& resolve(const XmlElement& element);

  // The texture, or the index of the material, of an element (or of the element a <ref> leads to):
  // made when it is first asked for, and once (a texture that is used as colour and as numbers: twice).
  TexturePtr texture(const XmlElement& element, bool texelsMayBeNegative);
  int material(const XmlElement& element);
  bool isUsed(const XmlElement& element) const { return used_.count(&element) > 0; }

  // A diffuse material for shapes that name none.
  int defaultMaterial(float reflectance);

 private:
  TexturePtr vertexColors(const ElementProperties& properties, std::string_view plugin);
  int makeMaterial(const XmlElement& element);  // material_reader.cpp

  std::set<std::string> noted_;
  std::set<const XmlElement*> used_, open_;  // open: being made, to find circles of references
  // Of the element, whether texels may be negative, and the mesh.
  std::map<std::tuple<const XmlElement*, bool, MeshPtr>, TexturePtr> textures_;
  std::map<std::pair<const XmlElement*, MeshPtr>, int> materials_;
  std::map<float, int> defaults_;
};

}  // namespace h2mc
