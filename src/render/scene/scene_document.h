// A scene file with its includes spliced in, its $names replaced and its ids known.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/scene/xml_document.h"

namespace h2mc {

struct SceneDocument {
  XmlElement root;  // <scene>; no <default>, <include>, <alias> or <path> is left below it
  std::map<std::string, const XmlElement*, std::less<>> ids;  // into root
  std::map<std::string, std::string, std::less<>> aliases;    // another id -> id
  std::vector<std::string> searchFolders;                     // from <path>, "" or ending in /

  // The element with an id; null when there is none.
  const XmlElement* find(std::string_view id) const;
  // Looks up the ids anew, after elements have been changed. Throws SceneError where one is given twice.
  void indexIds();
};

// Reads the file and all it includes. `defines` give $names values that win over <default>.
// Throws SceneError.
std::unique_ptr<SceneDocument> loadSceneDocument(const std::string& file,
                                                 const std::map<std::string, std::string>& defines);

// The path of a file that an element names: relative to the file the element stands in, then to the
// folders of <path>, then to the scene file. Throws SceneError when there is no such file.
std::string resolveFile(const SceneDocument& document, const XmlElement& element,
                        std::string_view attribute);

}  // namespace h2mc
