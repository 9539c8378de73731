// SPDX-License-Identifier: MIT
// The sources of the demonstrations' pages, as CMake embeds them.
#pragma once

#include <string_view>

namespace h2mc::page {

extern const std::string_view kDemoStyle, kImageCopyHtml, kImageCopyScript;

}  // namespace h2mc::page
