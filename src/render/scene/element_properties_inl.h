// SPDX-License-Identifier: MIT
#pragma once

namespace h2mc {

template <class Plugins>
const auto& findPlugin(const Plugins& plugins, const XmlElement& element, const std::string& kind) {
  const std::string type = lowerCase(element.require("type"));
  Names names;
  for (const auto& plugin : plugins) {
    if (plugin.name == type) return plugin;
    if constexpr (requires { plugin.otherName; })
      if (!plugin.otherName.empty() && plugin.otherName == type) return plugin;
    names.emplace_back(plugin.name);
  }
  throw sourceError(element.place("type"), "unknown " + kind + " \"" + type + "\"",
                    "expected one that there is; " + suggestion(type, names));
}

template <class Create>
auto createLocated(const ElementProperties& properties, Create create) {
  try {
    return create(properties);
  } catch (const SceneError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw sourceError(properties.element().place(), properties.description() + ": " + e.what());
  }
}

}  // namespace h2mc
