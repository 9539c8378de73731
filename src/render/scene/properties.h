// The parameters of one plugin element of a scene file, checked against the plugin's table, each
// with the place where it was written.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "render/core/motion.h"
#include "render/core/types.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Material;

// Something is wrong with a scene. what() is the whole message for the user: file, line, column,
// the line with a caret, what was expected, what there is.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Abstract so that tests can make plugins without a file. All getters return the table's default
// when the scene does not give the parameter, and fail (SceneError) when there is no default or the
// value is of the wrong type. Asking for a name that the table lacks is a programming error
// (std::logic_error).
class Properties {
 public:
  virtual ~Properties() = default;

  virtual bool given(std::string_view name) const = 0;  // written in the scene file
  virtual bool boolean(std::string_view name) const = 0;
  virtual int integer(std::string_view name) const = 0;
  virtual float number(std::string_view name) const = 0;        // finite
  virtual std::string string(std::string_view name) const = 0;  // lower-case if it has choices
  virtual Rgbf color(std::string_view name) const = 0;          // finite, not negative
  virtual TexturePtr texture(std::string_view name) const = 0;
  virtual Vec3f vector(std::string_view name) const = 0;  // points too
  virtual Mat4 transform(
      std::string_view name) const = 0;  // identity by default; fails if it moves
  // The same for what may move: a <transform>, or what the camera's shutter sees of an <animation>.
  virtual Motion motion(std::string_view name) const { return Motion(glm::dmat4(transform(name))); }
  // The path of a file named by a string parameter, found relative to the scene file; fails when
  // it is not there.
  virtual std::string file(std::string_view name) const = 0;

  // Nested BSDFs in the order they are written (for twosided, mask, ...), as indices into the
  // scene's materials.
  virtual int nestedBsdfCount() const = 0;
  virtual int nestedBsdf(int index) const = 0;
  virtual const Material& material(int index) const = 0;

  // Throws SceneError that points at the parameter (or at the element when it is not given).
  [[noreturn]] virtual void fail(std::string_view name, const std::string& message) const = 0;
};

}  // namespace h2mc
