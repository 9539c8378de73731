// SPDX-License-Identifier: MIT
// The parameters of one plugin element of a scene file, checked against the plugin's table, each
// with the place where it was written.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "render/core/motion.h"
#include "render/core/types.h"
#include "render/core/user_error.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Material;

// Something is wrong with a scene. what() is the whole message for the user: file, line, column,
// the line with a caret, what was expected, what there is.
class SceneError : public UserError {
 public:
  explicit SceneError(const std::string& message, std::string place = "")
      : UserError(message), place_(std::move(place)) {}

  // "scene.xml:12:7"; "" where none is known.
  const std::string& place() const { return place_; }

 private:
  std::string place_;
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
  // Finite, and not negative but where the table says that it may be.
  virtual Rgbf color(std::string_view name) const = 0;
  virtual TexturePtr texture(std::string_view name) const = 0;
  // Of a texture: whether it stands for numbers, such as heights, and not for a colour.
  virtual bool texelsMayBeNegative() const { return false; }
  virtual Vec3f vector(std::string_view name) const = 0;  // points too
  virtual Mat4 transform(
      std::string_view name) const = 0;  // identity by default; fails if it moves
  // The same for what may move: a <transform>, or what the camera's shutter sees of an <animation>.
  virtual Motion motion(std::string_view name) const { return Motion(glm::dmat4(transform(name))); }
  // Whether the file is of Mitsuba 0.x: some plugins do not mean the same there as from version 2 on.
  virtual bool isOldVersion() const { return true; }
  // The path of a file named by a string parameter, found relative to the scene file; fails when
  // it is not there.
  virtual std::string file(std::string_view name) const = 0;

  // Nested BSDFs in the order they are written (for twosided, mask, ...), as indices into the
  // scene's materials.
  virtual int nestedBsdfCount() const = 0;
  virtual int nestedBsdf(int index) const = 0;
  virtual const Material& material(int index) const = 0;

  // Something to know about a parameter that is given: the picture may not be what the author wants.
  // Nothing where there is nobody to tell.
  virtual void warn(std::string_view /*name*/, const std::string& /*message*/) const {}
  // Something wrong with what the parameter names: a warning in old files and if permissive, else an error (fail).
  virtual void tolerate(std::string_view name, const std::string& message,
                        const std::string& /*hint*/) const {
    fail(name, message);
  }
  // The same, a warning if permissive alone, and then this happens `instead`.
  virtual void refuse(std::string_view name, const std::string& message,
                      const std::string& /*instead*/) const {
    fail(name, message);
  }
  // Throws SceneError that points at the parameter (or at the element when it is not given).
  [[noreturn]] virtual void fail(std::string_view name, const std::string& message) const = 0;
};

}  // namespace h2mc
