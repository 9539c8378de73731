// SPDX-License-Identifier: MIT
// h2mc merge
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "cli/commands.h"
#include "cli/identity.h"
#include "cli/image_header.h"
#include "cli/statistics_table.h"
#include "render/core/memory.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"
#include "render/integrator/features.h"

namespace h2mc {
namespace {

struct MergeOptions {
  std::vector<std::string> images;
  std::string output;
  bool quiet = false;
};

// One of the images, but for its pixels.
struct Part {
  std::string file;
  int width = 0, height = 0;
  FilmWindow window;
  ImageHeader header;
  std::vector<std::string> layers;
};

// "a=1,b=2" as a map, without the budget.
std::map<std::string, std::string> optionsOf(const std::string& text) {
  std::map<std::string, std::string> options;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string option = text.substr(begin, end - begin);
    const std::string name = option.substr(0, option.find('='));
    if (!isBudget(name)) options[name] = option.substr(std::min(name.size() + 1, option.size()));
    begin = end + 1;
  }
  return options;
}

std::string textOf(const std::map<std::string, std::string>& options) {
  std::string text;
  for (const auto& [name, value] : options)
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
  return text;
}

Part readPart(const std::string& file) {
  const ExrHeader exr = readExrHeader(file);
  Part part{file, exr.width, exr.height, exr.window, {}, layersOf(exr)};
  const auto fail = [&](const std::string& why) -> InputError {
    return InputError(fmt::format("cannot merge \"{}\": {}", file, why));
  };
  try {
    part.header = imageHeader(exr.attributes);
  } catch (const InputError& e) {
    throw fail(std::string(e.what()) +
               "; expected an EXR as this version's `h2mc render` or `h2mc merge` writes it");
  }
  for (const char* channel : {"R", "G", "B"})
    if (std::find(exr.channels.begin(), exr.channels.end(), channel) == exr.channels.end())
      throw fail(
          fmt::format("its channels are {}, expected R, G and B", fmt::join(exr.channels, ", ")));
  if (!(part.header.samples > 0)) throw fail("it has no " + part.header.sampleUnit + " yet");
  return part;
}

// The first thing in which the two differ that have to be of one kind; empty: nothing.
std::string difference(const Part& a, const Part& b) {
  const ImageHeader &x = a.header, &y = b.header;
  const auto differs = [](const std::string& what, const std::string& one,
                          const std::string& other) {
    const auto shown = [](const std::string& text) { return text.empty() ? "missing" : text; };
    return one == other
               ? ""
               : fmt::format("{} is {} in one and {} in the other", what, shown(one), shown(other));
  };
  const auto size = [](const Part& p) { return fmt::format("{} x {}", p.width, p.height); };
  const auto window = [](const Part& p) {
    const FilmWindow& w = p.window;
    return w.isPart()
               ? fmt::format("from ({}, {}) on of {} x {}", w.x, w.y, w.wholeWidth, w.wholeHeight)
               : std::string("the whole");
  };
  std::string found = differs("the program version", x.programVersion, y.programVersion);
  if (found.empty() && x.sceneDigest != y.sceneDigest) {
    found = differs("what -D defines", x.sceneDefines, y.sceneDefines);
    if (found.empty())
      found = x.scene == y.scene
                  ? fmt::format("\"{}\", a file that it refers to, or how it was read, has changed",
                                x.scene)
                  : fmt::format("the scenes \"{}\" and \"{}\" are not the same", x.scene, y.scene);
  }
  if (found.empty()) found = differs("the size", size(a), size(b));
  if (found.empty()) found = differs("the window", window(a), window(b));
  if (found.empty()) found = differs("the integrator", x.integrator, y.integrator);
  if (found.empty()) found = differs("the unit of work", x.sampleUnit, y.sampleUnit);
  if (!found.empty()) return found;
  const auto one = optionsOf(x.integratorOptions), other = optionsOf(y.integratorOptions);
  const auto valueIn = [](const std::map<std::string, std::string>& options,
                          const std::string& name) {
    const auto option = options.find(name);
    return option == options.end() ? "" : option->second;
  };
  auto all = one;
  all.insert(other.begin(), other.end());
  for (const auto& [name, value] : all)
    if (found.empty())
      found = differs("the option " + name, valueIn(one, name), valueIn(other, name));
  return found;
}

// All headers, which belong together. Throws InputError.
std::vector<Part> readParts(const std::vector<std::string>& files) {
  std::vector<Part> parts;
  std::map<std::uint64_t, std::string> seen;  // seeds, and where
  for (const std::string& file : files) {
    parts.push_back(readPart(file));
    const Part& part = parts.back();
    const std::string different = difference(parts.front(), part);
    if (!different.empty())
      throw InputError(
          fmt::format("\"{}\" and \"{}\" can't be merged: {}", files.front(), file, different));
    for (const std::uint64_t seed : part.header.seeds) {
      const auto [other, isNew] = seen.emplace(seed, file);
      if (!isNew)
        throw InputError(
            fmt::format("\"{}\" and \"{}\" can't be merged: seed {} is in both, so that they hold "
                        "the same samples",
                        other->second, file, seed));
    }
  }
  return parts;
}

// As if one render after the other had been one.
ImageHeader mergedHeader(const std::vector<Part>& parts) {
  ImageHeader merged = parts.front().header;
  merged.integratorOptions = textOf(optionsOf(merged.integratorOptions));
  merged.threads = 0;
  merged.wallSeconds = merged.cpuSeconds = merged.samples = 0;
  merged.interrupted = false;
  if (parts.size() > 1) merged.request.clear();
  double luminance = 0, variance = 0;  // times the samples, and their square
  for (const Part& part : parts) {
    const ImageHeader& header = part.header;
    merged.seeds.insert(header.seeds.begin(), header.seeds.end());
    merged.threads = std::max(merged.threads, header.threads);
    merged.wallSeconds += header.wallSeconds;
    merged.cpuSeconds += header.cpuSeconds;
    merged.samples += header.samples;
    merged.interrupted |= header.interrupted;
    luminance += header.samples * header.meanLuminance;
    variance += std::pow(header.samples * header.meanLuminanceError, 2);
  }
  merged.meanLuminance = luminance / merged.samples;
  merged.meanLuminanceError = std::sqrt(variance) / merged.samples;
  return merged;
}

// The mean of the images, each with the share of its samples in all.
Image meanOf(const std::vector<Part>& parts, double samples) {
  const Part& first = parts.front();
  const std::size_t values = std::size_t{3} * first.width * first.height;
  requireMemory(static_cast<double>(values) * (sizeof(double) + sizeof(float)),
                fmt::format("the sum of images of {} x {} pixels", first.width, first.height),
                "expected smaller images");
  std::vector<double> sums(values);
  for (const Part& part : parts) {
    const Image image = readImage(part.file);
    if (image.width != first.width || image.height != first.height)
      throw InputError("\"" + part.file + "\" has changed while it was read");
    if (const long long count = countNonFinite(image))
      throw InputError(
          fmt::format("cannot merge \"{}\": {} of its pixels are not finite", part.file, count));
    const double share = part.header.samples / samples;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) sums[3 * i + c] += share * image.pixels[i][c];
  }
  Image mean(first.width, first.height);
  for (std::size_t i = 0; i < mean.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) mean.pixels[i][c] = static_cast<float>(sums[3 * i + c]);
  return mean;
}

