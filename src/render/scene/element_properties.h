// SPDX-License-Identifier: MIT
// The parameters of an element of a scene file, checked against a plugin's table.
#pragma once

#include <span>
#include <vector>

#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/reader_context.h"
#include "render/scene/suggestion.h"
#include "render/scene/xml_document.h"

namespace h2mc {

// What to check an element against. Names of parameters are accepted as the table spells them, in
// snake_case and as otherName.
struct ElementTable {
  std::string kind;  // "bsdf", for messages
  std::span<const Parameter> parameters;
  int nestedBsdfs = 0;               // <bsdf> or <ref> to one, without a parameter's name
  std::vector<std::string> objects;  // further elements that the caller reads itself
  bool acceptUnknown = false;        // a parameter the table lacks is noted, not an error
  bool texelsMayBeNegative = false;  // as Properties has it
};

class ElementProperties : public Properties, public ChangeListener {
 public:
  // Checks every child: known, given once, of the right type, with a value that can be read.
  // Textures, files and nested BSDFs are not made before they are asked for. Adds all that is wrong to
  // the context's problems, and throws the first of it (SceneError).
  ElementProperties(ReaderContext& context, const XmlElement& element, ElementTable table);

  bool given(std::string_view name) const override;
  bool boolean(std::string_view name) const override;
  int integer(std::string_view name) const override;
  float number(std::string_view name) const override;
  std::string string(std::string_view name) const override;
  Rgbf color(std::string_view name) const override;
  TexturePtr texture(std::string_view name) const override;
  bool texelsMayBeNegative() const override { return table_.texelsMayBeNegative; }
  Vec3f vector(std::string_view name) const override;
  Mat4 transform(std::string_view name) const override;
  Motion motion(std::string_view name) const override;
  bool isOldVersion() const override;
  std::string file(std::string_view name) const override;
  int nestedBsdfCount() const override { return static_cast<int>(nested_.size()); }
  int nestedBsdf(int index) const override;
  void warn(std::string_view name, const std::string& message) const override;
  void tolerate(std::string_view name, const std::string& message,
                const std::string& hint) const override;
  void refuse(std::string_view name, const std::string& message,
              const std::string& instead) const override;
  const Material& material(int index) const override;
  void changed(std::string_view name, const std::string& given,
               const std::string& used) const override;
  [[noreturn]] void fail(std::string_view name, const std::string& message) const override;
  [[noreturn]] void fail(std::string_view name, const std::string& message,
                         const std::string& hint) const;

  const XmlElement& element() const { return element_; }
  const std::string& kind() const { return table_.kind; }
  // As in the file, in lower case.
  const std::string& type() const { return type_; }
  // kind and type as messages name them: bsdf "diffuse"
  std::string description() const;
  const XmlElement& nestedElement(int index) const { return *nested_[index]; }
  // The element that gave the parameter; null when none did.
  const XmlElement* source(std::string_view name) const;
  SourcePlace placeOf(std::string_view name) const;  // of its value, or of the element

 private:
  void readChild(const XmlElement& child);
  // Others are leftovers.
  void allowAttributes(const XmlElement& element,
                       std::initializer_list<std::string_view> names) const;
  const Parameter& find(std::string_view name) const;
  const Parameter* match(std::string_view written) const;
  // The parameter that takes a texture by any name; null where there is none, or no texture.
  const Parameter* unnamedTexture(const XmlElement& child) const;
  void readParameter(const XmlElement& child);
  void checkValue(const Parameter& parameter, const XmlElement& child) const;
  Names parameterNames() const;
  // The text of a value: the child's or the table's default.
  std::string text(const Parameter& parameter) const;
  template <class Parse>
  auto parse(std::string_view name, Parse parse) const;

  ReaderContext& context_;
  const XmlElement& element_;
  ElementTable table_;
  std::string type_;
  std::vector<std::pair<const Parameter*, const XmlElement*>> given_;
  std::vector<const XmlElement*> nested_;
};

// Whether an element is a parameter by its name: boolean, float, rgb, ...
bool isParameterElement(const XmlElement& element);
// Whether it is a <texture>, or Mitsuba 2's way of writing one, a <spectrum> with a type.
bool isTexture(const XmlElement& element);
// Whether it is an <emitter>, or a <luminaire> as that was called.
bool isEmitter(const XmlElement& element);
// Whether it is a <ref>.
bool isReference(const XmlElement& element);

// The plugin of a table that the element's type names. Throws SceneError that lists what there is.
template <class Plugins>
const auto& findPlugin(const Plugins& plugins, const XmlElement& element, const std::string& kind);

// Calls a plugin's create() so that whatever it throws becomes a SceneError at the element.
template <class Create>
auto createLocated(const ElementProperties& properties, Create create);

}  // namespace h2mc

#include "render/scene/element_properties_inl.h"
