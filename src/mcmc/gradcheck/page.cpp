#include "mcmc/gradcheck/report.h"
namespace h2mc {
std::string gradcheckPage(const nlohmann::json& report) { return report.dump(); }
}  // namespace h2mc
