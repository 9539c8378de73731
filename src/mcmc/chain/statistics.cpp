// SPDX-License-Identifier: MIT
#include "mcmc/chain/statistics.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/core/archive.h"

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
      octaves(static_cast<std::size_t>(mutationKinds), std::vector<AcceptanceCount>(kOctaves)),
      departures(kOctaves, 0),
      refusals(static_cast<std::size_t>(mutationKinds)),
      sums(static_cast<std::size_t>(mutationKinds)),
      secondTries(static_cast<std::size_t>(mutationKinds)) {}

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
  addAll(octaves, other.octaves);
  for (std::size_t i = 0; i < kOctaves; ++i) departures[i] += other.departures[i];
  for (std::size_t kind = 0; kind < sums.size(); ++kind) {
    sums[kind].resize(std::max(sums[kind].size(), other.sums[kind].size()), 0);
    for (std::size_t i = 0; i < other.sums[kind].size(); ++i) sums[kind][i] += other.sums[kind][i];
  }
  for (std::size_t kind = 0; kind < refusals.size(); ++kind)
    for (std::size_t why = 0; why < kRefusals; ++why)
      refusals[kind][why] += other.refusals[kind][why];
  for (std::size_t kind = 0; kind < secondTries.size(); ++kind)
    secondTries[kind].add(other.secondTries[kind]);
  derivatives.add(other.derivatives);
  largeSteps.add(other.largeSteps);
  profile.add(other.profile);
  mutations += other.mutations;
  notFinite.add(other.notFinite);
}

void ChainStatistics::archive(Archive& archive) {
  archive(acceptance, octaves, departures, refusals, sums, secondTries, derivatives, largeSteps,
          profile, mutations, notFinite);
}

namespace {

// A row for each octave that was met: how often, the acceptance of each kind there, and for how many mutations chains
// stay within a pixel.
nlohmann::json octaveTable(const std::vector<std::vector<AcceptanceCount>>& octaves,
                           const std::vector<double>& departures,
                           const std::vector<std::string>& kindNames) {
  nlohmann::json table = nlohmann::json::array();
  for (std::size_t i = 0; i < octaves[0].size(); ++i) {
    nlohmann::json row = {{"octave", static_cast<int>(i) - kHighestOctave}};
    long long states = 0;
    for (std::size_t kind = 0; kind < octaves.size(); ++kind) {
      const AcceptanceCount& count = octaves[kind][i];
      states += count.proposed;
      if (count.proposed > 0)
        row[kindNames[kind]] = count.expected / static_cast<double>(count.proposed);
    }
    row["states"] = states;
    row["mutations within a pixel"] = heldFor(states, departures[i]);
    if (states > 0) table.push_back(row);
  }
  return table;
}

// What share of a kind's proposals came to nothing for each cause that it tells.
nlohmann::json refusalShares(const std::array<long long, kRefusals>& refusals, long long proposed) {
  static constexpr const char* kNames[kRefusals] = {"untold",  "structure", "range",
                                                    "blocked", "dark",      "technique"};
  nlohmann::json shares = nlohmann::json::object();
  for (std::size_t why = 1; why < kRefusals; ++why)
    if (refusals[why] > 0)
      shares[kNames[why]] = static_cast<double>(refusals[why]) / static_cast<double>(proposed);
  return shares;
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
    if (secondTries[kind].proposed > 0)
      kinds[kindNames[kind]]["second try"] = rate(secondTries[kind]);
    const nlohmann::json refused = refusalShares(refusals[kind], all.proposed);
    if (!refused.empty()) kinds[kindNames[kind]]["refused"] = refused;
  }
  const auto share = [&](double seconds) {
    return profile.total > 0 ? seconds / profile.total : 0.0;
  };
  nlohmann::json result = {
      {"mutations", mutations},
      {"mutation kinds", kinds},
      {"acceptance by octave of the target", octaveTable(octaves, departures, kindNames)},
      {"derivatives", derivatives.json()},
      {"time shares",
       {{"tracing", share(profile.rays)},
        {"derivatives", share(profile.derivatives)},
        {"gaussian", share(profile.gaussian)},
        {"contribution and rest",
         share(profile.total - profile.rays - profile.derivatives - profile.gaussian)}}},
      {"not finite", notFinite.count}};
  if (!notFinite.first.empty()) result["first not finite"] = notFinite.first;
  return result;
}

}  // namespace h2mc
