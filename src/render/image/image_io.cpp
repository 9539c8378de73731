// SPDX-License-Identifier: MIT
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
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "render/core/index.h"
#include "render/core/input_file.h"
#include "render/core/memory.h"
#include "render/image/atomic_file.h"
#include "render/image/color_encoding.h"
#include "render/image/header_size.h"
#include "render/image/image_formats.h"
#include "render/image/image_limits.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

static_assert(sizeof(Rgbf) == 3 * sizeof(float), "pixels are handed to the libraries as floats");

std::uint64_t mostPixels = kMostPixels;

enum class Format { kExr, kHdr, kPng };

// With its dot, in small letters.
std::string endingOf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

Format formatOf(const std::string& path) {
  const std::string ending = endingOf(path);
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

// Of an image that is read.
InputFile opened(const std::string& path) {
  try {
    return InputFile(path, kLargestData);
  } catch (const InputFileError& e) {
    failReading(path, e.why());
  }
}

// What keeps a header from making the program ask for more memory than the file can be worth. rawBytes: of the values
// before they were compressed; 0 where it is not known yet.
void checkHeader(const InputFile& file, double width, double height, int channels,
                 double rawBytes) {
  // Twice what a picture of one colour becomes in the format that makes least of it (EXR with DWA: one value for 64,
  // times deflate's 1032), and what any picture may have.
  constexpr double kMostCompression = 131072, kAlways = 64e6;
  const double pixels = width * height;
  const std::string size = fmt::format("its header says {:.0f} x {:.0f} pixels", width, height);
  if (pixels > static_cast<double>(mostPixels))
    throw std::runtime_error(fmt::format(
        "{}, expected at most {} in all; --max-texture-pixels sets the limit", size, mostPixels));
  const double raw = std::max(rawBytes, pixels);
  if (raw > kAlways + kMostCompression * static_cast<double>(file.size()))
    throw std::runtime_error(fmt::format("{}, {} of values, which a file of {} can't hold", size,
                                         sizeText(raw),
                                         sizeText(static_cast<double>(file.size()))));
  const double bytes = pixels * (channels * sizeof(float) + sizeof(Rgbf));
  if (bytes > kAlways) requireMemory(bytes, size + ", which", "expected a smaller image");
}

// The same before any library opens the file.
void checkHeaderSize(const InputFile& file) {
  if (const auto size = headerSize(file)) checkHeader(file, size->width, size->height, 3, 0);
}

// Where red, green and blue are among the file's channels; alpha and further channels are not read.
std::array<int, 3> colorChannels(const FilePicture& picture) {
  const auto& names = picture.channels;
  const auto named = [&](const char* name) {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? -1 : static_cast<int>(it - names.begin());
  };
  const std::array<int, 3> rgb{named("R"), named("G"), named("B")};
  if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
  if (names.size() >= 3) return {0, 1, 2};
  return {0, 0, 0};
}

// The place of one channel by its name, or its part after the last dot, in either case; "y" is that of
// grey too.
int channelNamed(const FilePicture& picture, const std::string& name) {
  const auto folded = [](const std::string& text) {
    std::string result;
    for (const char c : text.substr(text.rfind('.') == std::string::npos ? 0 : text.rfind('.') + 1))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
  };
  const auto& names = picture.channels;
  for (std::size_t c = 0; c < names.size(); ++c)
    if (names[c] == name || folded(names[c]) == folded(name)) return static_cast<int>(c);
  if (folded(name) == "a" && picture.alpha >= 0) return picture.alpha;
  if (folded(name) == "y" && names.size() <= 2) return 0;
  std::string all;
  for (const std::string& n : names) all += (all.empty() ? "" : ", ") + n;
  throw std::runtime_error("it has no channel \"" + name + "\"; there are " + all);
}

// What a PNG's gAMA chunk says, as FilePicture::gamma; 0 where there is none, or an sRGB chunk that goes before
// it. (OpenImageIO takes most values for sRGB.)
float gammaOfPng(const InputFile& file) {
  constexpr double kSrgb = 0.45455, kTolerance = 0.005;  // how the sRGB curve is written as a power
  const auto number = [](const std::string& bytes) {     // of the first four, the largest first
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at(i)]);
    return value;
  };
  if (file.bytes(1, 3) != "PNG") return 0;
  float gamma = 0;
  for (std::uint64_t offset = 8;;) {
    const std::string head = file.bytes(offset, 12);  // length and name of a chunk, its first bytes
    if (head.size() < 12) break;
    const std::uint32_t length = number(head);
    const std::string name = head.substr(4, 4);
    if (name == "IDAT" || name == "IEND") break;
    if (name == "sRGB") return 0;
    if (name == "gAMA" && length == 4) {
      const double encoded =
          number(head.substr(8)) / 1e5;  // the exponent that has made the file's values
      if (encoded > 0)
        gamma = std::abs(encoded - kSrgb) < kTolerance ? -1 : static_cast<float>(1 / encoded);
    }
    offset += std::uint64_t{12} + length;
  }
  return gamma;
}

