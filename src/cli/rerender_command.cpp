// SPDX-License-Identifier: MIT
// h2mc rerender
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/image_header.h"
#include "cli/render_run.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct RerenderOptions {
  std::string image;
  RenderOptions render;  // what is given again
};

// Numbers and lists of a header's request. Throws InputError where they are of another kind.
class Request {
 public:
  explicit Request(const std::string& text) : json_(json::parse(text, nullptr, false)) {
    if (!json_.is_object()) fail();
  }
  // 0 where there is none.
  template <class T>
  T number(const char* name) const {
    const auto found = json_.find(name);
    return found == json_.end() ? T(0) : numberOf<T>(*found);
  }
  bool flag(const char* name) const {
    const auto found = json_.find(name);
    return found != json_.end() && *found == json(true);
  }
  std::optional<PixelRectangle> crop() const {
    const auto found = json_.find("crop");
    if (found == json_.end()) return std::nullopt;
    if (!found->is_array() || found->size() != 4) fail();
    return PixelRectangle{numberOf<int>((*found)[0]), numberOf<int>((*found)[1]),
                          numberOf<int>((*found)[2]), numberOf<int>((*found)[3])};
  }
  std::vector<std::string> layers() const {
    std::vector<std::string> names;
    const auto found = json_.find("aov");
    if (found == json_.end()) return names;
    if (!found->is_array()) fail();
    for (const json& name : *found) names.push_back(textOf(name));
    return names;
  }
  std::vector<std::string> defines() const {
    std::vector<std::string> all;
    const auto found = json_.find("defines");
    if (found == json_.end() || !found->is_object()) fail();
    for (const auto& [name, value] : found->items()) all.push_back(name + "=" + textOf(value));
    return all;
  }

 private:
  [[noreturn]] static void fail() {
    throw InputError("the renderRequest of its header is none of this version's");
  }
  template <class T>
  static T numberOf(const json& value) {
    const double number = value.is_number() ? value.get<double>() : -1;
    constexpr double kMostWhole = 9e15;  // up to which every whole number is a double
    const double most = std::is_floating_point_v<T>
                            ? std::numeric_limits<double>::max()
                            : std::min(kMostWhole, double(std::numeric_limits<T>::max()));
    if (!(number >= 0 && number <= most)) fail();
    return static_cast<T>(number);
  }
  static std::string textOf(const json& value) {
    if (!value.is_string()) fail();
    return value.get<std::string>();
  }

  json json_;
};

// From where the render is called, or beside the image.
std::string sceneOf(const ImageHeader& header, const std::string& image) {
  std::error_code error;
  if (fs::exists(header.scene, error)) return header.scene;
  std::string beside = (fs::path(image).parent_path() / header.scene).string();
  if (fs::exists(beside, error)) return beside;
  throw InputError(fmt::format(
      "its scene \"{}\" is neither here nor in the image's folder; --scene says where it is now",
      header.scene));
}

// The render by which the image was made, with what is given again.
RenderOptions optionsOf(const RerenderOptions& given) {
  const ExrHeader exr = readExrHeader(given.image);
  RenderOptions options = given.render;
  try {
    const ImageHeader header = imageHeader(exr.attributes);
    if (header.seeds.size() != 1)
      throw InputError("it is merged of several renders, each of which can be rendered again");
    if (header.request.empty()) throw InputError("its header has no renderRequest");
    const Request request(header.request);
    if (options.scene.empty()) options.scene = sceneOf(header, given.image);
    options.defines = request.defines();
    options.permissive = request.flag("permissive");
    options.integrator = header.integrator +
                         (header.integratorOptions.empty() ? "" : ":" + header.integratorOptions);
    options.width = request.number<int>("width");
    options.height = request.number<int>("height");
    options.scale = request.number<double>("scale");
    options.crop = request.crop();
    options.layers = request.layers();
    if (!options.layers.empty())
      options.layerSamples = std::max(1, request.number<int>("aovSamples"));
    RenderBudget& budget = options.budget;
    if (budget.seconds == 0 && budget.samplesPerPixel == 0 && budget.mutationsPerPixel == 0)
      budget = {request.number<double>("seconds"), request.number<long long>("samplesPerPixel"),
                request.number<long long>("mutationsPerPixel")};
    if (!options.seed) options.seed = *header.seeds.begin();
    options.again = {given.image, header.sceneDigest, header.programVersion};
  } catch (const InputError& e) {
    throw InputError(fmt::format(
        "cannot render \"{}\" again: {}; expected an EXR as this version's `h2mc render` writes it",
        given.image, e.what()));
  }
  if (options.output.empty()) options.output = fs::path(given.image).stem().string() + "-again.exr";
  return options;
}

}  // namespace

void addRerenderCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<RerenderOptions>();
  RenderOptions& render = options->render;
  CLI::App* command = app.add_subcommand("rerender", "Render again what an image shows");
  command->add_option("IMAGE", options->image, "Image of `h2mc render`, EXR")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", render.output,
                   "Image to write: .exr, .hdr or .png; default: the image's name with -again.exr, "
                   "in the current folder")
      ->type_name("FILE");
  command
      ->add_option("--scene", render.scene,
                   "Where the scene is now; default: where the image's header says, from here or "
                   "from the image's folder")
      ->type_name("FILE");
  addBudget(*command, render.budget, "One of them; default: the image's");
  addSeed(*command, render.seed, "Default: the image's");
  addThreads(*command, render.threads);
  addLimits(*command);
  addConfine(*command, render.confine);
  addOutputOptions(*command, render);
  command->footer(
      "Scene, definitions, size, window, integrator with its options, layers, budget and seed are "
      "those of the image's header. Where the scene or the version of the program is another, a "
      "warning says so. Where nothing is, and the budget is a number of samples or mutations, the "
      "new image has the same pixels, bit for bit.\n"
      "\n"
      "Example:\n"
      "  h2mc rerender ring.exr --seed 7 -o ring-7.exr");
  command->callback(
      [options, &run] { run = [options] { return runRender(optionsOf(*options)); }; });
}

}  // namespace h2mc
