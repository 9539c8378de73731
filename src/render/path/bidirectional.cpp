// SPDX-License-Identifier: MIT
#include "render/path/bidirectional.h"

#include <algorithm>

#include "render/core/index.h"
#include "render/path/path_steps.h"

namespace h2mc {

BidirectionalSampler::BidirectionalSampler(int maxLength)
    : maxLength_(maxLength),
      cameraPath_(maxLength),
      lightPath_(maxLength),
      direct_(at(maxLength) + 1) {
  cameraPath_.technique = {0, maxLength + 1};
  lightPath_.technique = {maxLength, 1};
}

Step BidirectionalSampler::keepCamera(const Path& given, int i) {
  if (given.escaped && i == given.technique.t - 1) {
    cameraPath_.lastRay = given.lastRay;
    return Step::kEscaped;
  }
  cameraPath_.camera[at(i)] = given.camera[at(i)];
  return Step::kArrived;
}

template <class Coordinates>
void BidirectionalSampler::drawFrom(const Scene& scene, Coordinates& coordinates, float filmX,
                                    float filmY, const Path* given) {
  // Coordinates are asked for where they are first needed, in an order that they alone fix: shared
  // coordinates, camera subpath, light subpath, then a light for each camera vertex.
  const Technique own = given ? given->technique : Technique{0, 1};
  // `known`: null where it is not.
  const auto read = [&](int place, const float* known) {
    if (!known) return coordinates.read(place);
    coordinates.set(place, *known);
    return *known;
  };
  const auto scatter = [&](Path& path, int place, int coordinate, int choice, bool known,
                           int knownCoordinate, int knownChoice) {
    PrimarySample& sample = path.sample;
    const float* u = known ? &given->sample.u[at(knownCoordinate)] : nullptr;
    sample.u[at(coordinate)] = read(place, u);
    sample.u[at(coordinate) + 1] = read(place + 1, known ? u + 1 : nullptr);
    sample.choice[at(choice)] =
        read(place + 2, known ? &given->sample.choice[at(knownChoice)] : nullptr);
  };

  PrimarySample& sample = cameraPath_.sample;
  const SharedCoordinates shared = scene.shared();
  float x[kMostShared] = {};
  if (given) getShared(shared, given->sample, x);
  for (int i = 0; i < shared.count(); ++i) x[i] = read(i, given ? x + i : nullptr);
  sample.aperture = {0.5f, 0.5f};
  sample.time = 0;
  setShared(shared, x, sample);
  lightPath_.sample.time = sample.time;
  Path& camera = cameraPath_;
  camera.sample.u[0] = filmX_ = read(kFilmPlace, filmX < 0 ? nullptr : &filmX);
  camera.sample.u[1] = filmY_ = read(kFilmPlace + 1, filmY < 0 ? nullptr : &filmY);
  cameraVertices_ = 0;
  escaped_ = false;
  for (int i = 1; i <= maxLength_; ++i) {
    if (i > 1) {
      const Technique& technique = camera.technique;
      scatter(camera, cameraPlace(i - 1), technique.cameraCoordinate(i - 1),
              technique.cameraChoice(i - 1), i - 1 <= own.t - 2, own.cameraCoordinate(i - 1),
              own.cameraChoice(i - 1));
    }
    const Step step = i < own.t ? keepCamera(*given, i) : stepCamera(scene, camera, i);
    escaped_ = step == Step::kEscaped;
    if (step != Step::kArrived) break;
    cameraVertices_ = i;
  }

  Path& light = lightPath_;
  lightVertices_ = 0;
  const bool emitted = own.s >= 2;
  light.sample.choice[0] =
      read(emissionPlace(), emitted ? &given->sample.choice[at(own.lightPick())] : nullptr);
  for (int i = 0; i < 4; ++i)
    light.sample.u[at(i)] = read(emissionPlace() + 1 + i,
                                 emitted ? &given->sample.u[at(own.lightOffset() + i)] : nullptr);
  if (emitted) {
    light.lightIndex = given->lightIndex;
    light.lightPrimitive = given->lightPrimitive;
  } else if (!pickLight(scene, scene.emissionPicker, light.sample.choice[0], light.lightIndex,
                        light.lightPrimitive)) {
    return;
  }
  for (int i = 1; i < maxLength_; ++i) {
    if (i > 1) {
      const Technique& technique = light.technique;
      scatter(light, lightPlace(i - 1), technique.lightCoordinate(i - 1),
              technique.lightChoice(i - 1), i - 1 <= own.s - 2, own.lightCoordinate(i - 1),
              own.lightChoice(i - 1));
    }
    if (i < own.s)
      light.light[at(i)] = given->light[at(i)];
    else if (stepLight(scene, light, i) != Step::kArrived)
      break;
    lightVertices_ = i;
  }
  for (int i = 1; i <= cameraVertices_; ++i) {
    const int place = directPlace(i);
    Direct& direct = direct_[at(i)];
    direct = {coordinates.read(place), coordinates.read(place + 1), coordinates.read(place + 2)};
    if (own.s == 1 && i == own.t - 1) {
      const float* u = given->sample.u.data() + own.lightOffset();
      direct = {read(place, u), read(place + 1, u + 1),
                read(place + 2, &given->sample.choice[at(own.lightPick())])};
    }
  }
}

namespace {

struct RandomCoordinates {
  Random& random;
  float read(int) { return random.uniform(); }
  void set(int, float) {}
};

}  // namespace

void BidirectionalSampler::draw(const Scene& scene, Random& random, float filmX, float filmY,
                                const Path* given) {
  RandomCoordinates coordinates{random};
  drawFrom(scene, coordinates, filmX, filmY, given);
}

void BidirectionalSampler::draw(const Scene& scene, SampleCoordinates& coordinates, float filmX,
                                float filmY, const Path* given) {
  drawFrom(scene, coordinates, filmX, filmY, given);
}

bool BidirectionalSampler::reaches(const Technique& technique) const {
  const auto [s, t] = technique;
  if (s - 1 > lightVertices_) return false;
  if (s == 0 && escaped_ && t - 1 == cameraVertices_ + 1) return true;
  return t - 1 <= cameraVertices_;
}

bool BidirectionalSampler::join(const Scene& scene, Connection& connection, int& notFinite) {
  const auto [s, t] = connection.technique;
  const bool escaped = t - 1 > cameraVertices_;
  if (escaped && !scene.hasEnvironment()) return false;
  Ends ends{connection.technique,
            escaped ? nullptr : &cameraPath_.camera[at(t) - 1],
            s >= 2 ? &lightPath_.light[at(s) - 1] : nullptr,
            &cameraPath_.lastRay,
            lightPath_.lightIndex,
            lightPath_.lightPrimitive,
            0,
            0,
            &cameraPath_.sample};
  if (s == 1) {
    const Direct& direct = direct_[at(t) - 1];
    if (!pickLight(scene, scene.directPicker, direct.choice, ends.lightIndex, ends.lightPrimitive))
      return false;
    ends.u0 = direct.u0;
    ends.u1 = direct.u1;
  }
  const Joined joined = h2mc::join(scene, ends);
  if (!joined.finite) {
    ++notFinite;
    notFinite_ = connection.technique;
  }
  connection.contribution = joined.contribution;
  if (t == 1) {
    connection.filmX = joined.filmX;
    connection.filmY = joined.filmY;
  }
  return luminance(joined.contribution) > 0;
}

PrimarySample BidirectionalSampler::primarySample(const Technique& technique) const {
  const auto [s, t] = technique;
  PrimarySample sample;
  sample.time = cameraPath_.sample.time;
  sample.aperture = cameraPath_.sample.aperture;
  const auto copy = [](auto& to, int toIndex, const auto& from, int fromIndex, int count) {
    std::copy_n(from.begin() + fromIndex, count, to.begin() + toIndex);
  };
  copy(sample.u, 0, cameraPath_.sample.u, 0, technique.lightOffset());
  copy(sample.choice, 0, cameraPath_.sample.choice, 0, technique.cameraScatterings());
  if (s == 1) {
    const Direct& direct = direct_[at(t) - 1];
    sample.u[at(technique.lightOffset())] = direct.u0;
    sample.u[at(technique.lightOffset()) + 1] = direct.u1;
    sample.choice[at(technique.lightPick())] = direct.choice;
  } else if (s >= 2) {
    copy(sample.u, technique.lightOffset(), lightPath_.sample.u, 0, 2 * s);
    copy(sample.choice, technique.lightPick(), lightPath_.sample.choice, 0,
         1 + technique.lightScatterings());
  }
  return sample;
}

bool BidirectionalSampler::path(const Scene& scene, const Technique& technique, Path& path) const {
  const auto [s, t] = technique;
  path.technique = technique;
  path.sample = primarySample(technique);
  path.wraps = 0;
  path.filmX = filmX_;
  path.filmY = filmY_;
  path.escaped = t - 1 > cameraVertices_;
  path.lastRay = cameraPath_.lastRay;
  path.lightIndex = lightPath_.lightIndex;
  path.lightPrimitive = lightPath_.lightPrimitive;
  std::copy_n(cameraPath_.camera.begin() + 1, std::min(t - 1, cameraVertices_),
              path.camera.begin() + 1);
  if (s >= 2) std::copy_n(lightPath_.light.begin() + 1, s - 1, path.light.begin() + 1);
  for (int i = 1; i < t - 1; ++i)
    markScatterWraps(scene, path, path.camera[at(i)], technique.cameraCoordinate(i));
  for (int i = 1; i < s - 1; ++i)
    markScatterWraps(scene, path, path.light[at(i)], technique.lightCoordinate(i));
  if (s == 1)
    pickLight(scene, scene.directPicker, direct_[at(t) - 1].choice, path.lightIndex,
              path.lightPrimitive);
  if (s >= 1) markLightWraps(scene, path);
  return joinVisible(scene, path);
}

}  // namespace h2mc
