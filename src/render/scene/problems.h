// SPDX-License-Identifier: MIT
// What is wrong with a scene, collected while it is read, so that all of it is said at once.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "render/scene/source_text.h"

namespace h2mc {

// How much a scene file may have that the reader does not know.
enum class Strictness {
  kByVersion,  // in files of version 0.x leftovers are warnings, as in Mitsuba 0.6; from 2 on errors
  kPermissive,  // leftovers are warnings whatever the version; what can be left out is left out
  kStrict,      // every warning is an error
};

class Problems {
 public:
  // `warnings`: where warnings go, whole messages, each once. `old`: a file of a version below 2.
  Problems(Strictness strictness, bool old, std::vector<std::string>& warnings)
      : strictness_(strictness), old_(old), warnings_(warnings) {}

  // An error; what does not depend on it is still read. Said once, however often it is met. Throws them
  // all where they are too many for anyone to read.
  void add(const SceneError& error);
  // Errors at this place follow from one that has been added: they are not said.
  void silence(const SourcePlace& place);
  // While it is on, errors do not keep the scene from being rendered: they are warnings, unless strict.
  void doNoHarm(bool on) { harmless_ = on; }
  bool empty() const { return messages_.empty(); }

  // Something to know: the picture may not be what the author wants. An error (SceneError) if strict.
  void warn(const SourcePlace& place, const std::string& message, const std::string& hint = "");
  // A leftover: unknown, given twice, or without effect. A warning in old files and if permissive, else
  // an error (SceneError).
  void tolerate(const SourcePlace& place, const std::string& message, const std::string& hint = "");
  // Something that can't be rendered. A warning if permissive, that says what happens `instead`; else an
  // error (SceneError).
  void refuse(const SourcePlace& place, const std::string& message, const std::string& instead);

  // Throws one SceneError with all messages if there are any. To be called at the end: says how many
  // warnings have not been said.
  void throwIfAny();

  // So many errors, or warnings, are said. Each takes a look at the whole file for its place.
  static constexpr std::size_t kMost = 100, kMostWarnings = 1000;

 private:
  void addWarning(const std::string& text);

  Strictness strictness_;
  bool old_, harmless_ = false;
  std::vector<std::string>& warnings_;
  std::vector<std::string> messages_;
  std::set<std::string> said_, silenced_;
  std::size_t unsaid_ = 0;  // warnings
};

}  // namespace h2mc
