// SPDX-License-Identifier: MIT
// Scene files written by the tests themselves.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "render/scene/scene_reader.h"

namespace h2mc::testing {

// Integrators for the reader to know, with options of every type.
inline std::span<const IntegratorPlugin> testIntegrators() {
  static constexpr Parameter kSampling[] = {
      {"maxDepth", ParameterType::kInteger, "-1", "longest path"},
      {"rrDepth", ParameterType::kInteger, "5", "roulette"},
      {"samplesPerPixel", ParameterType::kInteger, "64", "samples"}};
  static constexpr Parameter kMetropolis[] = {
      {"maxDepth", ParameterType::kInteger, "-1", "longest path"},
      {"sigma", ParameterType::kNumber, "0.01", "step size"},
      {"chains", ParameterType::kInteger, "128", "chains"},
      {"mutationsPerPixel", ParameterType::kInteger, "100", "mutations"},
      {"adapt", ParameterType::kBoolean, "true", "adaptive"},
      {"proposal", ParameterType::kString, "hessian", "kind", "hessian|isotropic"}};
  static const IntegratorPlugin kPlugins[] = {{"path", "", kSampling},
                                              {"bdpt", "", kSampling},
                                              {"mmlt", "", kMetropolis},
                                              {"h2mc", "", kMetropolis}};
  return kPlugins;
}

// A scene as a file of a version in which leftovers are errors.
inline std::string modern(std::string scene) {
  scene.replace(scene.find("0.6.0"), 5, "3.0.0");
  return scene;
}

inline ReadOptions strictness(Strictness how) {
  ReadOptions options;
  options.strictness = how;
  return options;
}

// A folder of its own, removed at the end.
class SceneFolder {
 public:
  SceneFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "h2mc-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern + "/";
  }
  ~SceneFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  // The path of the file that was written.
  std::string write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories(std::filesystem::path(path_ + name).parent_path());
    std::ofstream(path_ + name, std::ios::binary) << content;
    return path_ + name;
  }

  Scene read(const std::string& text, ReadOptions options = {}) const {
    options.integrators = testIntegrators();
    return readScene(write("scene.xml", text), options);
  }

  // The message of the SceneError that reading ends with, the folder's name left out; "" when there
  // is none.
  std::string error(const std::string& text, ReadOptions options = {}) const {
    try {
      read(text, std::move(options));
    } catch (const SceneError& e) {
      std::string message = e.what();
      for (std::size_t at; (at = message.find(path_)) != std::string::npos;)
        message.erase(at, path_.size());
      return message;
    }
    return "";
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline constexpr const char* kCamera = R"(<sensor type="perspective"><float name="fov" value="40"/>
  <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/></film></sensor>
)";
inline constexpr const char* kLight =
    R"(<emitter type="point"><rgb name="intensity" value="1, 2, 3"/></emitter>
)";
inline constexpr const char* kSphere = R"(<shape type="sphere"/>
)";

// A scene of its own camera, light and sphere around what is to be tested, which starts at line 2.
inline std::string sceneWith(const std::string& body) {
  return "<scene version=\"0.6.0\">\n" + body + "\n" + kCamera + kLight + kSphere + "</scene>\n";
}

}  // namespace h2mc::testing
