// SPDX-License-Identifier: MIT
#include "mcmc/chain/chain.h"

#include <cassert>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// One mutation in so many is timed: often enough to know the shares, seldom enough not to matter.
constexpr long long kTimedEvery = 64;

}  // namespace

Chain::Chain(const Target& target, const Path& start, Random random)
    : target_(target),
      current_(std::make_unique<ChainState>(target.maxLength())),
      proposed_(std::make_unique<ChainState>(target.maxLength())),
      random_(random) {
  current_->path.technique = start.technique;
  current_->path.sample = start.sample;
  [[maybe_unused]] const bool positive = target_.evaluate(current_->path);
  assert(positive);
}

void Chain::restart(const Path& from) {
  assert(from.target > 0);
  current_->forget();
  current_->path = from;
}

void Chain::begin(const Path& from, Random random) {
  assert(weight_ == 0);
  restart(from);
  memory_.forget();
  random_ = random;
  steps_ = 0;
  moved_ = false;
}

void Chain::archive(Archive& archive) {
  assert(weight_ == 0);
  archive(current_->path, random_, steps_, moved_);
  if (archive.reading()) current_->forget();
}

void Chain::flush(const KernelMixture& kernels, StateFilm& film) {
  const Path& path = current_->path;
  if (weight_ > 0) {
    kernels.large->splatState(*current_, weight_, kernels.division(path.technique), film);
    film.land(path.filmX, path.filmY, weight_);
  }
  weight_ = 0;
}

void Chain::step(KernelMixture& kernels, ChainFilms& films, ChainStatistics& statistics,
                 MutationContext& context) {
  if (steps_ % kDerivedAnew == 0) {
    flush(kernels, films.states);
    current_->forget();
    memory_.forget();
  }
  context.random = &random_;
  context.timed = steps_++ % kTimedEvery == 0;
  context.seconds = {};
  RaySeconds rays(context.timed);
  const double start = context.timed ? wallClock() : 0;

  context.memory = &memory_;
  kernels.large->complete(*current_, context);
  const auto choice = kernels.choose(current_->path, random_);
  if (choice)
    propose(*choice, kernels, films, statistics, context);
  else
    weight_ += 1;
  ++statistics.mutations;
  if (context.timed) {
    statistics.profile.add({1, wallClock() - start, rays.seconds(), context.seconds.derivatives,
                            context.seconds.gaussian});
  }
}

void Chain::propose(const KernelMixture::Choice& choice, KernelMixture& kernels, ChainFilms& films,
                    ChainStatistics& statistics, MutationContext& context) {
  const std::size_t kind = choice.kind;
  Mutation& mutation = kernels.mutation(kind);
  proposed_->forget();
  proposed_->path.finite = true;
  context.sums = &statistics.sums[kind];
  const Proposal proposal = mutation.propose(*current_, *proposed_, context);
  double acceptance = 0;
  if (proposal.made()) {
    acceptance = proposal.acceptance(current_->path, proposed_->path,
                                     kernels.logRatio(choice, proposed_->path));
  } else {
    ++statistics.refusals[kind][static_cast<std::size_t>(proposal.refusal())];
    if (!proposed_->path.finite)
      context.notFinite.add(proposed_->path.technique, proposed_->path.sample);
  }

  // Each state counts with its expected weight [Veach 1997, section 11.4].
  const int length = current_->path.technique.length();
  const std::size_t row = octaveRow(kernels.octave(current_->path.target));
  double& departures = statistics.departures[row];
  if (kind == 0) {
    const double estimate = kernels.large->lastEstimate();
    statistics.largeSteps.add(estimate);
    if (estimate > 0 && kernels.meanTarget)
      kernels.large->splatSample(*proposed_, kernels.division(), films.samples);
  }
  if (mutation.triesAgain()) {
    // There is a second try where the first is refused: what is left of the weight is that of the state then.
    if (accept(proposed_, acceptance, kernels, mutation, films.states, departures))
      acceptance = 1;
    else
      acceptance = proposeAgain(choice, acceptance, kernels, films, statistics.secondTries[kind],
                                departures, context);
  } else {
    weight_ += 1 - acceptance;
    accept(proposed_, acceptance, kernels, mutation, films.states, departures);
  }
  statistics.acceptance[kind][at(length)].add(acceptance);
  statistics.octaves[kind][row].add(acceptance);
}

bool Chain::accept(std::unique_ptr<ChainState>& proposed, double acceptance, KernelMixture& kernels,
                   Mutation& mutation, StateFilm& film, double& departures) {
  if (!(acceptance > 0)) return false;
  const Path& path = proposed->path;
  if (kernels.departs(current_->path, path)) departures += acceptance;
  mutation.splatProposal(*proposed, acceptance, kernels.division(path.technique), film);
  film.land(path.filmX, path.filmY, acceptance);
  if (!(random_.uniform() < acceptance)) return false;
  flush(kernels, film);
  std::swap(current_, proposed);
  moved_ = true;
  return true;
}

double Chain::proposeAgain(const KernelMixture::Choice& choice, double first,
                           KernelMixture& kernels, ChainFilms& films, AcceptanceCount& count,
                           double& departures, MutationContext& context) {
  for (auto* state : {&second_, &back_}) {
    if (!*state) *state = std::make_unique<ChainState>(target_.maxLength());
    (*state)->forget();
    (*state)->path.finite = true;
  }
  Mutation& mutation = kernels.mutation(choice.kind);
  const Proposal proposal = mutation.proposeAgain(*current_, *proposed_, *second_, *back_, context);
  double acceptance = 0;
  if (proposal.made()) {
    // That the first try was refused is a part of the way there. On the way back it is that of the other first try,
    // from states that choose the kernel with probabilities of their own.
    const Path& path = second_->path;
    const KernelMixture::Choice other{choice.kind, kernels.probability(choice.kind, path)};
    if (other.probability > 0) {
      const double firstBack = back_->path.target > 0
                                   ? Proposal::withLogRatio(0).acceptance(
                                         path, back_->path, kernels.logRatio(other, back_->path))
                                   : 0;
      acceptance =
          Proposal::withLogRatio(proposal.logRatio() + std::log((1 - firstBack) / (1 - first)))
              .acceptance(current_->path, path, kernels.logRatio(choice, path));
    }
  }
  for (const auto* state : {&second_, &back_})
    if (!(*state)->path.finite)
      context.notFinite.add((*state)->path.technique, (*state)->path.sample);
  count.add(acceptance);
  weight_ += 1 - acceptance;
  accept(second_, acceptance, kernels, mutation, films.states, departures);
  return acceptance;
}

}  // namespace h2mc
