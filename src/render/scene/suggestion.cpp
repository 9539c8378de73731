// SPDX-License-Identifier: MIT
#include "render/scene/suggestion.h"

#include <algorithm>
#include <numeric>

namespace h2mc {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool upper(char c) { return c >= 'A' && c <= 'Z'; }

std::string folded(std::string_view text) {
  std::string result;
  for (char c : text)
    if (c != '_') result += lower(c);
  return result;
}

// Optimal string alignment: insertions, deletions, replacements, swapped neighbours.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> previous(b.size() + 1), current(b.size() + 1), older;
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      current[j] = std::min(
          {previous[j] + 1, current[j - 1] + 1, previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], older[j - 2] + 1);
    }
    older = previous;
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::string closestName(std::string_view name, const Names& candidates) {
  constexpr std::size_t kLongest = 64;   // a longer "name" is no typing mistake
  constexpr std::size_t kMost = 100000;  // ids of a scene: too many to compare with
  if (name.empty() || name.size() > kLongest || candidates.size() > kMost) return "";
  const std::string wanted = folded(name);
  std::string best;
  std::size_t bestDistance = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest) continue;
    const std::string other = folded(candidate);
    // Each letter more is a step.
    if (std::max(wanted.size(), other.size()) - std::min(wanted.size(), other.size()) >=
        bestDistance)
      continue;
    const std::size_t d = distance(wanted, other);
    if (d < bestDistance) {
      bestDistance = d;
      best = candidate;
    }
  }
  return best;
}

std::string joined(const Names& names) {
  std::string result;
  for (const std::string& name : names) {
    if (!result.empty()) result += ", ";
    result += name;
  }
  return result;
}

std::string suggestion(std::string_view name, const Names& candidates) {
  std::string result;
  const std::string closest = closestName(name, candidates);
  if (!closest.empty()) result = "did you mean \"" + closest + "\"? ";
  constexpr std::size_t kMost = 60;
  if (candidates.empty()) return result + "available: none";
  if (candidates.size() <= kMost) return result + "available: " + joined(candidates);
  const Names first(candidates.begin(), candidates.begin() + kMost);
  return result + "available: " + joined(first) + " and " +
         std::to_string(candidates.size() - kMost) + " more";
}

std::string snakeCase(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && upper(name[i]) && !upper(name[i - 1]) && name[i - 1] != '_') result += '_';
    result += lower(name[i]);
  }
  return result;
}

std::string lowerCase(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower(c);
  return result;
}

}  // namespace h2mc
