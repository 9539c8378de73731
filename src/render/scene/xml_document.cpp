// SPDX-License-Identifier: MIT
#include "render/scene/xml_document.h"

#include <algorithm>
#include <cstring>
#include <pugixml.hpp>

#include "render/scene/suggestion.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostAttributes = 64;

// The parser gives no places of attributes: they are found again in the start tag's text, which is
// known to be well formed.
void locateAttributes(XmlElement& element) {
  const std::string& text = element.file->text;
  std::size_t at = element.offset + element.name.size();
  for (XmlAttribute& attribute : element.attributes) {
    while (at < text.size() && isSpace(text[at])) ++at;
    attribute.nameOffset = attribute.valueOffset = std::min(at, text.size());
    at = text.find('=', at);
    if (at == std::string::npos) return;
    const std::size_t open = text.find_first_of("\"'", at);
    if (open == std::string::npos) return;
    attribute.valueOffset = open + 1;
    at = text.find(text[open], open + 1);
    if (at == std::string::npos) return;
    ++at;
  }
}

XmlElement convert(const pugi::xml_node& node, const std::shared_ptr<const SourceFile>& file,
                   int depth, std::vector<StrayText>& strays) {
  XmlElement element;
  element.name = node.name();
  element.file = file;
  element.offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
  if (depth > kDeepest)
    throw sourceError(element.place(),
                      "elements are nested more than " + std::to_string(kDeepest) + " deep");
  for (const pugi::xml_attribute& a : node.attributes())
    element.attributes.push_back({a.name(), a.value(), 0, 0});
  if (element.attributes.size() > kMostAttributes)
    throw sourceError(element.place(), "<" + element.name + "> has more than " +
                                           std::to_string(kMostAttributes) + " attributes");
  locateAttributes(element);
  for (std::size_t i = 0; i < element.attributes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (element.attributes[i].name == element.attributes[j].name)
        throw sourceError({file, element.attributes[i].nameOffset},
                          "attribute \"" + element.attributes[i].name + "\" is given twice");
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() == pugi::node_element) {
      element.children.push_back(convert(child, file, depth + 1, strays));
    } else if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      const auto begin =
          static_cast<std::size_t>(std::max<std::ptrdiff_t>(child.offset_debug(), 0));
      const std::size_t blanks = std::string_view(child.value()).find_first_not_of(" \t\r\n");
      strays.push_back(
          {{file, begin + (blanks == std::string_view::npos ? 0 : blanks)}, element.name});
    }
  }
  return element;
}

}  // namespace

const XmlAttribute* XmlElement::find(std::string_view wanted) const {
  for (const XmlAttribute& a : attributes)
    if (a.name == wanted) return &a;
  return nullptr;
}

std::string XmlElement::attribute(std::string_view wanted) const {
  const XmlAttribute* a = find(wanted);
  return a ? a->value : std::string();
}

SourcePlace XmlElement::place(std::string_view wanted) const {
  const XmlAttribute* a = find(wanted);
  return {file, a ? a->valueOffset : offset};
}

void XmlElement::allowAttributes(std::initializer_list<std::string_view> names) const {
  for (const XmlAttribute& a : attributes) {
    if (std::find(names.begin(), names.end(), a.name) != names.end()) continue;
    throw sourceError({file, a.nameOffset},
                      "unknown attribute \"" + a.name + "\" of <" + name + ">",
                      suggestion(a.name, Names(names.begin(), names.end())));
  }
}

const std::string& XmlElement::require(std::string_view wanted) const {
  if (const XmlAttribute* a = find(wanted)) return a->value;
  throw sourceError(place(), "<" + name + "> has no attribute \"" + std::string(wanted) + "\"",
                    "expected <" + name + " " + std::string(wanted) + "=\"...\">");
}

XmlElement makeElement(const XmlElement& beside, std::string name,
                       std::initializer_list<std::pair<std::string_view, std::string>> attributes) {
  XmlElement made;
  made.name = std::move(name);
  made.file = beside.file;
  made.offset = beside.offset;
  for (const auto& [key, value] : attributes)
    made.attributes.push_back({std::string(key), value, beside.offset, beside.offset});
  return made;
}

XmlElement parseXml(const std::shared_ptr<const SourceFile>& file, std::vector<StrayText>& strays) {
  const std::string& text = file->text;
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    throw sourceError({file, zero}, "not a text file", "expected XML in UTF-8");
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (result.status == pugi::status_no_document_element)
    throw sourceError({file, 0}, text.empty() ? "the file is empty" : "no XML element in the file",
                      "expected <scene version=\"0.6.0\"> ... </scene>");
  if (!result) {
    // The offset may be one past the place where the parser gave up.
    const std::size_t offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
    std::string what = result.description();
    if (!what.empty() && what[0] >= 'A' && what[0] <= 'Z')
      what[0] = static_cast<char>(what[0] + 32);
    throw sourceError({file, std::min(offset, text.size())}, "malformed XML: " + what);
  }
  const pugi::xml_node root = document.document_element();
  for (pugi::xml_node next = root.next_sibling(); next; next = next.next_sibling())
    if (next.type() == pugi::node_element)
      throw sourceError({file, static_cast<std::size_t>(next.offset_debug())},
                        "a second element after </" + std::string(root.name()) + ">",
                        "expected one element around everything");
  return convert(root, file, 0, strays);
}

}  // namespace h2mc
