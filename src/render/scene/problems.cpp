// SPDX-License-Identifier: MIT
#include "render/scene/problems.h"

namespace h2mc {

void Problems::add(const SceneError& error) {
  if (!error.place().empty() && silenced_.count(error.place())) return;
  if (harmless_ && strictness_ != Strictness::kStrict) {
    std::string text = error.what();
    const std::string label = ": error: ";
    if (const std::size_t at = text.find(label); at != std::string::npos)
      text.replace(at, label.size(), ": warning: ");
    if (said_.insert(text).second) warnings_.push_back(text);
    return;
  }
  if (said_.insert(error.what()).second) messages_.emplace_back(error.what());
}

void Problems::silence(const SourcePlace& place) { silenced_.insert(describe(place)); }

void Problems::warn(const SourcePlace& place, const std::string& message, const std::string& hint) {
  if (strictness_ == Strictness::kStrict) throw sourceError(place, message, hint);
  const std::string text = sourceMessage(place, "warning", message, hint);
  if (said_.insert(text).second) warnings_.push_back(text);
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

void Problems::throwIfAny() const {
  if (messages_.empty()) return;
  constexpr std::size_t kMost = 100;
  std::string all;
  for (std::size_t i = 0; i < messages_.size() && i < kMost; ++i)
    all += (all.empty() ? "" : "\n") + messages_[i];
  if (messages_.size() > kMost)
    all += "\nand " + std::to_string(messages_.size() - kMost) + " more";
  throw SceneError(all);
}

}  // namespace h2mc
