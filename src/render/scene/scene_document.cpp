// SPDX-License-Identifier: MIT
#include "render/scene/scene_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>

#include "render/core/input_file.h"
#include "render/scene/old_spellings.h"
#include "render/scene/problems.h"
#include "render/scene/suggestion.h"
#include "render/scene/text_encoding.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

std::string folderOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

bool identifierCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// There is more wrong with a document than anyone wants to know.
struct TooManyProblems {};

// Goes through the elements in the order in which they are written, as <default> asks for.
class Loader {
 public:
  Loader(SceneDocument& document, const std::map<std::string, std::string>& defines)
      : document_(document), values_(defines.begin(), defines.end()) {}

  // text: null, or what is taken for the file's content.
  XmlElement load(const std::string& path, const SourcePlace& from,
                  const std::string* text = nullptr) {
    auto file = std::make_shared<SourceFile>();
    file->name = path;
    file->folder = folderOf(path);
    const auto fail = [&](const std::string& why) {
      if (from.file) throw sourceError(from, "cannot read \"" + path + "\": " + why);
      throw SceneError(path + ": error: cannot read the scene: " + why);
    };
    try {
      std::optional<InputFile> input;
      if (!text) input.emplace(path, kLargestText);
      textBytes_ += text ? text->size() : input->size();
      if (textBytes_ > kLargestText)
        fail("with it the scene has " + sizeText(static_cast<double>(textBytes_)) +
             " of text, expected at most " + sizeText(static_cast<double>(kLargestText)));
      file->text = toUtf8(text ? *text : input->whole());
    } catch (const InputFileError& e) {
      fail(e.why());
    }
    XmlElement root = parseXml(file, document_.strays);
    open_.push_back(path);
    process(root);
    open_.pop_back();
    return root;
  }

  // After everything is read: each define must have been of use.
  void checkDefines(const std::string& file,
                    const std::map<std::string, std::string>& defines) const {
    for (const auto& [name, value] : defines) {
      if (used_.count(name) || defaults_.count(name)) continue;
      Names names(used_.begin(), used_.end());
      for (const std::string& d : defaults_)
        if (!used_.count(d)) names.push_back(d);
      throw SceneError(fmt::format("{}: error: the scene has no ${} (-D {}={})\n{}", file, name,
                                   name, value, suggestion(name, names)));
    }
  }

 private:
  // Keeps what is thrown, so that the rest is read too.
  template <class Read>
  void attempt(Read read) {
    try {
      read();
    } catch (const SceneError& e) {
      document_.problems.push_back(e);
    }
    if (document_.problems.size() >= Problems::kMost) throw TooManyProblems();
  }

  void process(XmlElement& element) {
    substitute(element);
    std::vector<XmlElement> kept;
    kept.reserve(element.children.size());
    for (XmlElement& child : element.children) {
      if (child.name == "default") {
        attempt([&] { readDefault(child); });
      } else if (child.name == "include") {
        substitute(child);
        const std::size_t before = document_.problems.size();
        attempt([&] { include(child, kept); });
        document_.incomplete |= document_.problems.size() > before;
      } else if (child.name == "alias") {
        substitute(child);
        attempt([&] { readAlias(child); });
      } else if (child.name == "path") {
        substitute(child);
        attempt([&] { readPath(child); });
      } else {
        process(child);
        kept.push_back(std::move(child));
      }
    }
    element.children = std::move(kept);
  }

  void readAlias(const XmlElement& element) {
    element.allowAttributes({"id", "as"});
    document_.aliases[element.require("as")] = element.require("id");
  }

  void readPath(const XmlElement& element) {
    element.allowAttributes({"value"});
    std::string folder = element.require("value");
    if (!folder.empty() && folder[0] != '/') folder = element.file->folder + folder;
    if (!folder.empty() && folder.back() != '/') folder += '/';
    document_.searchFolders.push_back(folder);
  }

  void readDefault(XmlElement& element) {
    element.allowAttributes({"name", "value"});
    const std::string name = element.require("name");
    if (name.empty() || !std::all_of(name.begin(), name.end(), identifierCharacter))
      throw sourceError(element.place("name"), "\"" + name + "\" is not a name",
                        "expected letters, digits and underscores");
    element.require("value");
    for (XmlAttribute& attribute : element.attributes)
      if (attribute.name == "value") substitute(element, attribute);
    defaults_.insert(name);
    values_.emplace(name, element.attribute("value"));  // the first one counts, -D before all
  }