void linearise(Image& image, float gamma) {
  if (gamma == 1) return;
  const auto decode = [gamma](float v) {
    return gamma < 0 ? srgbToLinear(v) : std::pow(std::max(v, 0.f), gamma);
  };
  for (Rgbf& p : image.pixels) p = Rgbf(decode(p.x), decode(p.y), decode(p.z));
}

void close(std::ofstream& stream) {
  stream.close();
  if (!stream) throw std::runtime_error("writing failed, is the disk full?");
}

// In OpenEXR's coordinates of the whole picture.
Imath::Box2i dataWindow(const Image& image, const FilmWindow& window) {
  const Imath::V2i corner(window.x, window.y);
  return {corner, corner + Imath::V2i(image.width - 1, image.height - 1)};
}

// A channel of floats that lie `stride` floats apart, the first pixel's at `first`. OpenEXR takes a pointer it could
// write through, and does not when it is given for output.
Imf::Slice sliceOf(const float* first, std::size_t stride, const Imath::Box2i& window) {
  const std::size_t step = stride * sizeof(float);
  return Imf::Slice::Make(Imf::FLOAT, first, window, step,
                          step * at(window.max.x - window.min.x + 1));
}

void writeExr(const AtomicFile& file, const Image& image, const ExrExtras& extras) {
  const Imath::Box2i window = dataWindow(image, extras.window);
  const bool part = extras.window.isPart();
  Imf::Header header(part ? extras.window.wholeWidth : image.width,
                     part ? extras.window.wholeHeight : image.height, window);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
  for (const auto& [name, value] : extras.attributes) {
    if (const auto* text = std::get_if<std::string>(&value))
      header.insert(name, Imf::StringAttribute(*text));
    else if (const auto* number = std::get_if<double>(&value))
      header.insert(name, Imf::DoubleAttribute(*number));
    else
      header.insert(name, Imf::IntAttribute(std::get<int>(value)));
  }

  Imf::FrameBuffer frame;
  const auto insert = [&](const std::string& name, const float* first, std::size_t stride) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, sliceOf(first, stride, window));
  };
  const float* const pixels = &image.pixels.data()->x;
  insert("R", pixels, 3);
  insert("G", pixels + 1, 3);
  insert("B", pixels + 2, 3);
  for (const Layer& layer : extras.layers)
    for (std::size_t c = 0; c < layer.channels.size(); ++c)
      insert(layer.name + "." + layer.channels[c], layer.values.data() + c, layer.channels.size());

  // Compressing a large picture takes seconds; starting threads is not worth it for a small one. zlib makes two percent
  // of a noisy picture's floats: in the largest ones, where whoever presses Ctrl-C waits, run lengths must do.
  constexpr std::size_t kLarge = 1 << 20, kLargest = 1 << 22;
  if (image.pixels.size() >= kLargest) header.compression() = Imf::RLE_COMPRESSION;
  const int threads = image.pixels.size() < kLarge
                          ? 0
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (threads > Imf::globalThreadCount()) Imf::setGlobalThreadCount(threads);

  // Imf::OutputFile's destructor writes the table of lines and keeps quiet about failures: the
  // stream's state tells.
  std::ofstream stream(file.temporaryPath(), std::ios::binary);
  {
    Imf::StdOFStream exrStream(stream, file.temporaryPath().c_str());
    Imf::OutputFile exr(exrStream, header, threads);
    exr.setFrameBuffer(frame);
    exr.writePixels(image.height);
  }
  close(stream);
}

