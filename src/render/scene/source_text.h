// SPDX-License-Identifier: MIT
// The text of a scene file and places in it, for messages that show where a mistake is.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "render/scene/properties.h"

namespace h2mc {

struct SourceFile {
  std::string name;    // the path as the user or the <include> gave it
  std::string folder;  // where relative file names start: "" or ending with a slash
  std::string text;
};

// A character of a file. A null file: no place is known.
struct SourcePlace {
  std::shared_ptr<const SourceFile> file;
  std::size_t offset = 0;
};

// "scene.xml:12:7: KIND: MESSAGE", the line, a caret below the place, then the hint (what was
// expected, what there is) unless it is empty. KIND is "error" or "warning".
std::string sourceMessage(const SourcePlace& place, const std::string& kind,
                          const std::string& message, const std::string& hint = "");
SceneError sourceError(const SourcePlace& place, const std::string& message,
                       const std::string& hint = "");

// "scene.xml:12:7"
std::string describe(const SourcePlace& place);

// Reads a regular file whole. Throws std::runtime_error with the reason ("no such file").
std::string readTextFile(const std::string& path);

}  // namespace h2mc
