// SPDX-License-Identifier: MIT
#include "render/scene/change_note.h"

#include <fmt/format.h>

namespace h2mc {

std::string changeNote(const SourcePlace& place, const std::string& what, const std::string& given,
                       const std::string& used) {
  return std::string(kChangeNote) + describe(place) + ": " + what + ": " + given +
         " in the file, used: " + used;
}

std::string colorText(const Rgbf& color) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", color.x, color.y, color.z);
}

void noteChange(const Properties& p, std::string_view name, const std::string& given,
                const std::string& used) {
  if (const auto* listener = dynamic_cast<const ChangeListener*>(&p))
    listener->changed(name, given, used);
}

}  // namespace h2mc
