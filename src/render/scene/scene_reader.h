// SPDX-License-Identifier: MIT
// Reads a scene file: Mitsuba 0.6 XML, with the snake_case names of Mitsuba 2/3, and dpt's <dpt>.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "render/image/film_window.h"
#include "render/scene/problems.h"
#include "render/scene/properties.h"
#include "render/scene/scene.h"
#include "render/scene/scene_document.h"

namespace h2mc {

struct ReadOptions {
  std::map<std::string, std::string> defines;     // $name -> value, over the file's <default>s
  std::span<const IntegratorPlugin> integrators;  // those that <integrator> may name
  // The image's size instead of the scene's; one alone keeps the aspect ratio. 0: the scene's.
  int width = 0, height = 0;
  double scale = 0;  // of width and height both; 0: none
  // The part of that image that is rendered, which may be a part of the film by the scene already; none: all of it.
  std::optional<PixelRectangle> crop;
  // Where to say which part of the whole film it is, by the scene and by `crop`, if not null. In whole pixels, which
  // the image's size may have rounded.
  FilmWindow* window = nullptr;
  Strictness strictness = Strictness::kByVersion;
  std::string
      confine;  // the folder that files which the scene refers to must lie below; "": anywhere
};

// The scene, finished. Throws SceneError, whose message is complete, for whatever is wrong with the
// scene: everything that could be found out in one reading; std::runtime_error if Embree fails.
Scene readScene(const std::string& file, const ReadOptions& options);

// The same of a scene in memory. name: in messages; others that it refers to are looked for in the name's folder.
Scene readSceneText(const std::string& text, const std::string& name, const ReadOptions& options);

// The same of a document that has been loaded, and perhaps changed since; the defines are the
// document's and not looked at. The document is normalised.
Scene makeScene(SceneDocument& document, const ReadOptions& options);

}  // namespace h2mc
