// SPDX-License-Identifier: MIT
// A scene file as a tree of elements that know where they stand in the text. The only module that
// knows the XML parser.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/scene/source_text.h"

namespace h2mc {

struct XmlAttribute {
  std::string name, value;
  std::size_t nameOffset = 0, valueOffset = 0;
};

struct XmlElement {
  std::string name;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  std::shared_ptr<const SourceFile> file;
  std::size_t offset = 0;  // of the name

  const XmlAttribute* find(std::string_view attribute) const;
  // "" when it is not given.
  std::string attribute(std::string_view name) const;
  SourcePlace place() const { return {file, offset}; }
  // Where the attribute's value stands; the element's place when it is not given.
  SourcePlace place(std::string_view attribute) const;

  // Throws SceneError unless every attribute is one of the names.
  void allowAttributes(std::initializer_list<std::string_view> names) const;
  // The value of an attribute that must be there; SceneError when it is not.
  const std::string& require(std::string_view attribute) const;
};

// A new element that stands, for messages, where another one does.
XmlElement makeElement(const XmlElement& beside, std::string name,
                       std::initializer_list<std::pair<std::string_view, std::string>> attributes);

// Text between elements, and the name of the element that it is in.
struct StrayText {
  SourcePlace place;
  std::string element;
};

// Parses the text; the result is the root element, and text between elements is added to `strays`.
// Throws SceneError on malformed XML, attributes given twice, elements nested too deeply.
XmlElement parseXml(const std::shared_ptr<const SourceFile>& file, std::vector<StrayText>& strays);

}  // namespace h2mc
