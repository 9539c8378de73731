// SPDX-License-Identifier: MIT
#include "render/scene/problems.h"

namespace h2mc {

void Problems::add(const SceneError& error) {
  if (messages_.size() > kMost) throwIfAny();  // on the way out
  if (!error.place().empty() && silenced_.count(error.place())) return;
  if (harmless_ && strictness_ != Strictness::kStrict) {
    std::string text = error.what();
    const std::string label = ": error: ";
    if (const std::size_t at = text.find(label); at != std::string::npos)
      text.replace(at, label.size(), ": warning: ");
    addWarning(text);
    return;
  }
  if (said_.insert(error.what()).second) messages_.emplace_back(error.what());
  if (messages_.size() == kMost) {
    messages_.emplace_back("there is more, which is not looked at");
    throwIfAny();
  }
}

void Problems::addWarning(const std::string& text) {
  if (warnings_.size() >= kMostWarnings)
    ++unsaid_;
  else if (said_.insert(text).second)
    warnings_.push_back(text);
}

void Problems::silence(const SourcePlace& place) { silenced_.insert(describe(place)); }

void Problems::warn(const SourcePlace& place, const std::string& message, const std::string& hint) {
  if (strictness_ == Strictness::kStrict) throw sourceError(place, message, hint);
  if (warnings_.size() >= kMostWarnings)
    ++unsaid_;
  else
    addWarning(sourceMessage(place, "warning", message, hint));
}

void Problems::tolerate(const SourcePlace& place, const std::string& message,
                        const std::string& hint) {
  if (!old_ && strictness_ != Strictness::kPermissive) throw sourceError(place, message, hint);
  warn(place, message, hint);
}

void Problems::refuse(const SourcePlace& place, const std::string& message,
                      const std::string& instead) {
  if (strictness_ != Strictness::kPermissive)
    throw sourceError(place, message, "with --permissive " + instead);
  warn(place, message, instead);
}

void Problems::throwIfAny() {
  if (unsaid_ > 0) warnings_.push_back("and " + std::to_string(unsaid_) + " more warnings");
  unsaid_ = 0;
  if (messages_.empty()) return;
  std::string all;
  for (const std::string& message : messages_) all += (all.empty() ? "" : "\n") + message;
  throw SceneError(all);
}

}  // namespace h2mc
