// SPDX-License-Identifier: MIT
// Image files.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "render/core/user_error.h"
#include "render/image/image.h"

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
  ImageAttributes attributes;
};
ExrHeader readExrHeader(const std::string& path);

// Writes by the path's ending: .exr (32-bit float, with the attributes), .hdr, .png (sRGB, 8 bit).
// Written to a temporary name beside it and renamed. Throws ImageError.
void writeImage(const std::string& path, const Image& image,
                const ImageAttributes& attributes = {});

// Finds out early what would make writeImage fail: an unknown ending, a folder that is not there or
// cannot be written to. Throws ImageError. Leaves nothing behind.
void checkWritable(const std::string& path);

}  // namespace h2mc
