// What the readers of a scene's parts share.
#pragma once

#include <map>
#include <set>
#include <string>

#include "render/scene/scene.h"
#include "render/scene/scene_document.h"

namespace h2mc {

class ReaderContext {
 public:
  ReaderContext(const SceneDocument& sceneDocument, Scene& readScene)
      : document(sceneDocument), scene(readScene) {}

  const SceneDocument& document;
  Scene& scene;

  // Adds a line to the scene's notes, once.
  void note(const std::string& text);

  // The element that a <ref> leads to, or the element itself. SceneError for an unknown id.
  const XmlElement& resolve(const XmlElement& element) const;

  // The texture, or the index of the material, of an element (or of the element a <ref> leads to):
  // made when it is first asked for, and once.
  TexturePtr texture(const XmlElement& element);
  int material(const XmlElement& element);
  bool isUsed(const XmlElement& element) const { return used_.count(&element) > 0; }

  // A diffuse material for shapes that name none.
  int defaultMaterial(float reflectance);

 private:
  int makeMaterial(const XmlElement& element);
  Material makeTwosided(const XmlElement& element, const BsdfPlugin& plugin);
  Material makeMask(const XmlElement& element, const BsdfPlugin& plugin);

  std::set<std::string> noted_;
  std::set<const XmlElement*> used_, open_;  // open: being made, to find circles of references
  std::map<const XmlElement*, TexturePtr> textures_;
  std::map<const XmlElement*, int> materials_;
  std::map<float, int> defaults_;
};

}  // namespace h2mc
