// SPDX-License-Identifier: MIT
// h2mc convert
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/look_options.h"
#include "render/image/image_io.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

struct ConvertOptions {
  std::string input, output, layer;
  LookOptions look;
};

// What is read, and where in a larger picture it lies.
struct Picture {
  Image image;
  FilmWindow window;
};

Picture readPicture(const ConvertOptions& options) {
  Picture picture;
  ExrHeader header;
  const bool exr = isExr(options.input);
  if (exr) {
    header = readExrHeader(options.input);
    picture.window = header.window;
  }
  if (options.layer.empty()) {
    picture.image = readImage(options.input);
    return picture;
  }
  const std::vector<std::string> names = layersOf(header);
  if (!exr || std::find(names.begin(), names.end(), options.layer) == names.end())
    throw InputError(fmt::format("\"{}\" has no layer \"{}\"; {}", options.input, options.layer,
                                 suggestion(options.layer, names)));
  const Layer layer = std::move(readLayers(options.input, {options.layer}).front());
  picture.image = pictureOf(layer, header.width, header.height);
  return picture;
}

int convert(const ConvertOptions& options) {
  const ToneMapping mapping = toneMapping(options.look);
  checkDistinct(
      {{"the image that is read", options.input}, {"the one that is written", options.output}});
  checkWritable(options.output);
  const bool png = lowerCase(std::filesystem::path(options.output).extension().string()) == ".png";
  if (!png && mapping.curve != ToneCurve::kSrgb)
    throw InputError("--tonemap " + options.look.curve + " is for a .png: \"" + options.output +
                     "\" holds linear values");
  const Picture picture = readPicture(options);
  const Image image = options.look.given() ? toneMapped(picture.image, mapping) : picture.image;
  try {
    writeLayeredImage(options.output, image, {{}, {}, picture.window});
  } catch (const ImageError& e) {  // the path was right before
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  return kSuccess;
}

}  // namespace

void addConvertCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "An image in another format, exposed for looking at");
  command->add_option("IN", options->input, "Image of any format that OpenImageIO reads")
      ->required()
      ->type_name("FILE");
  command->add_option("OUT", options->output, "Image to write: .exr, .hdr or .png")
      ->required()
      ->type_name("FILE");
  command->add_option("--layer", options->layer,
                      "Layer of an EXR instead of its picture: \"albedo\" for its channels "
                      "albedo.R, albedo.G and albedo.B");
  addLookOptions(*command, options->look);
  addLimits(*command);
  command->footer(
      "--exposure holds for every format, --tonemap for .png. A layer of one value becomes grey.\n"
      "\n"
      "Example:\n"
      "  h2mc convert ring.exr ring.png --exposure auto --tonemap filmic\n"
      "  h2mc convert ring.exr albedo.png --layer albedo");
  command->callback([options, &run] { run = [options] { return convert(*options); }; });
}

}  // namespace h2mc
