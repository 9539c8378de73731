// SPDX-License-Identifier: MIT
// What OpenImageIO does for the program, in a module that is loaded when it is first asked for: the library brings 250
// others with it, which take half a second of processor time before anything is done.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace h2mc {

// A picture as its file has it.
struct FilePicture {
  int width = 0, height = 0;
  std::vector<std::string> channels;  // their names
  int alpha = -1;                     // the place of alpha among them, -1: none
  float gamma = 1;                    // the exponent that linearises the values; -1: they are sRGB
  double rawBytes = 0;                // of all values before they were compressed
  // Row by row from the top, all channels of a pixel together that were asked for.
  std::vector<float> values;
};

struct ChannelRange {
  int begin = 0, end = 0;
};
// Looks at what the header says, before anything is allocated: which channels are to be read. May throw.
using HeaderCheck = std::function<ChannelRange(const FilePicture& header)>;

class ImageFormats {
 public:
  // Reads one of the formats of kFormats. Throws what `check` throws, or std::runtime_error: why not, without the
  // file's name.
  virtual FilePicture read(const std::string& path, const HeaderCheck& check) const = 0;
  // The bytes of a file with three channels: Radiance's HDR, PNG. In memory, since the library does not tell when a
  // disk is full. Throw std::runtime_error likewise.
  virtual std::vector<unsigned char> hdrFile(int width, int height,
                                             const std::vector<float>& linear) const = 0;
  virtual std::vector<unsigned char> pngFile(int width, int height,
                                             const std::vector<std::uint8_t>& srgb) const = 0;

 protected:
  ~ImageFormats() = default;
};

// The module's, which stays loaded. Throws std::runtime_error if it is not where the program was built or installed.
const ImageFormats& imageFormats();

// What the module defines under this name.
extern "C" const ImageFormats* h2mcImageFormats();

}  // namespace h2mc
