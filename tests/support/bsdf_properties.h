// SPDX-License-Identifier: MIT
// Parameters for making plugins without a scene file.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <variant>

#include "render/scene/properties.h"

namespace h2mc::test {

// Holds what a scene would give; defaults come from the plugin's table. fail() throws SceneError
// with "NAME: message".
class FakeProperties : public Properties {
 public:
  using Value = std::variant<bool, float, std::string, Rgbf, TexturePtr>;
  FakeProperties(std::span<const Parameter> parameters, std::map<std::string, Value> values)
      : parameters_(parameters), values_(std::move(values)) {}

  bool given(std::string_view name) const override {
    find(name);
    return values_.count(std::string(name)) > 0;
  }
  bool boolean(std::string_view name) const override {
    return given(name) ? std::get<bool>(at(name)) : fallback(name) == "true";
  }
  int integer(std::string_view name) const override { return static_cast<int>(number(name)); }
  float number(std::string_view name) const override {
    return given(name) ? std::get<float>(at(name)) : std::stof(fallback(name));
  }
  std::string string(std::string_view name) const override {
    return given(name) ? std::get<std::string>(at(name)) : fallback(name);
  }
  Rgbf color(std::string_view name) const override {
    return given(name) ? std::get<Rgbf>(at(name)) : Rgbf(std::stof(fallback(name)));
  }
  TexturePtr texture(std::string_view name) const override {
    if (!given(name)) return constantTexture(Rgbf(std::stof(fallback(name))));
    if (const auto* t = std::get_if<TexturePtr>(&at(name))) return *t;
    if (const auto* number = std::get_if<float>(&at(name))) return constantTexture(Rgbf(*number));
    return constantTexture(std::get<Rgbf>(at(name)));
  }
  Vec3f vector(std::string_view name) const override { return color(name); }
  Mat4 transform(std::string_view) const override { return Mat4(1); }
  std::string file(std::string_view name) const override { return string(name); }
  int nestedBsdfCount() const override { return 0; }
  int nestedBsdf(int) const override { throw std::logic_error("no nested bsdf"); }
  const Material& material(int) const override { throw std::logic_error("no nested bsdf"); }
  [[noreturn]] void fail(std::string_view name, const std::string& message) const override {
    throw SceneError(std::string(name) + ": " + message);
  }

 private:
  const Parameter& find(std::string_view name) const {
    for (const Parameter& p : parameters_)
      if (p.name == name) return p;
    throw std::logic_error("the table lacks " + std::string(name));
  }
  const Value& at(std::string_view name) const { return values_.at(std::string(name)); }
  std::string fallback(std::string_view name) const {
    const std::string text(find(name).fallback);
    if (text.empty()) fail(name, "missing");
    return text;
  }

  std::span<const Parameter> parameters_;
  std::map<std::string, Value> values_;
};

template <class P>
const P& pluginNamed(std::span<const P> plugins, std::string_view name) {
  for (const P& p : plugins)
    if (p.name == name) return p;
  throw std::logic_error("no plugin " + std::string(name));
}

}  // namespace h2mc::test
