// SPDX-License-Identifier: MIT
// What a comparison is made of: the plan, and what its runs leave behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/core/user_error.h"

namespace h2mc {

// The user's input is wrong; what() is the whole message.
class ComparisonError : public UserError {
 public:
  using UserError::UserError;
};

struct ComparedScene {
  std::string file;
  std::string name;  // the file's, made unique; a folder's name too
};

// Another renderer's images.
struct ExternalMethod {
  std::string name;
  std::filesystem::path folder;
};

struct ComparisonPlan {
  std::vector<ComparedScene> scenes;
  std::vector<std::string> methods;  // integrators with options, as --integrator has them
  std::vector<ExternalMethod> externals;
  bool timed = true;          // else by mutations
  std::vector<double> marks;  // ascending; seconds, or mutations (samples) a pixel
  int repeats = 3;
  std::uint64_t seed = 0;  // of the first repeat; the next ones follow
  int threads = 1;
  // For every scene.
  std::vector<std::string> defines;
  int width = 0, height = 0;
  double scale = 0;
  bool permissive = false;  // as ReadOptions::strictness
  std::string confine;      // as ReadOptions has it

  std::string reference;            // an image, with {scene} for the scene's name, or "auto"
  std::string referenceIntegrator;  // empty: what the scene's README says, else bdpt
  double referenceSeconds = 0;      // at most, for each scene; 0: forty times the last mark

  std::filesystem::path folder;
  std::string programVersion;
};

// One image of a run.
struct Point {
  double mark = 0;  // as asked for
  double seconds = 0, cpuSeconds = 0;
  double samples = 0;   // mutations or samples, all of them; 0: not known
  double perPixel = 0;  // the same for each pixel
  std::string sampleUnit;
  std::filesystem::path image;
  nlohmann::json statistics;
  std::map<std::string, double> errors;  // by metric
  double meanRatio = 0;                  // of the luminance, to the reference's

  // On the axis that the comparison is made along.
  double position(bool timed) const { return timed ? seconds : perPixel; }
};

// One run with its images at the marks.
struct Repeat {
  std::uint64_t seed = 0;
  std::vector<Point> points;
};

struct MethodRuns {
  std::string name;        // as given
  std::string integrator;  // empty for external ones
  std::map<std::string, std::string> options;
  bool external = false;
  std::vector<Repeat> repeats;
};

struct ReferenceFacts {
  std::string file;        // the image
  std::string origin;      // in words
  double error = 0;        // its own, relmse; 0: not known
  double brightness = 0;   // standard error of its mean luminance, relative; 0: not known
  double seconds = 0;      // rendered for; 0: given
  bool goodEnough = true;  // automatic ones: an order of magnitude below what is compared
};

struct SceneRuns {
  ComparedScene scene;
  int width = 0, height = 0;
  std::vector<MethodRuns> methods;
  ReferenceFacts reference;
};

// Letters, digits and a few signs: safe as a file's name everywhere.
std::string fileNameFor(const std::string& text);

// "path,h2mc:sigma=0.1,lensSigma=0.02,mmlt" -> path | h2mc:sigma=0.1,lensSigma=0.02 | mmlt.
// Throws ComparisonError for empty ones and duplicates.
std::vector<std::string> splitMethods(const std::string& text);

// "5,10,20": ascending, positive. Throws ComparisonError.
std::vector<double> parseMarks(const std::string& text);

// Names that differ from each other, from the files' names.
std::vector<ComparedScene> namedScenes(const std::vector<std::string>& files);

}  // namespace h2mc
