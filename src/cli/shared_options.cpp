// SPDX-License-Identifier: MIT
// Options that several commands have.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <limits>

#include "cli/commands.h"
#include "render/core/memory.h"
#include "render/image/image_limits.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

// CLI::Range goes by double, in which 2^64 - 1 and 2^64 are one number.
CLI::Validator wholeNumber(std::uint64_t low, std::uint64_t high) {
  return {[low, high](const std::string& text) -> std::string {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [last, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && last == end && value >= low && value <= high) return "";
            return "expected a whole number from " + std::to_string(low) + " to " +
                   std::to_string(high) + ", got \"" + text + "\"";
          },
          ""};
}

const CLI::Validator kSeed = wholeNumber(0, std::numeric_limits<std::uint64_t>::max());

}  // namespace

CLI::Validator positiveNumber() {
  return {[](const std::string& text) -> std::string {
            double value = 0;
            const char* const end = text.data() + text.size();
            const auto [last, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && last == end && std::isfinite(value) && value > 0) return "";
            return "expected a number above 0, got \"" + text + "\"";
          },
          ""};
}

void addDefines(CLI::App& command, std::vector<std::string>& definitions) {
  command
      .add_option("-D", definitions, "name=value: what the scene's $name stands for; repeatable")
      ->allow_extra_args(false);
}

std::map<std::string, std::string> parseDefines(const std::vector<std::string>& definitions) {
  std::map<std::string, std::string> defines;
  for (const std::string& definition : definitions) {
    const std::size_t equals = definition.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw InputError("-D " + definition + ": expected name=value");
    defines[definition.substr(0, equals)] = definition.substr(equals + 1);
  }
  return defines;
}

void addPermissive(CLI::App& command, bool& permissive) {
  command.add_flag(
      "--permissive", permissive,
      "Leave out what of the scene is not understood, with a warning, where that is an "
      "error: unknown parameters in files of version 2 or 3, media, texels that are no colours");
}

Strictness strictnessOf(bool permissive) {
  return permissive ? Strictness::kPermissive : Strictness::kByVersion;
}

void addConfine(CLI::App& command, std::string& folder) {
  command
      .add_option("--confine", folder,
                  "DIR: fail where the scene refers to a file that is not below this folder once "
                  "symbolic links are followed; for scenes from strangers")
      ->check(CLI::ExistingDirectory)
      ->option_text("DIR");
}

ReadOptions readOptionsOf(const std::vector<std::string>& defines, bool permissive,
                          const std::string& confine) {
  static const std::vector<IntegratorPlugin> integrators = integratorPlugins();
  ReadOptions read;
  read.defines = parseDefines(defines);
  read.strictness = strictnessOf(permissive);
  read.integrators = integrators;
  read.confine = confine;
  return read;
}

void addSeed(CLI::App& command, std::uint64_t& seed, const std::string& description) {
  command.add_option("--seed", seed, description)->check(kSeed);
}
void addSeed(CLI::App& command, std::optional<std::uint64_t>& seed,
             const std::string& description) {
  command.add_option("--seed", seed, description)->check(kSeed);
}

void addLimits(CLI::App& command) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
  command
      .add_option_function<std::uint64_t>(
          "--max-texture-pixels", [](const std::uint64_t& count) { setMostPixels(count); },
          "Refuse images that have more; default: " + std::to_string(kMostPixels))
      ->check(wholeNumber(1, kMost));
  command
      .add_option_function<double>(
          "--max-memory", [](const double& gigabytes) { setMostMemory(gigabytes * 1e9); },
          "GB that the program may take: what needs more is refused before it begins; default: "
          "what "
          "the machine, or its control group, has left")
      ->check(positiveNumber());
}

void addThreads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Default: one a core")
      ->check(wholeNumber(1, kMostThreads));
}

}  // namespace h2mc
