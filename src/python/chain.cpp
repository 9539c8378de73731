// SPDX-License-Identifier: MIT
// Markov chains in Python, with mutations of the program and of the caller's own.
#include "mcmc/chain/chain.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "mcmc/mutations/mutations.h"
#include "mcmc/populations/bootstrap.h"
#include "mcmc/render/integrator_choice.h"
#include "python/traced_path.h"
#include "render/scene/suggestion.h"

namespace h2mc::python {
namespace {

constexpr std::uint64_t kStream = 0x707963;

// A mutation that is a callable of Python's. Whoever runs it holds Python's lock.
class CallableStep final : public Mutation {
 public:
  CallableStep(ScenePtr scene, const PathTarget& target, py::object step)
      : scene_(std::move(scene)),
        target_(target),
        step_(std::move(step)),
        name_(py::str(py::getattr(step_, "__name__", py::type::of(step_).attr("__name__")))) {}

  std::string_view name() const override { return name_; }

  Proposal propose(ChainState& current, ChainState& proposed, MutationContext&) override {
    const Path& from = current.path;
    const PrimarySpace space(scene_, from.technique.s, from.technique.t);
    Doubles x(space.columns());
    space.setRow(from.sample, x.mutable_data());
    const py::object answer = step_(space, x);
    if (answer.is_none()) return Proposal::none();
    const auto [y, logRatio] = proposalOf(answer);
    if (y.ndim() != 1 || y.shape(0) != space.columns())
      throw UserError(fmt::format("{}: expected a proposal of {} coordinates, (x, log ratio)",
                                  name_, space.columns()));
    for (py::ssize_t i = 0; i < y.shape(0); ++i) {
      if (!std::isfinite(y.data()[i]))
        throw UserError(fmt::format("{}: coordinate {} of the proposal is {:g}", name_,
                                    space.names()[at(i)], y.data()[i]));
      if (!(y.data()[i] >= 0 && y.data()[i] < 1)) return Proposal::none(Refusal::kRange);
    }
    if (std::isnan(logRatio)) throw UserError(name_ + ": the log ratio is not a number");
    proposed.path.technique = from.technique;
    proposed.path.sample = space.sample(y.data());
    if (!target_.evaluate(proposed.path)) return Proposal::none(Refusal::kDark);
    return Proposal::withLogRatio(logRatio);
  }

 private:
  std::pair<Doubles, double> proposalOf(const py::object& answer) const {
    try {
      return answer.cast<std::pair<Doubles, double>>();
    } catch (const py::cast_error&) {
      throw UserError(name_ + ": expected (x, log ratio) or None");
    }
  }

  ScenePtr scene_;
  const PathTarget& target_;
  py::object step_;
  std::string name_;
};

class PythonChain {
 public:
  PythonChain(ScenePtr scene, const std::vector<std::pair<py::object, double>>& mutations,
              double largeStep, int maxEdges, int minEdges, std::uint64_t seed,
              long long bootstrapSamples);

  void step(long long count);
  py::array_t<float> image();
  TracedPath path() const { return traced(chain_->path()); }
  py::dict statistics() const;
  py::list propose(std::size_t kind, int count);

 private:
  TracedPath traced(const Path& path) const {
    return {PrimarySpace(scene_, path.technique.s, path.technique.t), path};
  }
  std::unique_ptr<Mutation> made(const py::object& wish, SlotNumbers& slots);
  // Moves what chains have splatted to the film.
  void drain() {
    films_.states.splats.sort(film_, 1);
    films_.states.splats.addBand(0, 0, film_);
    films_.clear();
  }

  static constexpr long long kBlock = 4096;  // steps between looks at Ctrl-C