  void include(const XmlElement& element, std::vector<XmlElement>& siblings) {
    constexpr std::size_t kDeepest = 16, kMost = 10000;
    element.allowAttributes({"filename"});
    element.require("filename");
    const std::string path = resolveFile(document_, element, "filename");
    for (const std::string& open : open_) {
      std::error_code code;
      if (fs::equivalent(open, path, code))
        throw sourceError(element.place("filename"), "\"" + path + "\" includes itself");
    }
    if (open_.size() >= kDeepest)
      throw sourceError(element.place("filename"),
                        "files include each other more than " + std::to_string(kDeepest) + " deep");
    if (++included_ > kMost)
      throw sourceError(element.place("filename"),
                        "more than " + std::to_string(kMost) + " files are included");
    XmlElement root = load(path, element.place("filename"));
    if (root.name == "scene") {
      root.allowAttributes({"version"});
      std::move(root.children.begin(), root.children.end(), std::back_inserter(siblings));
    } else {
      siblings.push_back(std::move(root));
    }
  }

  void substitute(XmlElement& element) {
    for (XmlAttribute& attribute : element.attributes) {
      const std::size_t before = document_.problems.size();
      attempt([&] { substitute(element, attribute); });
      if (document_.problems.size() > before)
        document_.spoilt.push_back({element.file, attribute.valueOffset});
    }
  }

  // Replaces each $name; where the name runs into further letters, the longest one that is known.
  void substitute(const XmlElement& element, XmlAttribute& attribute) {
    std::size_t at = attribute.value.find('$');
    if (at == std::string::npos) return;
    constexpr std::size_t kLongestValue = 1 << 20;  // names made of names can grow without end
    std::string result;
    const std::string& text = attribute.value;
    std::size_t done = 0;
    while (at != std::string::npos) {
      std::size_t end = at + 1;
      while (end < text.size() && identifierCharacter(text[end])) ++end;
      const std::string whole = text.substr(at + 1, end - at - 1);
      auto found = values_.end();
      std::size_t length = whole.size();
      for (; length > 0 && found == values_.end(); --length)
        found = values_.find(whole.substr(0, length));
      if (whole.empty() || found == values_.end()) {
        Names names;
        for (const auto& [name, value] : values_) names.push_back(name);
        throw sourceError({element.file, attribute.valueOffset + at},
                          "undefined name \"$" + whole + "\"",
                          "expected a name given by <default> above or by -D name=value; " +
                              suggestion(whole, names));
      }
      used_.insert(found->first);
      if (result.size() + found->second.size() > kLongestValue)
        throw sourceError({element.file, attribute.valueOffset + at},
                          "with \"$" + found->first + "\" the value is too long",
                          "expected at most " + std::to_string(kLongestValue) + " characters");
      result += text.substr(done, at - done) + found->second;
      done = at + 1 + found->first.size();
      at = text.find('$', done);
    }
    attribute.value = result + text.substr(done);
  }

  SceneDocument& document_;
  std::map<std::string, std::string, std::less<>> values_;
  std::set<std::string> used_, defaults_;
  std::vector<std::string> open_;
  std::size_t included_ = 0;
  std::uint64_t textBytes_ = 0;
};

// The last error met; all ids are known nonetheless, the first of two with the same.
void collectIds(SceneDocument& document, const XmlElement& element,
                std::optional<SceneError>& error) {
  if (element.name != "ref" && element.name != "reference") {
    if (const XmlAttribute* id = element.find("id")) {
      const auto [entry, isNew] = document.ids.emplace(id->value, &element);
      if (!isNew)
        error = sourceError(element.place("id"), "the id \"" + id->value + "\" is given twice",
                            "first at " + describe(entry->second->place("id")));
    }
  }
  for (const XmlElement& child : element.children) collectIds(document, child, error);
}

// Whether the document may refer to a file or folder that is there, or that would be there.
bool isAllowed(const SceneDocument& document, const std::string& path) {
  if (document.confinedTo.empty()) return true;
  std::error_code code;
  const fs::path real = fs::weakly_canonical(path, code), folder = document.confinedTo;
  if (code) return false;
  // By components: /a/bc is not below /a/b.
  return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
         folder.end();
}

}  // namespace

