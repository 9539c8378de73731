// SPDX-License-Identifier: MIT
// h2mc render
#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "cli/commands.h"
#include "cli/render_run.h"
#include "render/integrator/features.h"

namespace h2mc {
namespace {

// "X,Y,W,H"
PixelRectangle rectangleOf(const std::string& text) {
  PixelRectangle r;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int* value : {&r.x, &r.y, &r.width, &r.height}) {
    const auto [last, error] = std::from_chars(at, end, *value);
    const bool isLast = value == &r.height;
    if (error != std::errc() || *value < (value == &r.x || value == &r.y ? 0 : 1) ||
        (isLast ? last != end : last == end || *last != ','))
      throw CLI::ValidationError(
          "--crop",
          "expected X,Y,W,H, the window's left upper pixel and its size, got \"" + text + "\"");
    at = last + 1;
  }
  return r;
}

}  // namespace

void addBudget(CLI::App& command, RenderBudget& budget, const std::string& description) {
  auto* group = command.add_option_group("Budget", description);
  group->add_option("-t,--time", budget.seconds, "Seconds to render for")->check(positiveNumber());
  group->add_option("-s,--samples-per-pixel", budget.samplesPerPixel, "Samples a pixel")
      ->check(positiveNumber());
  group->add_option("-m,--mutations-per-pixel", budget.mutationsPerPixel, "Mutations a pixel")
      ->check(positiveNumber());
}

void addOutputOptions(CLI::App& command, RenderOptions& options) {
  command.add_flag("--png", options.png, "Write a PNG (sRGB) beside the image as well");
  addLookOptions(command, options.look);
  addKeepOptions(command, options.keep);
  addLiveOptions(command, options.live);
  command.add_option("--stats", options.statistics, "JSON file to write the statistics to")
      ->type_name("FILE");
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void addRenderCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a scene");
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->output,
                   "Image to write: .exr (32-bit float), .hdr or .png; default: the scene's name "
                   "with .exr, in the current folder")
      ->type_name("FILE");
  command
      ->add_option("-i,--integrator", options->integrator,
                   "NAME[:option=value,...]; `h2mc list integrators` shows them. Default: what "
                   "the scene says, else h2mc")
      ->type_name("INTEGRATOR");

  addBudget(*command, options->budget, "One of them; default: the integrator's own");

  auto* width =
      command->add_option("--width", options->width, "Width in pixels instead of the scene's")
          ->check(positiveNumber());
  auto* height =
      command->add_option("--height", options->height, "Height in pixels instead of the scene's")
          ->check(positiveNumber());
  command->add_option("--scale", options->scale, "Factor on the scene's width and height")
      ->check(positiveNumber())
      ->excludes(width)
      ->excludes(height);
  command
      ->add_option_function<std::string>(
          "--crop", [options](const std::string& text) { options->crop = rectangleOf(text); },
          "X,Y,W,H: render only this window of the image, W x H pixels whose left upper one is "
          "(X, Y)")
      ->type_name("X,Y,W,H");
  command
      ->add_option("--aov", options->layers,
                   "Layers to write into the EXR beside the picture, with commas: albedo, normal, "
                   "depth, position, time, id, variance, mutations")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LAYERS");
  command
      ->add_option("--aov-samples", options->layerSamples,
                   "Camera rays a pixel for the layers of what is seen first")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostFeatureSamples));
  addSeed(*command, options->seed,
          "Same scene, options and seed: same image. Default: the scene's, or 0");
  addThreads(*command, options->threads);
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  addOutputOptions(*command, *options);
  command->footer(
      "Ctrl-C ends the render, writes the image of what was done so far and exits with code 130.\n"
      "--resume goes on from the checkpoint that is left then, or by a power cut.\n"
      "\n"
      "Examples:\n"
      "  h2mc render scene.xml -o scene.exr --png --time 60\n"
      "  h2mc render scene.xml -o scene.exr --time 600 --serve 8000 --display 127.0.0.1:14158\n"
      "  h2mc render scene.xml -i mmlt:maxDepth=8 --mutations-per-pixel 256 -D width=512");
  command->callback([options, &run] { run = [options] { return runRender(*options); }; });
}

}  // namespace h2mc
