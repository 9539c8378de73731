// SPDX-License-Identifier: MIT
// h2mc demo
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/stop_signals.h"
#include "demo/image_copy.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

struct ImageCopyOptions {
  std::string picture, output;
  int width = 128;
  ImageCopySettings settings;
};

int imageCopy(const ImageCopyOptions& options) {
  const std::string output = options.output.empty()
                                 ? fs::path(options.picture).stem().string() + "-copy.html"
                                 : options.output;
  checkDistinct({{"the picture", options.picture}, {"the page", output}});
  checkWritableFile(output);
  Image picture = readImage(options.picture);
  if (countNonFinite(picture) > 0)
    throw InputError("\"" + options.picture + "\" has pixels that are not finite");
  for (Rgbf& p : picture.pixels)
    for (int c = 0; c < 3; ++c) p[c] = std::max(p[c], 0.f);
  picture = shrunk(picture, options.width);
  if (!(meanLuminance(picture) > 0))
    throw InputError("\"" + options.picture + "\" is black: there is nothing to sample");

  const StopSignals signals;
  const nlohmann::json result =
      copyImage(PictureTarget(picture), options.settings, StopSignals::requested());
  if (result.is_null()) {
    fmt::print(stderr, "h2mc: interrupted; nothing was written\n");
    return kInterrupted;
  }
  writeTextAtomically(output, imageCopyPage(result, fs::path(options.picture).filename().string()));
  fmt::print("{:<20} {:>10} {:>10} {:>10}\n", "mutations", "a pixel", "acceptance", "relmse");
  for (const nlohmann::json& method : result["methods"])
    for (const nlohmann::json& level : method["levels"])
      fmt::print("{:<20} {:>10} {:>10.3f} {:>10.4g}\n", method["name"].get<std::string>(),
                 level["perPixel"].get<long long>(), level["acceptance"].get<double>(),
                 level["relmse"].get<double>());
  fmt::print(stderr, "{}: the page\n", output);
  return kSuccess;
}

}  // namespace

void addDemoCommand(CLI::App& app, Run& run) {
  CLI::App* demo = app.add_subcommand("demo", "Demonstrations of the method, as pages");
  demo->require_subcommand(1);
  auto options = std::make_shared<ImageCopyOptions>();
  ImageCopySettings& settings = options->settings;
  CLI::App* copy = demo->add_subcommand(
      "image-copy",
      "Copy a picture by Metropolis sampling of its luminance, with several mutations");
  copy->add_option("PICTURE", options->picture, "Image of any format that OpenImageIO reads")
      ->required()
      ->type_name("FILE");
  copy->add_option("-o,--output", options->output,
                   "Page to write; default: the picture's name with -copy.html, here")
      ->type_name("FILE");
  copy->add_option("--width", options->width, "The picture is shrunk to this width if it is wider")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  copy->add_option("--sigma", settings.sigma, "Size of isotropic steps, of the picture's edges")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  copy->add_option("--prior-sigma", settings.priorSigma, "The same for Hamiltonian steps' prior")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  copy->add_option("--large", settings.largeShare, "Share of large mutations in mixtures")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  addSeed(*copy, settings.seed, "Same picture, options and seed: same page");
  addThreads(*copy, settings.threads);
  addLimits(*copy);
  copy->callback([options, &run] { run = [options] { return imageCopy(*options); }; });
}

}  // namespace h2mc
