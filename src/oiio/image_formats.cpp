// SPDX-License-Identifier: MIT
// The module that imageFormats() loads.
#include "render/image/image_formats.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace h2mc {
namespace {

// The exponent that linearises the file's values: 1 = linear already, -1 = sRGB.
float gammaOf(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space.rfind("Gamma", 0) == 0) {
    const float gamma = spec.get_float_attribute("oiio:Gamma", 0);
    if (gamma > 0) return gamma;
  }
  if (space == "Linear" || spec.format.is_floating_point()) return 1;
  return -1;
}

// Formats of pictures that are whole in one file. OpenImageIO has more, among them FFmpeg's: what it takes for a movie
// may be a list of other files, or of addresses, that it opens.
constexpr const char* kFormats[] = {
    "openexr",  "hdr", "png", "jpeg", "tiff", "bmp", "targa",     "pnm",    "webp", "dds", "gif",
    "jpeg2000", "psd", "sgi", "iff",  "dpx",  "rla", "softimage", "cineon", "ico",  "fits"};

// Opens it by the reader that its ending asks for, else by the first that knows its content.
std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path,
                                              const OIIO::ImageSpec& wishes) {
  std::string error;
  const auto opened = [&](const std::string& format) {
    auto input = OIIO::ImageInput::create(format);
    OIIO::geterror();  // an ending that it does not know
    const bool known =
        input && std::any_of(std::begin(kFormats), std::end(kFormats), [&](auto name) {
          return std::string_view(input->format_name()) == name;
        });
    OIIO::ImageSpec spec;
    if (known && input->open(path, spec, wishes)) return input;
    if (known && error.empty()) error = input->geterror();
    return std::unique_ptr<OIIO::ImageInput>();
  };
  const std::string ending = OIIO::Filesystem::extension(path, false);
  if (!ending.empty())
    if (auto input = opened(ending)) return input;
  for (const char* format : kFormats) {
    const auto reader = OIIO::ImageInput::create(format);
    if (!reader || !reader->valid_file(path)) continue;
    if (auto input = opened(format)) return input;
  }
  throw std::runtime_error(error.empty() ? "it is in none of the formats of pictures that are read"
                                         : error);
}

// ending: with its dot, which says the format.
std::vector<unsigned char> file(const char* ending, int width, int height, OIIO::TypeDesc type,
                                const void* data, const char* colorSpace) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::string name = std::string("memory") + ending;
  const auto output = OIIO::ImageOutput::create(name, &memory);
  if (!output) throw std::runtime_error(OIIO::geterror());
  OIIO::ImageSpec spec(width, height, 3, type);
  spec.attribute("oiio:ColorSpace", colorSpace);
  if (!output->open(name, spec) || !output->write_image(type, data) || !output->close())
    throw std::runtime_error(output->geterror());
  return bytes;
}

class OiioFormats final : public ImageFormats {
 public:
  FilePicture read(const std::string& path, const HeaderCheck& check) const override {
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
    const auto input = openPicture(path, wishes);
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
      throw std::runtime_error("it holds no flat picture");
    FilePicture picture;
    picture.width = spec.width;
    picture.height = spec.height;
    picture.channels = spec.channelnames;
    picture.channels.resize(static_cast<std::size_t>(spec.nchannels));
    picture.alpha = spec.alpha_channel;
    picture.gamma = gammaOf(spec);
    picture.rawBytes = static_cast<double>(spec.image_bytes(true));
    const ChannelRange range = check(picture);
    picture.values.resize(static_cast<std::size_t>(spec.width) *
                          static_cast<std::size_t>(spec.height) *
                          static_cast<std::size_t>(range.end - range.begin));
    if (!input->read_image(0, 0, range.begin, range.end, OIIO::TypeDesc::FLOAT,
                           picture.values.data()))
      throw std::runtime_error(input->geterror());
    return picture;
  }

  std::vector<unsigned char> hdrFile(int width, int height,
                                     const std::vector<float>& linear) const override {
    return file(".hdr", width, height, OIIO::TypeDesc::FLOAT, linear.data(), "Linear");
  }

  std::vector<unsigned char> pngFile(int width, int height,
                                     const std::vector<std::uint8_t>& srgb) const override {
    return file(".png", width, height, OIIO::TypeDesc::UINT8, srgb.data(), "sRGB");
  }
};

}  // namespace

extern "C" const ImageFormats* h2mcImageFormats() {
  static const OiioFormats formats;
  return &formats;
}

}  // namespace h2mc
