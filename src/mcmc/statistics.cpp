#include "mcmc/statistics.h"

#include <algorithm>
#include <cmath>

namespace h2mc {

double Moments::variance() const {
  if (count < 2) return 0;
  const double n = static_cast<double>(count), m = sum / n;
  return std::max(0.0, squares / n - m * m) * n / (n - 1);
}

double Moments::standardError() const {
  return count > 0 ? std::sqrt(variance() / static_cast<double>(count)) : 0;
}

void Profile::add(const Profile& other) {
  mutations += other.mutations;
  total += other.total;
  rays += other.rays;
  derivatives += other.derivatives;
  gaussian += other.gaussian;
}

ChainStatistics::ChainStatistics(int mutationKinds, int maxLength)
    : acceptance(static_cast<std::size_t>(mutationKinds),
                 std::vector<AcceptanceCount>(static_cast<std::size_t>(maxLength) + 1)),
      levels(static_cast<std::size_t>(mutationKinds),
             std::vector<AcceptanceCount>(2 * kHighestLevel + 1)) {}

void DerivativeCounts::add(const DerivativeCounts& other) {
  steps += other.steps;
  dark += other.dark;
  kept += other.kept;
  computed += other.computed;
  inDouble += other.inDouble;
  flat += other.flat;
  notFinite += other.notFinite;
}

nlohmann::json DerivativeCounts::json() const {
  return {{"steps", steps},         {"proposals without contribution", dark},
          {"kept", kept},           {"computed", computed},
          {"in double", inDouble},  {"negligible", flat},
          {"not finite", notFinite}};
}

void ChainStatistics::add(const ChainStatistics& other) {
  const auto addAll = [](auto& to, const auto& from) {
    for (std::size_t kind = 0; kind < to.size(); ++kind)
      for (std::size_t i = 0; i < to[kind].size(); ++i) to[kind][i].add(from[kind][i]);
  };
  addAll(acceptance, other.acceptance);
  addAll(levels, other.levels);
  derivatives.add(other.derivatives);
  largeSteps.add(other.largeSteps);
  profile.add(other.profile);
  mutations += other.mutations;
  notFinite += other.notFinite;
  if (firstNotFinite.empty()) firstNotFinite = other.firstNotFinite;
}

namespace {

// A row for each level that was met: how often, and the acceptance of each kind there.
nlohmann::json levelTable(const std::vector<std::vector<AcceptanceCount>>& levels,
                          const std::vector<std::string>& kindNames) {
  nlohmann::json table = nlohmann::json::array();
  for (std::size_t i = 0; i < levels[0].size(); ++i) {
    nlohmann::json row = {{"level", static_cast<int>(i) - kHighestLevel}};
    long long states = 0;
    for (std::size_t kind = 0; kind < levels.size(); ++kind) {
      const AcceptanceCount& count = levels[kind][i];
      states += count.proposed;
      if (count.proposed > 0)
        row[kindNames[kind]] = count.expected / static_cast<double>(count.proposed);
    }
    row["states"] = states;
    if (states > 0) table.push_back(row);
  }
  return table;
}

}  // namespace

nlohmann::json ChainStatistics::json(const std::vector<std::string>& kindNames) const {
  const auto rate = [](const AcceptanceCount& c) {
    return nlohmann::json{
        {"proposed", c.proposed},
        {"acceptance", c.proposed > 0 ? c.expected / static_cast<double>(c.proposed) : 0.0}};
  };
  nlohmann::json kinds = nlohmann::json::object();
  for (std::size_t kind = 0; kind < acceptance.size(); ++kind) {
    AcceptanceCount all;
    nlohmann::json byLength = nlohmann::json::object();
    for (std::size_t length = 0; length < acceptance[kind].size(); ++length) {
      const AcceptanceCount& count = acceptance[kind][length];
      all.add(count);
      if (count.proposed > 0) byLength[std::to_string(length)] = rate(count);
    }
    kinds[kindNames[kind]] = rate(all);
    kinds[kindNames[kind]]["by path length"] = byLength;
  }
  const auto share = [&](double seconds) {
    return profile.total > 0 ? seconds / profile.total : 0.0;
  };
  nlohmann::json result = {
      {"mutations", mutations},
      {"mutation kinds", kinds},
      {"acceptance by level of the target", levelTable(levels, kindNames)},
      {"derivatives", derivatives.json()},
      {"time shares",
       {{"tracing", share(profile.rays)},
        {"derivatives", share(profile.derivatives)},
        {"gaussian", share(profile.gaussian)},
        {"contribution and rest",
         share(profile.total - profile.rays - profile.derivatives - profile.gaussian)}}},
      {"not finite", notFinite}};
  if (!firstNotFinite.empty()) result["first not finite"] = firstNotFinite;
  return result;
}

}  // namespace h2mc
