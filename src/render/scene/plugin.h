// SPDX-License-Identifier: MIT
// The tables that say which plugins there are and what parameters they take. They read the scene
// file and print `h2mc list`.
#pragma once

#include <span>
#include <string_view>

namespace h2mc {

class Properties;

enum class ParameterType {
  kBoolean,
  kInteger,
  kNumber,   // float
  kString,   // one of `choices` where those are given; without choices but with a default, a number
             // may stand for it (intIOR: "bk7" or 1.5)
  kColor,    // rgb, spectrum or a single number
  kTexture,  // a nested texture or a colour
  kPoint,
  kVector,
  kTransform,
};

struct Parameter {
  std::string_view name;  // as in Mitsuba 0.6, e.g. "specularReflectance"; the snake_case
                          // spelling of Mitsuba 2/3 is derived ("specular_reflectance")
  ParameterType type;
  std::string_view fallback;  // the default as one would write it in a scene; "" = none
  std::string_view description;
  std::string_view choices = "";    // for strings: "ggx|beckmann"; "" = anything
  std::string_view otherName = "";  // a further spelling that is not the snake_case one ("int_ior")
  bool ignored = false;             // accepted because other renderers know it; named once
  bool mayBeNegative = false;       // colours: measured data may dip below 0; textures: numbers
  bool unnamed = false;             // for textures: the one inside, whatever its name
};

constexpr Parameter ignoredParameter(std::string_view name, ParameterType type) {
  return {name, type, "", "accepted and not used", "", "", true};
}

// What a plugin element may hold besides parameters.
enum class Nested : unsigned {
  kNone = 0,
  kBsdf = 1,
  kEmitter = 2,
  kShape = 4,
  kFilm = 8,
  kFilter = 16,
  kSampler = 32
};

// One entry of the list of BSDFs, lights, shapes, textures or integrators.
template <class Object>
struct Plugin {
  std::string_view name;         // as in a scene file's type="..."
  std::string_view description;  // one line
  std::span<const Parameter> parameters;
  // Makes the object. Throws SceneError (through Properties::fail) on bad input.
  Object (*create)(const Properties&);
  std::string_view otherName = "";  // another spelling of type=
  int nestedBsdfs = 0;              // how many nested <bsdf> it takes at most
};

}  // namespace h2mc
