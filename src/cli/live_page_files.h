// SPDX-License-Identifier: MIT
// The sources of the page that is served while a render goes on, as CMake embeds them.
#pragma once

#include <string_view>

namespace h2mc::page {

extern const std::string_view kLiveHtml, kLiveStyle, kLiveScript;

}  // namespace h2mc::page