// What all images together say of their pixels: counts add up, variances as those of a mean. What was seen first is
// the same in all of them, so one image's is taken.
std::vector<Layer> mergedLayers(const std::vector<Part>& parts, double samples) {
  std::vector<Layer> merged;
  for (const LayerName& kind : layerNames()) {
    std::vector<const Part*> having;
    for (const Part& part : parts)
      if (std::count(part.layers.begin(), part.layers.end(), kind.name) > 0)
        having.push_back(&part);
    if (having.empty()) continue;
    const auto read = [&](const Part& part) {
      Layer layer = std::move(readLayers(part.file, {kind.name}).front());
      if (layer.channels != kind.channels ||
          layer.values.size() != at(part.width) * at(part.height) * kind.channels.size())
        throw InputError(fmt::format("cannot merge \"{}\": its layer {} is not one of h2mc's",
                                     part.file, kind.name));
      return layer;
    };
    if (isFeature(kind.kind)) {
      merged.push_back(read(*having.front()));
      continue;
    }
    if (having.size() < parts.size()) continue;
    const std::size_t pixels = at(parts.front().width) * at(parts.front().height);
    Layer sum = makeLayer(kind.kind, pixels);
    for (const Part& part : parts) {
      const double share = part.header.samples / samples;
      const auto weight = static_cast<float>(kind.kind == LayerKind::kVariance ? share * share : 1);
      const Layer own = read(part);
      for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += weight * own.values[i];
    }
    merged.push_back(std::move(sum));
  }
  return merged;
}

