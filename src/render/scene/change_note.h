// SPDX-License-Identifier: MIT
// Parameters whose value in the file is not the one that is used: `h2mc info` names them.
#pragma once

#include <string>
#include <string_view>

#include "render/core/types.h"
#include "render/scene/source_text.h"

namespace h2mc {

// How such a note begins among Scene::notes.
inline constexpr std::string_view kChangeNote = "changed: ";

// The note: `what` is `given` in the file, and `used` instead.
std::string changeNote(const SourcePlace& place, const std::string& what, const std::string& given,
                       const std::string& used);

// "(r, g, b)".
std::string colorText(const Rgbf& color);

// What properties are that have somebody to tell.
class ChangeListener {
 public:
  virtual void changed(std::string_view name, const std::string& given,
                       const std::string& used) const = 0;

 protected:
  ~ChangeListener() = default;
};

// Notes it of a parameter. Nothing where there is nobody to tell, as in tests.
void noteChange(const Properties& p, std::string_view name, const std::string& given,
                const std::string& used);

}  // namespace h2mc
