// SPDX-License-Identifier: MIT
// The vertex-local derivative of the log target: each step of a path is differentiated with respect to
// the few numbers that it depends on, and ad::Composition puts the steps together. The cost of a vertex
// does not grow with the path.
//
// The state of a subpath at a vertex is four numbers: where on its surface the vertex lies and from
// which direction it is reached; a step has two primary coordinates more, and time where the path
// depends on it. Whatever else a subpath brings along (throughput, vcm, vc) only ever gets multiplied
// or added as a root of squares: its logarithms are sums of terms that each see one step, and
// log-sum-exp of those.
#pragma once

#include "ad/composition.h"
#include "render/core/direction_chart.h"
#include "render/core/index.h"
#include "render/path/connect.h"
#include "render/path/path.h"

namespace h2mc {

// S: float or double. kMoving: for paths that depend on time.
template <class S, bool kMoving>
class LocalForm {
 public:
  using Variable = int;
  static constexpr Variable kNone = ad::Composition<S>::none();

  LocalForm(const Scene& scene, const Path& path, ad::Composition<S>& composition)
      : scene_(scene), path_(path), composition_(composition) {}

  // The path's log target as a variable of the composition, which is begun anew with the path's
  // dimension() coordinates at `u`; kNone where nothing is there. Precondition: path.moving is kMoving.
  Variable logTarget(const S* u);

 private:
  static constexpr int kTime = kMoving ? 1 : 0;
  static constexpr Techniques kBoth = Techniques::kBidirectional;

  // Positions among a step's outputs, kNone for what is not there.
  struct Leaving {
    int at, direction,
        vcm = kNone;  // two outputs each of the first two, of `at` for each vertex met
  };
  struct Factors {
    int vcm = kNone, vc = kNone;
  };

  // A subpath that has arrived at a vertex.
  struct Subpath {
    // Two variables each. The coordinates of vertices that the ray meets only because it goes straight on through
    // this one follow `at`.
    Variable at, direction;
    DirectionChart<S> chart{Vec3<S>(0, 0, 1)};  // of `direction`
    // Logarithms, kNone where they are zero: of the ray, vcm times the squared length. Arrival divides
    // both by cosIn.
    Variable vcm = kNone, vc = kNone;
  };

  // A function of M variables (and of time) under evaluation.
  template <int M>
  class Step;

  template <int M>
  Leaving leave(Step<M>& step, const Vec3<typename Step<M>::D>& origin,
                const Vec3<typename Step<M>::D>& direction, typename Step<M>::D vcm,
                bool fromInfinity, Side side, int next, DirectionChart<S>& chart);
  template <int M>
  void arrive(const Step<M>& step, const Leaving& leaving, Subpath& subpath);
  template <int M>
  Arrival<typename Step<M>::D> arrival(const Step<M>& step, int first, const Subpath& subpath,
                                       const TracedVertex& vertex) const;
  template <int M>
  Vec2<typename Step<M>::D> uvAt(const Step<M>& step, const TracedVertex& vertex) const;
  template <int M>
  void logFactor(Step<M>& step, const Rgb<typename Step<M>::D>& factor, int (&outputs)[3]);
  template <int M>
  void multiply(const Step<M>& step, const int (&outputs)[3]);
  template <int M>
  Factors logFactors(Step<M>& step, const typename Link<typename Step<M>::D>::Factors& factors,
                     const typename Step<M>::D& cosIn);
  template <int M>
  void addTerm(const Step<M>& step, int output, Variable log);
  template <int M>
  void end(Step<M>& step, const Link<typename Step<M>::D>& link,
           const typename Step<M>::D* cameraCosIn, const typename Step<M>::D* lightCosIn);
  // log(root((vc reverse)^2 + vcm^2) factor), the factor's logarithm kNone if it is one; kNone if the
  // root is zero.
  Variable logRoot(const Subpath& subpath, Variable reverse, Variable factor = kNone) {
    return composition_.logSumExpOfSum(subpath.vc, reverse, subpath.vcm, factor, S(2));
  }

  // A step of the camera's film position and, with kAperture, of the point of its lens, in this order.
  template <bool kAperture>
  auto fromFilm(int more = 0);
  template <bool kAperture>
  void startCamera();
  void startLight();
  void scatter(Side side, int index);
  void passThrough(Side side, int index);
  template <bool kAperture>
  void seeEnvironment();  // the camera's own ray escapes
  void scatterToEnvironment();
  void passToEnvironment();
  void hitLight();
  void connectToLight();
  void connectVertices();
  void countCancelledChord(const TracedVertex& cameraEnd, const TracedVertex& lightEnd);
  template <bool kAperture>
  void connectToCamera();
  Variable finish();

  const TracedVertex& cameraVertex(int i) const { return path_.camera[at(i)]; }
  const TracedVertex& lightVertex(int i) const { return path_.light[at(i)]; }
  const TracedVertex& vertexOf(Side side, int i) const {
    return side == Side::kCamera ? cameraVertex(i) : lightVertex(i);
  }
  // The number of a subpath's last vertex.
  int lastVertex(Side side) const {
    const auto [s, t] = path_.technique;
    return side == Side::kCamera ? t - (path_.escaped ? 2 : 1) : s - 1;
  }
  // How many vertices the ray goes straight on through, from the one at `next` on.
  int passedFrom(Side side, int next) const {
    int count = 0;
    while (next + count < lastVertex(side) && vertexOf(side, next + count).lobe.null) ++count;
    return count;
  }

  const Scene& scene_;
  const Path& path_;
  ad::Composition<S>& composition_;
  Subpath camera_, light_;
  // The factors that make a channel of the contribution: the product of constant ones, logs of the others;
  // `dark` if one of them is zero.
  struct Channel {
    bool dark = false;
    double scale = 1;
    int count = 0;
    Variable logs[kMaxPathLength + 2];
  };
  Channel channels_[3];
  Variable terms_[6];  // logs of the terms of the MIS weight
  int termCount_ = 0;
};

// Value, gradient and the Hessian's lower triangle of the path's log target at `u`. Returns by how much
// rounding is magnified (ad::Composition::differentiate); -1, and nothing else, where a factor has
// underflowed.
template <class S>
S composeDerivatives(const Scene& scene, const Path& path, const S* u, S& value, S* gradient,
                     S* hessian) {
  static thread_local ad::Composition<S> composition;
  const int target = path.moving ? LocalForm<S, true>(scene, path, composition).logTarget(u)
                                 : LocalForm<S, false>(scene, path, composition).logTarget(u);
  if (target < 0) return S(-1);
  value = composition.value(target);
  return composition.differentiate(target, gradient, hessian);
}

extern template class LocalForm<float, false>;
extern template class LocalForm<float, true>;
extern template class LocalForm<double, false>;
extern template class LocalForm<double, true>;

}  // namespace h2mc