// Names of layers that an image has and the merged one does not.
std::set<std::string> leftOut(const std::vector<Part>& parts, const std::vector<Layer>& merged) {
  std::set<std::string> names;
  for (const Part& part : parts) names.insert(part.layers.begin(), part.layers.end());
  for (const Layer& layer : merged) names.erase(layer.name);
  return names;
}

int merge(const MergeOptions& options) {
  for (const std::string& image : options.images)
    checkDistinct({{"an image that is read", image}, {"the merged image", options.output}});
  checkWritable(options.output);
  const std::vector<Part> parts = readParts(options.images);
  const ImageHeader header = mergedHeader(parts);
  const Image mean = meanOf(parts, header.samples);
  std::vector<Layer> layers;
  if (isExr(options.output)) layers = mergedLayers(parts, header.samples);
  const std::set<std::string> dropped = leftOut(parts, layers);
  try {
    writeLayeredImage(options.output, mean, {attributesOf(header), layers, parts.front().window});
  } catch (const ImageError& e) {  // the path was right before
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  if (!options.quiet)
    fmt::print(stderr, "{}: {} image{}, {} x {}, {} {}\nmean luminance {:.6g} +- {:.2g}\n",
               options.output, parts.size(), parts.size() == 1 ? "" : "s", mean.width, mean.height,
               withSeparators(static_cast<long long>(header.samples)), header.sampleUnit,
               header.meanLuminance, header.meanLuminanceError);
  if (!options.quiet && !dropped.empty())
    fmt::print(stderr, "layers left out{}: {}\n",
               isExr(options.output) ? ", as not all images have them or they are not h2mc's" : "",
               fmt::join(dropped, ", "));
  return kSuccess;
}

}  // namespace

void addMergeCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command =
      app.add_subcommand("merge", "One image out of renders that differ in their seeds");
  command->add_option("IMAGE", options->images, "Images of `h2mc render` or `h2mc merge`, EXR")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->output,
                   "Image to write: .exr (which can be merged again), .hdr or .png")
      ->required()
      ->type_name("FILE");
  addLimits(*command);
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but errors");
  command->footer(
      "The result is the mean of the images, each with the weight of its samples or mutations as "
      "its header has them. Images are refused that differ in program version, scene, size, "
      "integrator or options (budgets may differ), and those that share a seed. One image alone "
      "is taken too. Of layers, mutations are added up and variances become that of the mean, "
      "where "
      "all images have them; what is seen first is the first image's that has it.\n"
      "\n"
      "Example, each render on a machine of its own:\n"
      "  h2mc render ring.xml --seed 1 -o ring-1.exr\n"
      "  h2mc render ring.xml --seed 2 -o ring-2.exr\n"
      "  h2mc merge ring-?.exr -o ring.exr");
  command->callback([options, &run] { run = [options] { return merge(*options); }; });
}

}  // namespace h2mc
