// SPDX-License-Identifier: MIT
#include "scene_mutator.h"

#include <algorithm>
#include <iterator>

#include "scene_words.h"

namespace h2mc::fuzz {
namespace {

// An element, and the one that it is in (null: the root).
struct Node {
  XmlElement* element = nullptr;
  XmlElement* parent = nullptr;
};

void collect(XmlElement& element, XmlElement* parent, std::vector<Node>& nodes) {
  nodes.push_back({&element, parent});
  for (XmlElement& child : element.children) collect(child, &element, nodes);
}

class SceneMutator {
 public:
  SceneMutator(XmlElement& root, Random& random, const ByteMutator& bytes)
      : root_(root), random_(random), bytes_(bytes) {}

  void change() {
    nodes_.clear();
    collect(root_, nullptr, nodes_);
    using Change = void (SceneMutator::*)();
    constexpr Change kChanges[] = {
        &SceneMutator::changeValue,  &SceneMutator::changeValue,  &SceneMutator::changeValue,
        &SceneMutator::changeValue,  &SceneMutator::addParameter, &SceneMutator::addParameter,
        &SceneMutator::addParameter, &SceneMutator::addTyped,     &SceneMutator::addTyped,
        &SceneMutator::addStep,      &SceneMutator::changeType,   &SceneMutator::remove,
        &SceneMutator::copy,         &SceneMutator::refer,        &SceneMutator::changeAttribute,
        &SceneMutator::addDirective, &SceneMutator::changeVersion};
    (this->*random_.pick(kChanges))();
  }

 private:
  // A random one of the nodes for which `wanted` holds; an empty one where there is none.
  template <class Wanted>
  Node find(Wanted wanted) {
    std::vector<Node> found;
    std::copy_if(nodes_.begin(), nodes_.end(), std::back_inserter(found),
                 [&](const Node& node) { return wanted(*node.element); });
    return found.empty() ? Node() : random_.pick(found);
  }
  Node any() { return random_.pick(nodes_); }
  static auto named(std::string_view name) {
    return [name](const XmlElement& e) { return e.name == name; };
  }

  // A number instead of a number, a word instead of a word.
  void changeValue() {
    const Node node = find([](const XmlElement& e) {
      return std::any_of(e.attributes.begin(), e.attributes.end(), isValue);
    });
    if (!node.element) return;
    std::vector<XmlAttribute*> values;
    for (XmlAttribute& a : node.element->attributes)
      if (isValue(a)) values.push_back(&a);
    XmlAttribute& value = *random_.pick(values);
    const std::string& element = node.element->name;
    if (element == "boolean")
      value.value = random_.chance(0.5) ? "true" : "false";
    else if (element == "string")
      changeWord(*node.element, node.parent, value);
    else if (value.value.find_first_of(", ") != std::string::npos)
      changeOneOfMany(value.value);
    else
      value.value = anyNumber(random_);
  }
  static bool isValue(const XmlAttribute& a) {
    return a.name != "name" && a.name != "id" && a.name != "type" && a.name != "version";
  }

  void changeWord(const XmlElement& element, const XmlElement* parent, XmlAttribute& value) {
    const ElementType* type = parent ? typeOf(*parent) : nullptr;
    if (type && random_.chance(0.8)) {
      for (const Parameter& p : type->parameters)
        if (p.name == element.attribute("name"))
          value.value = makeParameter(p, random_).attribute("value");
    } else {
      value.value = bytes_(value.value, 64);
    }
  }

  void changeOneOfMany(std::string& text) {
    const std::size_t at = random_.below(text.size());
    const std::size_t begin = text.find_first_not_of(", ", at);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    text.replace(begin, end - begin, anyNumber(random_));
  }

  void addParameter() {
    const Node node = find([](const XmlElement& e) { return typeOf(e) != nullptr; });
    if (!node.element) return;
    const ElementType& type = *typeOf(*node.element);
    if (type.parameters.empty()) return;
    const Parameter& parameter = random_.pick(type.parameters);
    XmlElement made = makeParameter(parameter, random_);
    if (random_.chance(0.9))  // instead of the one that is there: two are a mistake
      std::erase_if(node.element->children,
                    [&](const XmlElement& e) { return e.attribute("name") == parameter.name; });
    node.element->children.push_back(std::move(made));
  }

  // Where it belongs, mostly.
  void addTyped() {
    constexpr std::string_view kKinds[] = {"shape", "shape", "shape",   "emitter", "emitter",
                                           "bsdf",  "bsdf",  "texture", "rfilter", "integrator"};
    const std::string_view kind = random_.pick(kKinds);
    XmlElement made = makeTyped(anyTypeOf(kind, random_), random_);
    XmlElement* parent = &root_;
    if (random_.chance(0.05)) {
      parent = any().element;
    } else if (kind == "bsdf") {
      const Node shape = find(named("shape"));
      if (shape.element && random_.chance(0.8)) {
        parent = shape.element;
        std::erase_if(parent->children,
                      [](const XmlElement& e) { return e.name == "bsdf" || e.name == "ref"; });
      } else {
        made.attributes.push_back({"id", "m" + std::to_string(random_.below(4)), 0, 0});
      }
    } else if (kind == "emitter" && made.attribute("type") == "area") {
      if (const Node shape = find(named("shape")); shape.element) parent = shape.element;
    } else if (kind == "rfilter") {
      if (const Node film = find(named("film")); film.element) parent = film.element;
    } else if (kind == "integrator") {
      std::erase_if(root_.children, named("integrator"));
    }
    parent->children.push_back(std::move(made));
  }