  ScenePtr scene_;
  int maxEdges_, minEdges_;
  ImportanceMap everywhere_;
  SceneTarget target_;
  TechniqueDistribution techniques_;
  std::vector<std::unique_ptr<OptionSet>> options_;
  KernelMixture kernels_;
  bool callsPython_ = false;
  std::optional<ChainStatistics> statistics_;
  MutationContext context_;
  Random random_;  // of propose()
  ChainFilms films_;
  Film film_;
  std::optional<Chain> chain_;
  double meanTarget_ = 0;
  long long steps_ = 0;
};

// "NAME" or "NAME:option=value,...".
std::unique_ptr<Mutation> PythonChain::made(const py::object& wish, SlotNumbers& slots) {
  if (!py::isinstance<py::str>(wish)) {
    if (!PyCallable_Check(wish.ptr()))
      throw UserError("mutations: expected names of mutations, or callables");
    callsPython_ = true;
    return std::make_unique<CallableStep>(scene_, target_, wish);
  }
  const NamedOptions named = namedOptions(wish.cast<std::string>());
  Names names;
  for (const MutationPlugin& plugin : h2mc::mutations()) {
    names.emplace_back(plugin.name);
    if (plugin.name != named.name) continue;
    auto options = std::make_unique<OptionSet>(
        IntegratorPlugin{plugin.name, plugin.description, plugin.parameters});
    for (const auto& [name, value] : named.options) options->set(name, value);
    if (plugin.check) plugin.check(*options);
    options_.push_back(std::move(options));
    return plugin.create({target_, techniques_, minEdges_, *options_.back(), slots});
  }
  throw UserError("unknown mutation \"" + named.name + "\"; " + suggestion(named.name, names));
}

PythonChain::PythonChain(ScenePtr scene,
                         const std::vector<std::pair<py::object, double>>& mutations,
                         double largeStep, int maxEdges, int minEdges, std::uint64_t seed,
                         long long bootstrapSamples)
    : scene_(std::move(scene)),
      maxEdges_(maxEdges),
      minEdges_(minEdges),
      target_(*scene_, maxEdges, everywhere_),
      techniques_(minEdges, maxEdges),
      random_(seed, kStream, 1),
      film_(scene_->film) {
  SlotNumbers slots;
  static const OptionSet kNone;
  kernels_.large =
      largeStepNamed("bidirectional").create({target_, techniques_, minEdges_, kNone, slots});
  kernels_.largeProbability = largeStep;
  double sum = 0;
  for (const auto& [wish, share] : mutations) {
    if (!(share > 0)) throw UserError("mutations: expected shares above 0");
    sum += share;
  }
  for (const auto& [wish, share] : mutations)
    kernels_.small.push_back({made(wish, slots), share / sum, std::nullopt});
  statistics_.emplace(kernels_.kinds(), maxEdges);

  const py::gil_scoped_release released;
  const Bootstrap bootstrap(*scene_, minEdges, maxEdges, bootstrapSamples, seed, 0);
  meanTarget_ = bootstrap.luminance().mean();
  if (!(meanTarget_ > 0)) throw UserError("no light arrives at the film: no chain can start");
  Path start(maxEdges);
  Random random(seed, kStream, 0);
  bootstrap.drawStart(random.uniformDouble(), random, start);
  chain_.emplace(target_, start, Random(seed, kStream, 2));
}

void PythonChain::step(long long count) {
  if (count < 0) throw UserError("step: expected a number of steps from 0 on");
  while (count > 0) {
    const long long now = std::min(count, callsPython_ ? kBlock / 16 : kBlock);
    const auto work = [&] {
      for (long long i = 0; i < now; ++i, ++steps_)
        chain_->step(kernels_, films_, *statistics_, context_);
      drain();
    };
    if (callsPython_) {
      work();
    } else {
      const py::gil_scoped_release released;
      work();
    }
    count -= now;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

py::array_t<float> PythonChain::image() {
  if (steps_ == 0) throw UserError("image: the chain has made no steps");
  chain_->flush(kernels_, films_.states);
  drain();
  RenderResult result;
  result.image = film_.develop(meanTarget_ / static_cast<double>(steps_));
  finish(*scene_, result);
  return toArray(result.image);
}

py::dict PythonChain::statistics() const {
  py::dict all;
  const std::vector<std::string> names = kernels_.kindNames();
  for (std::size_t kind = 0; kind < names.size(); ++kind) {
    AcceptanceCount sum;
    for (const AcceptanceCount& count : statistics_->acceptance[kind]) sum.add(count);
    py::dict of;
    of["proposed"] = sum.proposed;
    of["acceptance"] = sum.proposed > 0 ? sum.expected / static_cast<double>(sum.proposed) : 0.0;
    all[py::str(names[kind])] = of;
  }
  return all;
}

py::list PythonChain::propose(std::size_t kind, int count) {
  if (kind >= at(kernels_.kinds()))
    throw UserError(
        fmt::format("there are mutations 0 (the large step) to {}", kernels_.kinds() - 1));
  ChainState state(maxEdges_), proposed(maxEdges_);
  state.path = chain_->path();
  MutationContext context;
  context.random = &random_;
  Mutation& mutation = kernels_.mutation(kind);
  py::list made;
  for (int i = 0; i < count; ++i) {
    proposed.forget();
    const Proposal proposal = mutation.applies(state.path)
                                  ? mutation.propose(state, proposed, context)
                                  : Proposal::none();
    if (!proposal.made()) {
      made.append(py::make_tuple(py::none(), 0.0));
      continue;
    }
    made.append(
        py::make_tuple(traced(proposed.path), proposal.acceptance(state.path, proposed.path)));
  }
  return made;
}

std::unique_ptr<PythonChain> makeChain(const ScenePtr& scene, const py::dict& mutations,
                                       double largeStep, int maxEdges, int minEdges,
                                       std::uint64_t seed, long long bootstrap) {
  if (!(largeStep >= 0 && largeStep <= 1)) throw UserError("large_step: expected a probability");
  if (!(minEdges >= 1 && minEdges <= maxEdges && maxEdges <= kMaxPathLength))
    throw UserError(fmt::format("expected 1 <= min_edges <= max_edges <= {}", kMaxPathLength));
  if (bootstrap < 1) throw UserError("bootstrap: expected a number of samples above 0");
  std::vector<std::pair<py::object, double>> wishes;
  for (const auto& [wish, share] : mutations)
    wishes.emplace_back(py::reinterpret_borrow<py::object>(wish), share.cast<double>());
  return std::make_unique<PythonChain>(scene, wishes, largeStep, maxEdges, minEdges, seed,
                                       bootstrap);
}

}  // namespace

void addChain(py::module_& module, SceneClass& scene) {
  py::class_<PythonChain>(
      module, "Chain",
      "A Markov chain over a scene's paths, by Metropolis-Hastings on the union "
      "of all techniques' primary spaces.")
      .def("step", &PythonChain::step, py::arg("count") = 1, "Makes so many mutations.")
      .def("image", &PythonChain::image,
           "The image so far, float32 (height, width, 3): where the chain has been, times the mean "
           "luminance that the bootstrap has found.")
      .def_property_readonly("path", &PythonChain::path, "the state: an h2mc.Path")
      .def_property_readonly("statistics", &PythonChain::statistics,
                             "by mutation, the large step first: `proposed` and mean `acceptance`")
      .def(
          "propose", &PythonChain::propose, py::arg("mutation"), py::arg("count") = 1,
          "What a mutation would propose at the state, which stays: a list of (path, acceptance), "
          "(None, 0) for proposals that carry no light. mutation: 0 is the large step, 1 the first "
          "of the others.");
  scene.def("chain", &makeChain, py::arg("mutations"), py::kw_only(), py::arg("large_step") = 0.1,
            py::arg("max_edges") = 8, py::arg("min_edges") = 1, py::arg("seed") = 0,
            py::arg("bootstrap") = 20000,
            R"(A Markov chain, started in proportion to the target.

mutations: a dict of small steps and their shares. A step is the name of one of the program's ("isotropic",
"hamiltonian:sigma=0.02", ...: `h2mc list mutations`), or a callable step(technique, x) that returns a proposal
(y, log_ratio), or None for none: x and y are rows of the technique's array, and
log_ratio = log q(y -> x) - log q(x -> y), 0 for symmetric steps. Proposals outside of [0, 1) are rejected. The
program evaluates the target, accepts, and splats.
What steps of the program learn between epochs of a render, they do not learn here: chains have no epochs.
large_step: the probability of a new, independent path in place of a small step.
bootstrap: bidirectional samples to start from, and for the mean luminance.)");
}

}  // namespace h2mc::python
