#include "render/image/image_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include "render/image/atomic_file.h"
#include "render/image/color_encoding.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

static_assert(sizeof(Rgbf) == 3 * sizeof(float), "pixels are handed to the libraries as floats");

enum class Format { kExr, kHdr, kPng };

Format formatOf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".exr") return Format::kExr;
  if (ending == ".hdr") return Format::kHdr;
  if (ending == ".png") return Format::kPng;
  throw ImageError("cannot write \"" + path + "\": " +
                   (ending.empty() ? "the file name has no ending" : "unknown ending " + ending) +
                   "; there are .exr, .hdr and .png");
}

[[noreturn]] void failReading(const std::string& path, const std::string& why) {
  throw ImageError("cannot read the image \"" + path + "\": " + why);
}

void checkIsFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) failReading(path, "there is no such file");
  if (!fs::is_regular_file(status)) failReading(path, "it is not a file");
}

// Where red, green and blue are among the file's channels; alpha and further channels are not read.
std::array<int, 3> colorChannels(const OIIO::ImageSpec& spec) {
  const auto named = [&](const char* name) {
    const auto& names = spec.channelnames;
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? -1 : static_cast<int>(it - names.begin());
  };
  const std::array<int, 3> rgb{named("R"), named("G"), named("B")};
  if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
  if (spec.nchannels >= 3) return {0, 1, 2};
  return {0, 0, 0};
}

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

void linearise(Image& image, float gamma) {
  if (gamma == 1) return;
  const auto decode = [gamma](float v) {
    return gamma < 0 ? srgbToLinear(v) : std::pow(std::max(v, 0.f), gamma);
  };
  for (Rgbf& p : image.pixels) p = Rgbf(decode(p.x), decode(p.y), decode(p.z));
}

void writeExr(const AtomicFile& file, const Image& image, const ImageAttributes& attributes) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
  for (const auto& [name, value] : attributes) {
    if (const auto* text = std::get_if<std::string>(&value))
      header.insert(name, Imf::StringAttribute(*text));
    else if (const auto* number = std::get_if<double>(&value))
      header.insert(name, Imf::DoubleAttribute(*number));
    else
      header.insert(name, Imf::IntAttribute(std::get<int>(value)));
  }

  Imf::FrameBuffer frame;
  const char* channels[] = {"R", "G", "B"};
  // OpenEXR takes a pointer it could write through, and does not when it is given for output.
  char* base = reinterpret_cast<char*>(const_cast<Rgbf*>(image.pixels.data()));
  for (int c = 0; c < 3; ++c) {
    header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
    frame.insert(channels[c], Imf::Slice(Imf::FLOAT, base + c * sizeof(float), sizeof(Rgbf),
                                         sizeof(Rgbf) * image.width));
  }

  // Imf::OutputFile's destructor writes the table of lines and keeps quiet about failures: the
  // stream's state tells.
  std::ofstream stream(file.temporaryPath(), std::ios::binary);
  {
    Imf::StdOFStream exrStream(stream, file.temporaryPath().c_str());
    Imf::OutputFile exr(exrStream, header);
    exr.setFrameBuffer(frame);
    exr.writePixels(image.height);
  }
  stream.close();
  if (!stream) throw std::runtime_error("writing failed, is the disk full?");
}

template <class T>
void writeByOiio(const AtomicFile& file, const Image& image, const std::vector<T>& data,
                 OIIO::TypeDesc type, const char* colorSpace) {
  const auto output = OIIO::ImageOutput::create(file.temporaryPath());
  if (!output) throw std::runtime_error(OIIO::geterror());
  OIIO::ImageSpec spec(image.width, image.height, 3, type);
  spec.attribute("oiio:ColorSpace", colorSpace);
  if (!output->open(file.temporaryPath(), spec) || !output->write_image(type, data.data()) ||
      !output->close())
    throw std::runtime_error(output->geterror());
}

// Values outside [0, 1] are clipped; what is not a number becomes black.
std::vector<std::uint8_t> encodeSrgb(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  const auto encode = [](float v) {
    const float clipped = v > 0 ? std::min(v, 1.f) : 0.f;
    return static_cast<std::uint8_t>(linearToSrgb(clipped) * 255 + 0.5f);
  };
  for (const Rgbf& p : image.pixels)
    for (const float v : {p.x, p.y, p.z}) bytes.push_back(encode(v));
  return bytes;
}

// Radiance's format has no negative numbers.
std::vector<float> notNegative(const Image& image) {
  std::vector<float> values;
  values.reserve(image.pixels.size() * 3);
  for (const Rgbf& p : image.pixels)
    for (const float v : {p.x, p.y, p.z}) values.push_back(v > 0 ? v : 0.f);
  return values;
}

}  // namespace

Image readImage(const std::string& path, float gamma) {
  checkIsFile(path);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  const auto input = OIIO::ImageInput::open(path, &wishes);
  if (!input) failReading(path, OIIO::geterror());

  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
    failReading(path, "it holds no flat picture");
  const std::size_t channels = spec.nchannels;
  std::vector<float> data(static_cast<std::size_t>(spec.width) * spec.height * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, data.data()))
    failReading(path, input->geterror());

  Image image(spec.width, spec.height);
  const std::array<int, 3> rgb = colorChannels(spec);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* p = data.data() + i * channels;
    image.pixels[i] = Rgbf(p[rgb[0]], p[rgb[1]], p[rgb[2]]);
  }
  linearise(image, gamma == 0 ? gammaOf(spec) : gamma);
  return image;
}

ImageAttributes readAttributes(const std::string& path) {
  checkIsFile(path);
  try {
    const Imf::InputFile file(path.c_str());
    ImageAttributes attributes;
    for (auto it = file.header().begin(); it != file.header().end(); ++it) {
      const std::string name = it.name();
      if (name == "pixelAspectRatio" || name == "screenWindowWidth") continue;  // every file's
      const Imf::Attribute& attribute = it.attribute();
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
        attributes[name] = text->value();
      else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
        attributes[name] = number->value();
      else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
        attributes[name] = static_cast<double>(single->value());
      else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        attributes[name] = whole->value();
    }
    return attributes;
  } catch (const std::exception& e) {
    failReading(path, e.what());
  }
}

void writeImage(const std::string& path, const Image& image, const ImageAttributes& attributes) {
  const Format format = formatOf(path);
  if (image.width <= 0 || image.height <= 0)
    throw ImageError("cannot write \"" + path + "\": the image is empty");
  std::unique_ptr<AtomicFile> file;
  try {
    file = std::make_unique<AtomicFile>(path);
  } catch (const std::exception& e) {
    throw ImageError(e.what());
  }
  try {
    switch (format) {
      case Format::kExr:
        writeExr(*file, image, attributes);
        break;
      case Format::kHdr:
        writeByOiio(*file, image, notNegative(image), OIIO::TypeDesc::FLOAT, "Linear");
        break;
      case Format::kPng:
        writeByOiio(*file, image, encodeSrgb(image), OIIO::TypeDesc::UINT8, "sRGB");
        break;
    }
    file->commit();
  } catch (const std::exception& e) {
    throw ImageError("cannot write \"" + path + "\": " + e.what());
  }
}

void checkWritable(const std::string& path) {
  formatOf(path);
  try {
    AtomicFile probe(path);
  } catch (const std::exception& e) {
    throw ImageError(e.what());
  }
}

}  // namespace h2mc