  void addStep() {
    if (const Node node = find(named("transform")); node.element && random_.chance(0.8)) {
      node.element->children.push_back(makeTransformStep(random_));
    } else if (const Node shape = find(named("shape")); shape.element) {
      constexpr Parameter kToWorld = {"toWorld", ParameterType::kTransform, "", ""};
      std::erase_if(shape.element->children,
                    [](const XmlElement& e) { return e.attribute("name") == "toWorld"; });
      shape.element->children.push_back(makeParameter(kToWorld, random_));
    }
  }

  void changeType() {
    const Node node = find([](const XmlElement& e) { return typeOf(e) != nullptr; });
    if (!node.element) return;
    for (XmlAttribute& a : node.element->attributes)
      if (a.name == "type") a.value = anyTypeOf(node.element->name, random_).type;
  }

  void remove() {
    const Node node = any();
    if (!node.parent) return;
    std::erase_if(node.parent->children, [&](const XmlElement& e) { return &e == node.element; });
  }

  void copy() {
    const Node node = any();
    if (!node.parent) return;
    constexpr std::size_t kMostElements = 400;
    if (nodes_.size() > kMostElements) return;
    XmlElement copied = *node.element;
    XmlElement& to = random_.chance(0.7) ? *node.parent : *any().element;
    to.children.push_back(std::move(copied));
  }

  // A reference, an id, or the one to the other.
  void refer() {
    const Node from = find(named("ref"));
    const Node to = find([](const XmlElement& e) { return e.find("id") && e.name != "ref"; });
    const std::string id = to.element ? to.element->attribute("id") : "m0";
    if (from.element && random_.chance(0.6))
      from.element->attributes = {{"id", id, 0, 0}};
    else if (const Node in = find([](const XmlElement& e) { return typeOf(e) != nullptr; });
             in.element)
      in.element->children.push_back(makeElement("ref", {{"id", id}}));
  }

  void changeAttribute() {
    XmlElement& element = *any().element;
    if (element.attributes.empty()) return;
    XmlAttribute& a = element.attributes[random_.below(element.attributes.size())];
    a.value = bytes_(a.value, 200);
    std::erase_if(a.value, [](char c) { return c == '\0'; });
  }

  void addDirective() {
    const std::string name(1, static_cast<char>('a' + random_.below(3)));
    XmlElement made;
    switch (random_.below(5)) {
      case 0:  // of a value that may be made of others
        made = makeElement(
            "default",
            {{"name", name}, {"value", random_.chance(0.5) ? anyNumber(random_) : "$a$b$b"}});
        break;
      case 1:
        made = makeElement("include", {{"filename", std::string(random_.pick(sceneFiles()))}});
        break;
      case 2:
        made = makeElement("alias", {{"id", "m0"}, {"as", "m" + name}});
        break;
      case 3:
        made = makeElement("path", {{"value", random_.chance(0.5) ? "." : "/nowhere"}});
        break;
      default:
        if (const Node node = find([](const XmlElement& e) { return e.find("value"); });
            node.element)
          for (XmlAttribute& a : node.element->attributes)
            if (a.name == "value") a.value = "$" + name;
        return;
    }
    std::vector<XmlElement>& children = (random_.chance(0.9) ? &root_ : any().element)->children;
    children.insert(
        children.begin() + static_cast<std::ptrdiff_t>(random_.below(children.size() + 1)),
        std::move(made));
  }

  void changeVersion() {
    constexpr std::string_view kVersions[] = {"0.2.0", "0.4.0", "0.6.0", "2.1.0", "3.0.0", "x"};
    for (XmlAttribute& a : root_.attributes)
      if (a.name == "version") a.value = random_.pick(kVersions);
  }

  XmlElement& root_;
  Random& random_;
  const ByteMutator& bytes_;
  std::vector<Node> nodes_;
};

}  // namespace

std::string mutateScene(const std::string& text, Random& random, const ByteMutator& mutateBytes,
                        std::size_t most) {
  if (random.chance(0.03)) return mutateBytes(text, most);
  auto file = std::make_shared<SourceFile>();
  file->text = text;
  std::vector<StrayText> strays;
  XmlElement root;
  try {
    root = parseXml(file, strays);
  } catch (const SceneError&) {
    return mutateBytes(text, most);
  }
  SceneMutator mutator(root, random, mutateBytes);
  do mutator.change();
  while (random.chance(0.4));
  const std::string changed = xmlText(root);
  return changed.size() <= most ? changed : mutateBytes(text, most);
}

}  // namespace h2mc::fuzz
