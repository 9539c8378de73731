// SPDX-License-Identifier: MIT
#include "inspect/proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcmc/mutations/primary_offset.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// The offset between two samples of a technique, as far as the second is known.
std::vector<float> offsetOf(const Path& from, const Path& to) {
  const int own = from.technique.dimension();
  std::vector<float> offset(static_cast<std::size_t>(from.dimension()));
  offsetBetween(from.sample, to.sample, own, ~CoordinateMask(0), offset.data());
  sharedOffsetBetween(from.shared(), from.sample, to.sample, offset.data() + own);
  if (std::any_of(offset.begin(), offset.end(), [](float x) { return std::isnan(x); }))
    offset.clear();
  return offset;
}

}  // namespace

ProposalKind propose(const Scene& scene, Mutation& mutation, ChainState& state,
                     const LocalModel& model, int count, Random random) {
  ProposalKind kind;
  kind.name = mutation.name();
  kind.jumpAlong.assign(model.eigen.size(), 0);
  const Path& from = state.path;
  const double share = 1.0 / std::max(count, 1);
  ChainState proposed(static_cast<int>(from.camera.size()) - 2);
  MutationContext context;
  context.random = &random;
  for (int k = 0; k < count; ++k) {
    proposed.forget();
    // What a proposal that fails has not come to stays unknown.
    Path& to = proposed.path;
    to.technique = from.technique;
    to.sample.u.fill(kUnknown);
    to.sample.time = from.sample.time;
    to.sample.aperture = from.sample.aperture;
    to.target = 0;
    // The light and camera subpaths that a large step completes the state with are drawn anew.
    state.forget();
    const Proposal proposal = mutation.propose(state, proposed, context);
    const bool made = proposal.made();

    InspectedProposal p;
    p.acceptance = proposal.acceptance(from, to);
    p.accepted = random.uniform() < p.acceptance;
    const bool lit = to.target > 0;
    kind.dark += !lit;
    if (lit) {
      p.filmX = to.filmX;
      p.filmY = to.filmY;
    } else if (to.technique.t >= 2 && to.sample.u[0] >= 0 && to.sample.u[1] >= 0) {
      p.filmX = to.sample.u[0];
      p.filmY = to.sample.u[1];
    }
    if (!(to.technique == from.technique)) {
      ++kind.other;
    } else {
      p.offset = offsetOf(from, to);
      kind.unknown += p.offset.empty();
    }

    const double weight = share * p.acceptance;
    kind.acceptance += weight;
    if (made)
      kind.filmJump +=
          weight * std::hypot((p.filmX - from.filmX) * static_cast<float>(scene.film.width),
                              (p.filmY - from.filmY) * static_cast<float>(scene.film.height));
    if (!p.offset.empty() && weight > 0) {
      const std::vector<double> offset(p.offset.begin(), p.offset.end());
      kind.jump += weight * std::sqrt(dotProduct(offset, offset));
      for (std::size_t i = 0; i < model.eigen.size(); ++i)
        kind.jumpAlong[i] += weight * squared(dotProduct(model.eigen[i].vector, offset));
    }
    kind.proposals.push_back(std::move(p));
  }
  for (double& jump : kind.jumpAlong) jump = std::sqrt(jump);
  return kind;
}

}  // namespace h2mc
