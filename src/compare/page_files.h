// SPDX-License-Identifier: MIT
// The sources of the page, from page/, as CMake embeds them.
#pragma once

#include <string_view>

namespace h2mc::page {

extern const std::string_view kHtml, kStyle, kScript;

}  // namespace h2mc::page
