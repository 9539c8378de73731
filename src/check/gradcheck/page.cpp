// SPDX-License-Identifier: MIT
// gradcheck's findings as a page: the report itself as JSON in a template that draws it.
#include "check/gradcheck/page_template.h"
#include "check/gradcheck/report.h"

namespace h2mc {

std::string gradcheckPage(const nlohmann::json& report) {
  std::string data = report.dump();
  // No text of the scene's may end the script.
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6)
    data.replace(at, 1, "\\u003c");
  std::string page(kGradcheckPage);
  page.replace(page.find(kGradcheckData), kGradcheckData.size(), data);
  return page;
}

}  // namespace h2mc