const XmlElement* SceneDocument::find(std::string_view id) const {
  for (int i = 0; i < 8; ++i) {  // aliases of aliases, but not in circles
    if (const auto found = ids.find(id); found != ids.end()) return found->second;
    const auto alias = aliases.find(id);
    if (alias == aliases.end()) return nullptr;
    id = alias->second;
  }
  return nullptr;
}

void SceneDocument::indexIds() {
  ids.clear();
  std::optional<SceneError> error;
  collectIds(*this, root, error);
  if (error) throw SceneError(*error);
}

bool isOldVersion(const XmlElement& scene) {
  const std::string version = scene.attribute("version");
  return version == "0" || version == "1" || version.rfind("0.", 0) == 0 ||
         version.rfind("1.", 0) == 0;
}

std::unique_ptr<SceneDocument> loadSceneDocument(const std::string& file,
                                                 const std::map<std::string, std::string>& defines,
                                                 const std::string& confine,
                                                 const std::string* text) {
  auto document = std::make_unique<SceneDocument>();
  document->folder = folderOf(file);
  if (!confine.empty()) {
    std::error_code code;
    document->confinedTo = fs::canonical(confine, code).string();
    if (code || !fs::is_directory(document->confinedTo, code))
      throw SceneError(file + ": error: \"" + confine + "\" is no folder to confine the scene to");
  }
  Loader loader(*document, defines);
  try {
    document->root = loader.load(file, {}, text);
  } catch (const TooManyProblems&) {
    std::string all;
    for (const SceneError& problem : document->problems) all += problem.what() + std::string("\n");
    throw SceneError(all + "there is more, which is not looked at");
  }
  if (!text) document->files.insert(file);
  if (document->root.name != "scene")
    throw sourceError(document->root.place(),
                      "the outermost element is <" + document->root.name + ">",
                      "expected <scene version=\"0.6.0\">");
  const auto attempt = [&](const auto& check) {
    try {
      check();
    } catch (const SceneError& e) {
      document->problems.push_back(e);
    }
  };
  attempt([&] { loader.checkDefines(file, defines); });
  attempt([&] { modernise(document->root); });
  attempt([&] { document->indexIds(); });
  return document;
}

std::string resolveFile(const SceneDocument& document, const XmlElement& element,
                        std::string_view attribute) {
  std::string name = element.attribute(attribute);
  if (name.find('/') == std::string::npos)  // as written on Windows
    std::replace(name.begin(), name.end(), '\\', '/');
  const auto missing = [&](const std::string& why, const std::string& hint) {
    return sourceError(element.place(attribute), why, hint);
  };
  if (name.empty()) throw missing("the name of a file is missing", "");
  std::vector<std::string> candidates;
  if (name[0] == '/') {
    candidates.push_back(name);
  } else {
    candidates.push_back(element.file->folder + name);
    for (const std::string& folder : document.searchFolders) candidates.push_back(folder + name);
    candidates.push_back(document.folder + name);
  }
  const auto outside = [&](const std::string& path) {
    return missing("\"" + path + "\" is outside of \"" + document.confinedTo + "\"",
                   "the scene is confined to that folder, symbolic links included");
  };
  std::error_code code;
  for (const std::string& path : candidates) {
    if (!fs::exists(path, code) || fs::is_directory(path, code)) continue;
    if (!isAllowed(document, path)) throw outside(path);
    document.files.insert(path);
    return path;
  }

  // What there is beside it.
  const std::string folder = folderOf(candidates[0]);
  if (!isAllowed(document, folder.empty() ? "." : folder)) throw outside(candidates[0]);
  Names names;
  fs::directory_iterator entries(folder.empty() ? "." : folder, code);
  if (code)
    throw missing("no such file: \"" + name + "\"",
                  "there is no folder \"" + folder + "\" to look in");
  for (; !code && entries != fs::directory_iterator() && names.size() < 20000;
       entries.increment(code))
    if (!entries->is_directory(code)) names.push_back(entries->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::size_t slash = name.rfind('/');
  throw missing("no such file: \"" + name + "\"",
                "looked in \"" + (folder.empty() ? "." : folder) + "\"; " +
                    suggestion(slash == std::string::npos ? name : name.substr(slash + 1), names));
}

}  // namespace h2mc
