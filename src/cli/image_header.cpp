// SPDX-License-Identifier: MIT
#include "cli/image_header.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <type_traits>

#include "cli/commands.h"

namespace h2mc {
namespace {

constexpr double kMostSamples = 1e18;  // of which a long long can tell

// Text, number or whole number of this name; a fault where it is missing or of another type.
template <class T>
T valueOf(const ImageAttributes& attributes, const char* name) {
  const auto found = attributes.find(name);
  const T* value = found == attributes.end() ? nullptr : std::get_if<T>(&found->second);
  if (!value) throw InputError(fmt::format("its header has no {}", name));
  return *value;
}

// From 0 to `most`.
double numberOf(const ImageAttributes& attributes, const char* name,
                double most = std::numeric_limits<double>::max()) {
  const double value = valueOf<double>(attributes, name);
  if (!(value >= 0 && value <= most))
    throw InputError(fmt::format("the {} of its header is {}", name, value));
  return value;
}

std::set<std::uint64_t> seedsOf(const std::string& text) {
  std::set<std::uint64_t> seeds;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    std::uint64_t seed = 0;
    const auto [last, error] = std::from_chars(at, end, seed);
    if (error != std::errc() || (last != end && *last != ',') || !seeds.insert(seed).second)
      throw InputError("the seeds of its header are no list of whole numbers");
    if (last == end) return seeds;
    at = last + 1;
  }
}

}  // namespace

ImageAttributes attributesOf(const ImageHeader& header) {
  ImageAttributes attributes{
      {"scene", header.scene},
      {"sceneDigest", header.sceneDigest},
      {"integrator", header.integrator},
      {"integratorOptions", header.integratorOptions},
      {"threads", header.threads},
      {"wallSeconds", header.wallSeconds},
      {"cpuSeconds", header.cpuSeconds},
      {"samples", header.samples},
      {"sampleUnit", header.sampleUnit},
      {"meanLuminance", header.meanLuminance},
      {"meanLuminanceError", header.meanLuminanceError},
      {"interrupted", header.interrupted ? 1 : 0},
      {"programVersion", header.programVersion},  // "version" is taken by OpenEXR
  };
  if (!header.request.empty()) attributes["renderRequest"] = header.request;
  if (!header.sceneDefines.empty()) attributes["sceneDefines"] = header.sceneDefines;
  // Text: 64 bits, which no number of the format's holds.
  attributes[header.seeds.size() == 1 ? "seed" : "seeds"] =
      fmt::format("{}", fmt::join(header.seeds, ","));
  return attributes;
}

ImageHeader imageHeader(const ImageAttributes& attributes) {
  ImageHeader header;
  header.programVersion = valueOf<std::string>(attributes, "programVersion");
  header.scene = valueOf<std::string>(attributes, "scene");
  header.sceneDigest = valueOf<std::string>(attributes, "sceneDigest");
  if (attributes.contains("sceneDefines"))
    header.sceneDefines = valueOf<std::string>(attributes, "sceneDefines");
  if (attributes.contains("renderRequest"))
    header.request = valueOf<std::string>(attributes, "renderRequest");
  header.integrator = valueOf<std::string>(attributes, "integrator");
  header.integratorOptions = valueOf<std::string>(attributes, "integratorOptions");
  header.seeds =
      seedsOf(valueOf<std::string>(attributes, attributes.contains("seeds") ? "seeds" : "seed"));
  header.threads = valueOf<int>(attributes, "threads");
  header.wallSeconds = numberOf(attributes, "wallSeconds");
  header.cpuSeconds = numberOf(attributes, "cpuSeconds");
  header.samples = numberOf(attributes, "samples", kMostSamples);
  header.sampleUnit = valueOf<std::string>(attributes, "sampleUnit");
  header.meanLuminance = numberOf(attributes, "meanLuminance");
  header.meanLuminanceError = numberOf(attributes, "meanLuminanceError");
  header.interrupted = valueOf<int>(attributes, "interrupted") != 0;
  return header;
}

}  // namespace h2mc
