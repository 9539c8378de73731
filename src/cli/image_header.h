// SPDX-License-Identifier: MIT
// What the header of a rendered EXR says of how the picture was made.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "render/image/image_io.h"

namespace h2mc {

struct ImageHeader {
  std::string scene;         // its file
  std::string sceneDefines;  // "name=value ..."
  std::string sceneDigest;   // of sceneDigest(): what the scene is, wherever its file
  std::string integrator, integratorOptions;  // options: optionText()
  // A render has one seed. Of merged images: those of all of them.
  std::set<std::uint64_t> seeds;
  int threads = 1;
  double wallSeconds = 0, cpuSeconds = 0;
  double samples = 0;                                // all of them, not a pixel
  std::string sampleUnit;                            // "samples" or "mutations"
  double meanLuminance = 0, meanLuminanceError = 0;  // of the image; its standard error
  bool interrupted = false;
  std::string programVersion;
  // What else is needed to render it again, as JSON: definitions, size, window, layers, budget. Empty where the image
  // is no render's.
  std::string request;
};

ImageAttributes attributesOf(const ImageHeader& header);

// The other way round. Throws InputError where something is missing or is no header of attributesOf's: what() says
// what, without the file's name.
ImageHeader imageHeader(const ImageAttributes& attributes);

}  // namespace h2mc
