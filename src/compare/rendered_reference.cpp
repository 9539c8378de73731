// SPDX-License-Identifier: MIT
#include "compare/rendered_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "compare/record_file.h"
#include "render/core/input_file.h"
#include "render/core/random.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kMargin = 10;               // the reference's error is to be that much smaller
constexpr double kDefaultMarks = 40;         // time at most, in last marks
constexpr std::uint64_t kStream = 0x726566;  // seeds of their own

double relmse(const Image& image, const Image& reference) {
  return findMetric("relmse")->compute(image, reference);
}

Image mean(const Image& a, const Image& b) {
  Image result = a;
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
  return result;
}

// Two independent estimates that are refined in parts.
class Halves {
 public:
  Halves(fs::path folder, json key) : folder_(std::move(folder)), key_(std::move(key)) {}

  void load() {
    const json record = readRecordFile(folder_);
    if (!record.is_object() || record.value("key", json()) != key_) return;
    for (std::size_t h = 0; h < 2; ++h) images_[h] = readImage(fileOf(h, record["parts"]).string());
    parts_ = record["parts"];
    seconds_ = record["seconds"];
    samples_ = record["samples"];
  }

  // Both images are written before the record that names them.
  void save() const {
    for (std::size_t h = 0; h < 2; ++h) writeImage(fileOf(h, parts_).string(), images_[h]);
    writeTextAtomically(
        (folder_ / "record.json").string(),
        json{{"key", key_}, {"parts", parts_}, {"seconds", seconds_}, {"samples", samples_}}.dump(
            1) +
            "\n");
    std::error_code ignored;
    for (std::size_t h = 0; h < 2; ++h) fs::remove(fileOf(h, parts_ - 1), ignored);
  }

  void add(const std::array<RenderResult, 2>& part) {
    for (std::size_t h = 0; h < 2; ++h) {
      const double n = static_cast<double>(part[h].samples);
      const float share = static_cast<float>(n / (n + samples_[h]));
      if (images_[h].pixels.empty()) images_[h] = Image(part[h].image.width, part[h].image.height);
      for (std::size_t i = 0; i < images_[h].pixels.size(); ++i)
        images_[h].pixels[i] += share * (part[h].image.pixels[i] - images_[h].pixels[i]);
      samples_[h] += n;
      seconds_ += part[h].wallSeconds;
    }
    ++parts_;
  }

  int parts() const { return parts_; }
  double seconds() const { return seconds_; }
  Image image() const { return mean(images_[0], images_[1]); }
  // relMSE of image(): E |(A - B) / 2|^2 = E |(A + B) / 2 - truth|^2 for independent A and B of the same error.
  double ownError() const { return relmse(images_[0], image()); }
  // Relative standard error of image()'s mean luminance. From one difference, so a rough guess.
  double brightnessError() const {
    const double a = meanLuminance(images_[0]), b = meanLuminance(images_[1]);
    return a + b > 0 ? std::abs(a - b) / (a + b) : 0;
  }

 private:
  fs::path fileOf(std::size_t half, int part) const {
    return folder_ / fmt::format("half-{}-{}.exr", half + 1, part);
  }

  fs::path folder_;
  json key_;
  std::array<Image, 2> images_;
  std::array<double, 2> samples_{};
  int parts_ = 0;
  double seconds_ = 0;
};

// The smallest error of the methods' last images, averaged over the repeats.
double smallestError(const SceneRuns& runs, const Image& reference) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const MethodRuns& method : runs.methods) {
    double sum = 0;
    for (const Repeat& repeat : method.repeats)
      sum += relmse(readImage(repeat.points.back().image.string()), reference);
    smallest = std::min(smallest, sum / static_cast<double>(method.repeats.size()));
  }
  return smallest;
}

// The last images' time where the plan is in mutations.
double lastSeconds(const ComparisonPlan& plan, const SceneRuns& runs) {
  if (plan.timed) return plan.marks.back();
  double seconds = 0;
  for (const MethodRuns& method : runs.methods)
    for (const Repeat& repeat : method.repeats)
      seconds = std::max(seconds, repeat.points.back().seconds);
  return seconds;
}

}  // namespace

