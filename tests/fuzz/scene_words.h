// SPDX-License-Identifier: MIT
// What scene files are made of, for those who make some up: the reader's tables, and values that fit them more or less.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "byte_mutator.h"
#include "render/scene/option_set.h"
#include "render/scene/plugin.h"
#include "render/scene/xml_document.h"

namespace h2mc::fuzz {

// A type of an element with its parameters, from the same tables as `h2mc list`.
struct ElementType {
  std::string_view element;  // "bsdf"
  std::string_view type;     // "diffuse"
  std::span<const Parameter> parameters;
  int nestedBsdfs = 0;
};

// All there are.
std::span<const ElementType> elementTypes();
// That of an element; null where it has none.
const ElementType* typeOf(const XmlElement& element);
// One of those that an element of this name has. Precondition: there are some.
const ElementType& anyTypeOf(std::string_view element, Random& random);

// Files that are there beside each scene.
std::span<const std::string_view> sceneFiles();

XmlElement makeElement(std::string name,
                       std::vector<std::pair<std::string, std::string>> attributes);
// One of the parameters with a value: mostly one that the reader takes.
XmlElement makeParameter(const Parameter& parameter, Random& random);
// A step of a <transform>.
XmlElement makeTransformStep(Random& random);
// A whole element with what it can't do without and some of its parameters.
XmlElement makeTyped(const ElementType& type, Random& random);

// A number, one from everyday scenes or a wild one.
std::string anyNumber(Random& random);
std::string numbers(std::size_t count, std::string_view separator, Random& random);

// As a scene file has it.
std::string xmlText(const XmlElement& element);

}  // namespace h2mc::fuzz