void writeBytes(const AtomicFile& file, const std::vector<unsigned char>& bytes) {
  std::ofstream stream(file.temporaryPath(), std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  close(stream);
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

void setMostPixels(std::uint64_t count) { mostPixels = count; }

Image readImage(const std::string& path, float gamma, const std::string& channel) {
  const InputFile file = opened(path);
  FilePicture picture;
  std::array<int, 3> rgb{};
  ChannelRange range;
  try {
    checkHeaderSize(file);
    picture = imageFormats().read(path, [&](const FilePicture& header) {
      rgb = colorChannels(header);
      if (!channel.empty()) rgb.fill(channelNamed(header, channel));
      range = {*std::min_element(rgb.begin(), rgb.end()),
               *std::max_element(rgb.begin(), rgb.end()) + 1};
      checkHeader(file, header.width, header.height, range.end - range.begin, header.rawBytes);
      return range;
    });
  } catch (const std::exception& e) {
    failReading(path, e.what());
  }

  if (!channel.empty() && rgb[0] == picture.alpha) gamma = 1;
  Image image(picture.width, picture.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* p = picture.values.data() + i * at(range.end - range.begin);
    const auto of = [&](int c) { return p[rgb[at(c)] - range.begin]; };
    image.pixels[i] = Rgbf(of(0), of(1), of(2));
  }
  if (gamma == 0) gamma = gammaOfPng(file);
  linearise(image, gamma == 0 ? picture.gamma : gamma);
  return image;
}

ExrHeader readExrHeader(const std::string& path) {
  const InputFile bytes = opened(path);
  try {
    checkHeaderSize(bytes);
    const Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    ExrHeader result;
    const Imath::Box2i& window = header.dataWindow();
    result.width = window.max.x - window.min.x + 1;
    result.height = window.max.y - window.min.y + 1;
    const Imath::Box2i& whole = header.displayWindow();
    if (window != whole)
      result.window = {window.min.x - whole.min.x, window.min.y - whole.min.y,
                       whole.max.x - whole.min.x + 1, whole.max.y - whole.min.y + 1};
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
      result.channels.emplace_back(it.name());
    ImageAttributes& attributes = result.attributes;
    for (auto it = header.begin(); it != header.end(); ++it) {
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
    return result;
  } catch (const std::exception& e) {
    failReading(path, e.what());
  }
}

ImageAttributes readAttributes(const std::string& path) { return readExrHeader(path).attributes; }

namespace {

// "normal" of "normal.X", "" of "R".
std::string layerOf(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

// As pictures have them; the file has them by the alphabet.
void sortChannels(std::vector<std::string>& channels) {
  const auto rank = [](const std::string& name) {
    const std::size_t place = std::string_view("RrGgBbAa").find(name);
    return name.size() == 1 && place != std::string_view::npos ? place : 8;
  };
  std::stable_sort(channels.begin(), channels.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

}  // namespace

std::vector<std::string> layersOf(const ExrHeader& header) {
  std::vector<std::string> layers;
  for (const std::string& channel : header.channels) {
    const std::string layer = layerOf(channel);
    if (!layer.empty() && std::find(layers.begin(), layers.end(), layer) == layers.end())
      layers.push_back(layer);
  }
  return layers;
}

std::vector<Layer> readLayers(const std::string& path, const std::vector<std::string>& names) {
  const ExrHeader header = readExrHeader(path);
  std::vector<Layer> layers;
  for (const std::string& name : layersOf(header)) {
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    layers.push_back({name, {}, {}});
    for (const std::string& channel : header.channels)
      if (layerOf(channel) == name)
        layers.back().channels.push_back(channel.substr(name.size() + 1));
    sortChannels(layers.back().channels);
  }
  try {
    std::size_t channels = 0;
    for (const Layer& layer : layers) channels += layer.channels.size();
    checkHeader(
        opened(path), header.width, header.height, static_cast<int>(channels),
        double(header.width) * header.height * static_cast<double>(channels * sizeof(float)));
    Imf::InputFile file(path.c_str());
    const Imath::Box2i& window = file.header().dataWindow();
    Imf::FrameBuffer frame;
    for (Layer& layer : layers) {
      const std::size_t stride = layer.channels.size();
      layer.values.resize(at(header.width) * at(header.height) * stride);
      for (std::size_t c = 0; c < stride; ++c)
        frame.insert(layer.name + "." + layer.channels[c],
                     sliceOf(layer.values.data() + c, stride, window));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
  } catch (const std::exception& e) {
    failReading(path, e.what());
  }
  return layers;
}

void writeImage(const std::string& path, const Image& image, const ImageAttributes& attributes) {
  writeLayeredImage(path, image, {attributes, {}, {}});
}

bool isExr(const std::string& path) { return endingOf(path) == ".exr"; }

void writeLayeredImage(const std::string& path, const Image& image, const ExrExtras& extras) {
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
        writeExr(*file, image, extras);
        break;
      case Format::kHdr:
        writeBytes(*file, imageFormats().hdrFile(image.width, image.height, notNegative(image)));
        break;
      case Format::kPng:
        writeBytes(*file, imageFormats().pngFile(image.width, image.height, encodeSrgb(image)));
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