std::string referenceIntegrator(const ComparisonPlan& plan, const ComparedScene& scene) {
  if (!plan.referenceIntegrator.empty()) return plan.referenceIntegrator;
  const fs::path page = fs::path(scene.file).parent_path() / "README.md";
  if (!fs::exists(page)) return "bdpt";
  std::istringstream stream(InputFile(page.string(), kLargestText).whole());
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find("Reference integrator:");
    if (at == std::string::npos) continue;
    const std::size_t begin = line.find('`', at), end = line.find('`', begin + 1);
    if (begin != std::string::npos && end != std::string::npos)
      return line.substr(begin + 1, end - begin - 1);
  }
  return "bdpt";
}

bool renderReference(const ComparisonPlan& plan, const ComparisonSetup::OneScene& setup,
                     const SceneRuns& runs, const ComparisonObserver& observer,
                     Reference& reference) {
  const std::string wish = referenceIntegrator(plan, runs.scene);
  const IntegratorChoice choice = chooseIntegrator(wish, setup.scene);
  json key = runKey(plan, setup, choice.options);
  key.erase("threads");
  key["seed"] = plan.seed;
  const fs::path folder = runsFolder(plan, runs.scene) / "reference";
  fs::create_directories(folder);
  Halves halves(folder, key);
  halves.load();

  const double last = lastSeconds(plan, runs);
  const double limit = plan.referenceSeconds > 0 ? plan.referenceSeconds : kDefaultMarks * last;
  double own = 0, wanted = 0;
  double next = std::min(limit, 4 * last);
  for (;;) {
    if (halves.parts() > 0) {
      own = halves.ownError();
      wanted = smallestError(runs, halves.image()) / kMargin;
      if (own <= wanted || halves.seconds() > 0.98 * limit) break;
      // Variance falls with 1 / time; a little more, so as not to miss it narrowly.
      next = std::clamp(halves.seconds() * (1.1 * own / wanted - 1), 0.25 * halves.seconds(),
                        3 * halves.seconds());
      next = std::min(next, limit - halves.seconds());
    }
    std::array<RenderResult, 2> part;
    double before = 0;
    for (std::size_t h = 0; h < 2; ++h) {
      RenderRequest request;
      request.budget.seconds = next / 2;
      request.seed = mixBits(mixBits(plan.seed ^ kStream) +
                             2 * static_cast<std::uint64_t>(halves.parts()) + h);
      request.threads = plan.threads;
      request.stop = observer.stop;
      request.progress = [&](const RenderProgress& progress) {
        if (!observer.status) return;
        observer.status({fmt::format("reference of {} by {}, part {}, half {}", runs.scene.name,
                                     wish, halves.parts() + 1, h + 1),
                         before + std::min(progress.elapsedSeconds, next / 2), next});
      };
      part[h] = choice.integrator->render(setup.scene, request);
      if (part[h].interrupted) return false;
      before = next / 2;
    }
    halves.add(part);
    halves.save();
  }

  reference.image = halves.image();
  reference.facts.file = (folder / "reference.exr").string();
  reference.facts.origin = fmt::format("{}, {:.0f} s in two independent halves of {} parts", wish,
                                       halves.seconds(), halves.parts());
  reference.facts.error = own;
  reference.facts.brightness = halves.brightnessError();
  reference.facts.seconds = halves.seconds();
  reference.facts.goodEnough = own <= wanted;
  writeImage(reference.facts.file, reference.image,
             {{"integrator", choice.options.integrator()},
              {"integratorOptions", optionText(choice.options)},
              {"wallSeconds", halves.seconds()},
              {"ownRelmse", own},
              {"programVersion", plan.programVersion}});
  if (!reference.facts.goodEnough && observer.note)
    observer.note(
        fmt::format("the reference of {} has a relMSE of {:.2g} after {:.0f} s; {:.2g} was wanted, "
                    "a tenth of the "
                    "smallest error. More time for it: --reference-time",
                    runs.scene.name, own, halves.seconds(), wanted));
  return true;
}

}  // namespace h2mc
