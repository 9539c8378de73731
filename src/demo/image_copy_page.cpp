// SPDX-License-Identifier: MIT
#include "compare/embed.h"
#include "demo/image_copy.h"
#include "demo/page_files.h"

namespace h2mc {

std::string imageCopyPage(const nlohmann::json& result, const std::string& name) {
  nlohmann::json data = result;
  data["name"] = name;
  return filledPage(page::kImageCopyHtml, page::kDemoStyle, page::kImageCopyScript, data);
}

}  // namespace h2mc
