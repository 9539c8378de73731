// SPDX-License-Identifier: MIT
// A scene file with its includes spliced in, its $names replaced and its ids known.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "render/scene/xml_document.h"

namespace h2mc {

struct SceneDocument {
  XmlElement root;  // <scene>; no <default>, <include>, <alias> or <path> is left below it
  std::map<std::string, const XmlElement*, std::less<>> ids;  // into root
  std::map<std::string, std::string, std::less<>> aliases;    // another id -> id
  std::vector<std::string> searchFolders;                     // from <path>, "" or ending in /
  std::string folder;                // of the scene file, "" or ending in /
  std::string confinedTo;            // canonical; what the scene refers to lies below. "": anywhere
  bool incomplete = false;           // an <include> failed, so ids may be missing
  std::vector<SceneError> problems;  // what was wrong on the way: for the reader to say
  std::vector<StrayText> strays;     // text that belongs to nothing
  mutable std::set<std::string> files;  // that were read, and that resolveFile() has found
  std::vector<SourcePlace> spoilt;      // attributes whose value is wrong for one of these

  // The element with an id; null when there is none.
  const XmlElement* find(std::string_view id) const;
  // Looks up the ids anew, after elements have been changed. Throws SceneError where one is given twice.
  void indexIds();
};

// Whether a <scene> is of a version below 2, with Mitsuba 0.6's names and customs.
bool isOldVersion(const XmlElement& scene);

// Reads the file and all it includes. `defines` give $names values that win over <default>. Files that it
// refers to must lie below the folder `confine` once symbolic links are followed; empty: anywhere.
// text: the scene, in place of the file's content; the file's name then says what messages call it, and in which folder
// it looks for others. Throws SceneError where there is no document at all; what else is wrong is in its problems.
std::unique_ptr<SceneDocument> loadSceneDocument(const std::string& file,
                                                 const std::map<std::string, std::string>& defines,
                                                 const std::string& confine = "",
                                                 const std::string* text = nullptr);

// The path of a file that an element names: relative to the file the element stands in, then to the
// folders of <path>, then to the scene file. Throws SceneError when there is no such file. Adds it to document.files.
std::string resolveFile(const SceneDocument& document, const XmlElement& element,
                        std::string_view attribute);

}  // namespace h2mc
