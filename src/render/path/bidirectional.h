// SPDX-License-Identifier: MIT
// One bidirectional sample: a camera and a light subpath, joined in every way [Veach 1997, ch. 10].
#pragma once

#include <vector>

#include "render/core/random.h"
#include "render/path/path.h"

namespace h2mc {

// Where a bidirectional sample has its coordinates from: numbers in [0, 1), each of which has a place.
class SampleCoordinates {
 public:
  virtual ~SampleCoordinates() = default;
  // The one at `place`, 0 <= place < BidirectionalSampler::places(). A sample asks for what it needs and for no more.
  virtual float read(int place) = 0;
  // The one at `place` is this: that of a path which is given.
  virtual void set(int place, float value) = 0;
};

// Traces pairs of subpaths and evaluates all techniques up to a length. Keeps the coordinates it
// draws, so that any technique's path can be traced again by itself. Allocates once.
class BidirectionalSampler {
 public:
  explicit BidirectionalSampler(int maxLength);

  struct Connection {
    Technique technique;
    float filmX, filmY;
    Rgbf contribution;  // MIS weighted; summed over the techniques it estimates the image
  };

  // Draws a sample with its camera ray through (filmX, filmY) in [0,1)^2, or anywhere if negative,
  // and calls `visit(const Connection&)` for every technique of length minLength .. maxLength that
  // contributes. Returns the number of contributions that were not finite: those are left out.
  template <class Visit>
  int sample(const Scene& scene, Random& random, float filmX, float filmY, int minLength,
             Visit&& visit) {
    draw(scene, random, filmX, filmY, nullptr);
    return joinAll(scene, minLength, nullptr, visit);
  }

  // A bidirectional sample of which the given path is one connection: its vertices and its own
  // contribution are taken as they are, and only what lies beyond is drawn and traced. (Traced anew from its
  // primary sample, a path whose vertices came first may be another one by rounding.)
  // Precondition: given.target > 0.
  template <class Visit>
  int complete(const Scene& scene, Random& random, const Path& given, int minLength,
               Visit&& visit) {
    draw(scene, random, given);
    return joinAll(scene, minLength, &given, visit);
  }

  // The same with coordinates of the caller's. The film position is among them.
  template <class Visit>
  int sample(const Scene& scene, SampleCoordinates& coordinates, int minLength, Visit&& visit) {
    draw(scene, coordinates, -1, -1, nullptr);
    return joinAll(scene, minLength, nullptr, visit);
  }
  template <class Visit>
  int complete(const Scene& scene, SampleCoordinates& coordinates, const Path& given, int minLength,
               Visit&& visit) {
    draw(scene, coordinates, given);
    return joinAll(scene, minLength, &given, visit);
  }
  // How many coordinates a sample may have. The first kMostShared are those that belong to no technique.
  int places() const { return directPlace(maxLength_ + 1); }

  // Makes `path` what tracePath makes of the last sample's connection of this technique: without a ray. Returns whether
  // its target is positive. Precondition: it was among those visited.
  bool path(const Scene& scene, const Technique& technique, Path& path) const;

  // The technique of the last contribution that was not finite.
  const Technique& lastNotFinite() const { return notFinite_; }

  // The primary sample with which tracePath gives the last sample's connection of this technique.
  PrimarySample primarySample(const Technique& technique) const;

 private:
  template <class Visit>
  int joinAll(const Scene& scene, int minLength, const Path* given, Visit&& visit) {
    int notFinite = 0;
    for (int length = minLength; length <= maxLength_; ++length) {
      for (int s = 0; s <= length; ++s) {
        const Technique technique{s, length + 1 - s};
        if (technique == Technique{1, 1} || !reaches(technique)) continue;
        if (given && technique == given->technique) {
          visit(Connection{technique, given->filmX, given->filmY, given->contribution});
          continue;
        }
        Connection c{technique, filmX_, filmY_, Rgbf(0)};
        if (!join(scene, c, notFinite)) continue;
        visit(c);
      }
    }
    return notFinite;
  }

  // `from`: a Random or SampleCoordinates.
  template <class From>
  void draw(const Scene& scene, From& from, const Path& given) {
    const bool camera = given.technique.t >= 2;
    draw(scene, from, camera ? given.sample.u[0] : -1, camera ? given.sample.u[1] : -1, &given);
  }
  void draw(const Scene& scene, Random& random, float filmX, float filmY, const Path* given);
  void draw(const Scene& scene, SampleCoordinates& coordinates, float filmX, float filmY,
            const Path* given);
  template <class Coordinates>
  void drawFrom(const Scene& scene, Coordinates& coordinates, float filmX, float filmY,
                const Path* given);
  // Places of coordinates: of the film; of the scattering at the i-th vertex after the eye or the light, i >= 1, with
  // its choice; of the light's pick and the ray that it emits; of the light that the i-th camera vertex samples.
  static constexpr int kFilmPlace = kMostShared;
  static int cameraPlace(int i) { return kFilmPlace + 2 + 3 * (i - 1); }
  int emissionPlace() const { return cameraPlace(maxLength_); }
  int lightPlace(int i) const { return emissionPlace() + 5 + 3 * (i - 1); }
  int directPlace(int i) const { return lightPlace(maxLength_) + 3 * (i - 1); }
  // The given path's camera vertex i, or its escape, as stepCamera leaves it.
  Step keepCamera(const Path& given, int i);
  bool reaches(const Technique& technique) const;
  bool join(const Scene& scene, Connection& connection, int& notFinite);

  int maxLength_;
  float filmX_ = 0, filmY_ = 0;
  // Both subpaths at full length; their coordinates in the layout of PrimarySample for (0, t) and
  // (s, 1). lightPath_.sample.choice[0] picks the light.
  Path cameraPath_, lightPath_;
  int cameraVertices_ = 0;  // traced, after the eye
  int lightVertices_ = 0;   // traced, after the one on the light
  Technique notFinite_;
  bool escaped_ = false;  // the edge after the last camera vertex leaves the scene
  // Each camera vertex samples a light of its own.
  struct Direct {
    float u0, u1, choice;
  };
  std::vector<Direct> direct_;
};

}  // namespace h2mc
