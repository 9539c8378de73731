// SPDX-License-Identifier: MIT
// h2mc diff
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

struct DiffOptions {
  std::string image, reference, metric, picture, pictureKind = "signed";
  std::optional<double> tolerance;
};

const Metric& metricNamed(const std::string& name) {
  if (const Metric* metric = findMetric(name)) return *metric;
  Names names;
  for (const Metric& metric : metrics()) names.emplace_back(metric.name);
  names.emplace_back("all");
  throw InputError("unknown metric \"" + name + "\"; " + suggestion(name, names));
}

void warnOfNonFinite(const std::string& path, const Image& image) {
  if (const long long count = countNonFinite(image))
    fmt::print(stderr, "h2mc: {} of {} pixels of \"{}\" are not finite\n", count,
               image.pixels.size(), path);
}

// An image with where it lies in a larger one.
struct Compared {
  std::string path;
  Image image;
  FilmWindow window{};
};

Compared readCompared(const std::string& path) {
  Compared result{path, readImage(path)};
  // Windows are EXRs of our own kind: what has been read as a picture and is not one of them is no part of one.
  if (isExr(path)) try {
      result.window = readExrHeader(path).window;
    } catch (const ImageError&) {
    }
  return result;
}

// Where `part` is a window of a picture of the other's size: the same window of the other.
void matchWindow(const Compared& part, Compared& other) {
  const FilmWindow& window = part.window;
  if (!window.isPart() || other.window.isPart() || other.image.width != window.wholeWidth ||
      other.image.height != window.wholeHeight)
    return;
  Image cut(part.image.width, part.image.height);
  for (int y = 0; y < cut.height; ++y)
    for (int x = 0; x < cut.width; ++x) cut.at(x, y) = other.image.at(window.x + x, window.y + y);
  other.image = std::move(cut);
  fmt::print(stderr, "of \"{}\" the window from ({}, {}) on is compared, {} x {}\n", other.path,
             window.x, window.y, part.image.width, part.image.height);
}

// Where `image` is a whole multiple of `other` in both directions, averages its blocks.
void matchSizes(Image& image, const std::string& path, const Image& other) {
  if (other.width == 0 || image.width <= other.width || image.width % other.width != 0 ||
      image.height % other.height != 0 || image.width / other.width != image.height / other.height)
    return;
  const int factor = image.width / other.width;
  image = averaged(image, factor);
  fmt::print(stderr, "\"{}\" is averaged over {} x {} pixels to the other's size\n", path, factor,
             factor);
}

int diff(const DiffOptions& options) {
  // A tolerance is for one metric; what is not asked for is all of them.
  std::vector<const Metric*> chosen;
  if (options.metric == "all" || (options.metric.empty() && !options.tolerance)) {
    for (const Metric& metric : metrics()) chosen.push_back(&metric);
  } else {
    chosen.push_back(options.metric.empty() ? &metrics().front() : &metricNamed(options.metric));
  }
  if (options.tolerance && chosen.size() > 1)
    throw InputError("--tolerance needs one metric: give --metric NAME");
  if (!options.picture.empty()) checkWritable(options.picture);

  for (const std::string& read : {options.image, options.reference})
    checkDistinct({{"an image that is read", read}, {"the difference picture", options.picture}});
  Compared one = readCompared(options.image), other = readCompared(options.reference);
  if (one.window.isPart() && other.window.isPart() && !(one.window == other.window))
    throw InputError(fmt::format(
        "the images are different windows: \"{}\" is from ({}, {}) on of {} x {}, \"{}\" from ({}, "
        "{}) on of {} x {}",
        one.path, one.window.x, one.window.y, one.window.wholeWidth, one.window.wholeHeight,
        other.path, other.window.x, other.window.y, other.window.wholeWidth,
        other.window.wholeHeight));
  matchWindow(one, other);
  matchWindow(other, one);
  Image &image = one.image, &reference = other.image;
  // A larger picture of the same film is compared at the smaller one's resolution.
  matchSizes(image, options.image, reference);
  matchSizes(reference, options.reference, image);
  if (image.width != reference.width || image.height != reference.height)
    throw InputError(fmt::format("the images differ in size: \"{}\" is {} x {}, \"{}\" is {} x {}",
                                 options.image, image.width, image.height, options.reference,
                                 reference.width, reference.height));
  warnOfNonFinite(options.image, image);
  warnOfNonFinite(options.reference, reference);

  bool within = true;
  for (const Metric* metric : chosen) {
    const double value = metric->compute(image, reference);
    fmt::print("{:<16}{:.6g}\n", metric->name, value);
    // Written so that what is not a number is never within.
    if (options.tolerance)
      within = metric->higherIsBetter ? value >= *options.tolerance : value <= *options.tolerance;
  }
  const double a = meanLuminance(image), r = meanLuminance(reference);
  fmt::print("{:<16}{:.6g}\n{:<16}{:.6g}\n{:<16}{:.6g}\n", "mean", a, "mean-reference", r,
             "mean-ratio", a / r);

  if (!options.picture.empty())
    writeImage(options.picture,
               differencePicture(image, reference,
                                 options.pictureKind == "signed" ? DifferencePicture::kSigned
                                                                 : DifferencePicture::kRelative));
  if (within) return kSuccess;
  fmt::print(stderr, "h2mc: {} is {} the tolerance {:g}\n", chosen.front()->name,
             chosen.front()->higherIsBetter ? "not above" : "not within", *options.tolerance);
  return kCheckFailed;
}

}  // namespace

void addDiffCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<DiffOptions>();
  CLI::App* command = app.add_subcommand("diff", "Error of an image against a reference");
  command->add_option("IMAGE", options->image, "Image of any format that OpenImageIO reads")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("REFERENCE", options->reference,
                   "Reference of the same size; of a window (--crop), of the whole picture's")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--metric", options->metric,
                   "One of the names below, or all (default: all; with --tolerance: relmse)")
      ->type_name("METRIC");
  command->add_option("--tolerance", options->tolerance,
                      "Exit with code 1 if the metric is above (psnr: below) this");
  command->add_option("-o,--output", options->picture, "Write the difference picture")
      ->type_name("FILE");
  command
      ->add_option("--picture", options->pictureKind,
                   "signed: of luminance, red where IMAGE is brighter, blue where it is darker; "
                   "relative: size of the relative error, logarithmic")
      ->capture_default_str()
      ->check(CLI::IsMember({"signed", "relative"}));
  addLimits(*command);
  std::string footer =
      "Metrics (a: image, r: reference, e = a - r, m: the reference's mean luminance; means over "
      "pixels and channels):\n";
  for (const Metric& metric : metrics())
    footer += fmt::format("  {:<16}{}\n", metric.name, metric.description);
  footer += "Mean luminances and their ratio are printed with them.";
  command->footer(footer);
  command->callback([options, &run] { run = [options] { return diff(*options); }; });
}

}  // namespace h2mc
