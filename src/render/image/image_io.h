// SPDX-License-Identifier: MIT
// Image files.
#pragma once

#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "render/core/user_error.h"
#include "render/image/film_window.h"
#include "render/image/image.h"
#include "render/image/layer.h"

namespace h2mc {

// A file that cannot be read or written; what() is the whole message: which file, why.
class ImageError : public UserError {
 public:
  using UserError::UserError;
};

// Reads a picture (formats: kFormats in src/oiio/image_formats.cpp) as linear RGB: grey is spread over the channels,
// alpha is dropped. gamma: 0 = the file's own (sRGB for 8-bit formats, linear for float ones), -1 = sRGB, 1 = linear,
// else value^gamma. channel: one of the file's alone ("r", "g", "b", "a" or "y", or a name that the file gives), spread
// over all three; alpha is always linear. Throws ImageError.
Image readImage(const std::string& path, float gamma = 0, const std::string& channel = "");

// Text, numbers and whole numbers that go into an EXR's header.
using ImageAttributes = std::map<std::string, std::variant<std::string, double, int>>;
ImageAttributes readAttributes(const std::string& path);

// What an EXR says before its pixels. Throws ImageError.
struct ExrHeader {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  FilmWindow window;  // that its data window is, where that is not its display window
  ImageAttributes attributes;
};
ExrHeader readExrHeader(const std::string& path);

// The layers that a file's channels make, by the part of their names before the last dot; the picture's own, R, G and
// B, are none.
std::vector<std::string> layersOf(const ExrHeader& header);
// One of them, or all: those that the names say, in the file's order. Throws ImageError.
std::vector<Layer> readLayers(const std::string& path, const std::vector<std::string>& names);

// What goes into an EXR beside the picture, and is left out of other formats.
struct ExrExtras {
  ImageAttributes attributes;
  std::span<const Layer> layers;  // of the picture's size
  FilmWindow window;              // the data window, in a display window of the whole picture
};

// Writes by the path's ending: .exr (32-bit float, with the attributes), .hdr, .png (sRGB, 8 bit).
// Written to a temporary name beside it and renamed. Throws ImageError.
void writeLayeredImage(const std::string& path, const Image& image, const ExrExtras& extras);
void writeImage(const std::string& path, const Image& image,
                const ImageAttributes& attributes = {});
// Whether the path's ending is .exr, in either case.
bool isExr(const std::string& path);

// Finds out early what would make writeImage fail: an unknown ending, a folder that is not there or
// cannot be written to. Throws ImageError. Leaves nothing behind.
void checkWritable(const std::string& path);

}  // namespace h2mc
