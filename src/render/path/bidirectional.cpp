// SPDX-License-Identifier: MIT
#include "render/path/bidirectional.h"

#include <algorithm>

#include "render/core/index.h"

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

void BidirectionalSampler::draw(const Scene& scene, Random& random, float filmX, float filmY,
                                const Path* given) {
  // Coordinates are drawn where they are first needed, in an order that the random stream alone
  // fixes: shared coordinates, camera subpath, light subpath, then a light for each camera vertex.
  const Technique own = given ? given->technique : Technique{0, 1};
  const auto scatter = [&](Path& path, int coordinate, int choice, bool known, int knownCoordinate,
                           int knownChoice) {
    PrimarySample& sample = path.sample;
    sample.u[at(coordinate)] = known ? given->sample.u[at(knownCoordinate)] : random.uniform();
    sample.u[at(coordinate) + 1] =
        known ? given->sample.u[at(knownCoordinate) + 1] : random.uniform();
    sample.choice[at(choice)] = known ? given->sample.choice[at(knownChoice)] : random.uniform();
  };

  if (given) {
    cameraPath_.sample.time = given->sample.time;
    cameraPath_.sample.aperture = given->sample.aperture;
  } else {
    drawShared(scene.shared(), random, cameraPath_.sample);
  }
  lightPath_.sample.time = cameraPath_.sample.time;
  Path& camera = cameraPath_;
  camera.sample.u[0] = filmX_ = filmX < 0 ? random.uniform() : filmX;
  camera.sample.u[1] = filmY_ = filmY < 0 ? random.uniform() : filmY;
  cameraVertices_ = 0;
  escaped_ = false;
  for (int i = 1; i <= maxLength_; ++i) {
    if (i > 1) {
      const Technique& technique = camera.technique;
      scatter(camera, technique.cameraCoordinate(i - 1), technique.cameraChoice(i - 1),
              i - 1 <= own.t - 2, own.cameraCoordinate(i - 1), own.cameraChoice(i - 1));
    }
    const Step step = i < own.t ? keepCamera(*given, i) : stepCamera(scene, camera, i);
    escaped_ = step == Step::kEscaped;
    if (step != Step::kArrived) break;
    cameraVertices_ = i;
  }

  Path& light = lightPath_;
  lightVertices_ = 0;
  const bool emitted = own.s >= 2;
  light.sample.choice[0] = emitted ? given->sample.choice[at(own.lightPick())] : random.uniform();
  for (int i = 0; i < 4; ++i)
    light.sample.u[at(i)] = emitted ? given->sample.u[at(own.lightOffset() + i)] : random.uniform();
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
      scatter(light, technique.lightCoordinate(i - 1), technique.lightChoice(i - 1),
              i - 1 <= own.s - 2, own.lightCoordinate(i - 1), own.lightChoice(i - 1));
    }
    if (i < own.s)
      light.light[at(i)] = given->light[at(i)];
    else if (stepLight(scene, light, i) != Step::kArrived)
      break;
    lightVertices_ = i;
  }
  for (int i = 1; i <= cameraVertices_; ++i) {
    direct_[at(i)] = {random.uniform(), random.uniform(), random.uniform()};
    if (own.s == 1 && i == own.t - 1) {
      const float* u = given->sample.u.data() + own.lightOffset();
      direct_[at(i)] = {u[0], u[1], given->sample.choice[at(own.lightPick())]};
    }
  }
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

}  // namespace h2mc
