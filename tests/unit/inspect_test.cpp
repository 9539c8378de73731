// SPDX-License-Identifier: MIT
// What h2mc inspect computes, on a room that light reaches everywhere.
#include "inspect/inspect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "inspect/picture.h"
#include "inspect/report.h"
#include "inspect/ridge.h"
#include "mcmc/methods/methods.h"
#include "render/core/index.h"
#include "scene_files.h"

namespace h2mc {
namespace {

constexpr const char* kRoom = R"(<scene version="0.6.0">
  <sensor type="perspective"><float name="fov" value="50"/>
    <transform name="toWorld"><lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film></sensor>
  <bsdf type="twosided" id="grey"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></bsdf>
  <bsdf type="twosided" id="gloss"><bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf></bsdf>
  <shape type="rectangle"><transform name="toWorld"><rotate x="1" angle="-90"/><scale value="2"/></transform>
    <ref id="gloss"/></shape>
  <shape type="rectangle"><transform name="toWorld"><scale value="2"/><translate z="-2" y="1"/></transform>
    <ref id="grey"/></shape>
  <shape type="rectangle">
    <transform name="toWorld"><rotate y="1" angle="90"/><scale value="2"/><translate x="-2" y="1"/></transform>
    <ref id="grey"/></shape>
  <shape type="rectangle"><transform name="toWorld"><rotate x="1" angle="90"/><translate y="2.5"/></transform>
    <ref id="grey"/><emitter type="area"><rgb name="radiance" value="3, 3, 3"/></emitter></shape>
</scene>)";

class Inspect : public ::testing::Test {
 protected:
  Inspect()
      : scene_(folder_.read(kRoom)), method_(&methodNamed("h2mc")), options_(method_->plugin()) {
    settings_.pixelX = 5;
    settings_.pixelY = 9;
    settings_.samples = 2000;
    settings_.mutations = 500;
    settings_.proposals = 200;
    settings_.resolution = 15;
    settings_.threads = 1;
    // Short enough for derivatives in every build.
    options_.set("minDepth", "2");
    options_.set("maxDepth", "3");
  }
  Inspection run() const { return inspect(scene_, *method_, options_, settings_); }

  testing::SceneFolder folder_;
  Scene scene_;
  const MetropolisMethod* method_;
  OptionSet options_;
  InspectSettings settings_;
};

TEST_F(Inspect, PathIsInThePixelAndItsModelIsOne) {
  const Inspection result = run();
  EXPECT_GT(result.path.target, 0);
  EXPECT_EQ(static_cast<int>(result.path.filmX * 16), 5);
  EXPECT_EQ(static_cast<int>(result.path.filmY * 12), 9);
  EXPECT_EQ(result.pixelX, 5);
  EXPECT_EQ(result.pixelY, 9);
  EXPECT_EQ(result.path.technique.length(), 3);
  EXPECT_GT(result.search.contributing, 100);

  const LocalModel& model = result.model;
  ASSERT_TRUE(model.available) << model.reason;
  const std::size_t n = model.eigen.size();
  ASSERT_EQ(n, 6u);
  double trace = 0, sum = 0;
  for (std::size_t i = 0, k = 0; i < n; k += ++i) trace += model.hessian[k + i];
  for (std::size_t i = 0; i < n; ++i) {
    sum += model.eigen[i].value;
    if (i > 0) {
      EXPECT_GE(std::abs(model.eigen[i - 1].value), std::abs(model.eigen[i].value));
    }
    for (std::size_t j = 0; j < n; ++j)
      EXPECT_NEAR(dotProduct(model.eigen[i].vector, model.eigen[j].vector), i == j, 1e-12);
    EXPECT_NEAR(model.deviationAlong(model.eigen[i].vector), model.eigen[i].deviation, 1e-9);
    EXPECT_NEAR(model.driftAlong(model.eigen[i].vector), model.eigen[i].mean, 1e-9);
  }
  EXPECT_NEAR(sum, trace, 1e-6 * std::abs(model.eigen[0].value) * static_cast<double>(n));
}

TEST_F(Inspect, SlicesHaveTheStateInTheirMiddle) {
  const Inspection result = run();
  ASSERT_EQ(result.pairs.size(), 13u);  // ten of five eigenvectors, three of coordinates
  EXPECT_EQ(result.pairs[0].x.name, "e1");
  EXPECT_EQ(result.pairs[0].y.name, "e2");
  EXPECT_EQ(result.pairs.back().y.name, "u5");
  for (const InspectedPair& pair : result.pairs) {
    EXPECT_NEAR(dotProduct(pair.x.vector, pair.x.vector), 1, 1e-12);
    EXPECT_NEAR(dotProduct(pair.x.vector, pair.y.vector), 0, 1e-12);
    EXPECT_NEAR(pair.wide.halfX, 0.04, 1e-7);
    for (const Slice* slice : {&pair.wide, &pair.close}) {
      const std::size_t middle = slice->index(7, 7);
      EXPECT_EQ(slice->x(7), 0);
      EXPECT_EQ(slice->y(7), 0);
      EXPECT_EQ(slice->cells[middle], SliceCell::kSame);
      EXPECT_NEAR(slice->logRatio[middle], 0, 1e-6);
      for (std::size_t i = 0; i < slice->cells.size(); ++i) {
        const bool lit =
            slice->cells[i] != SliceCell::kDark && slice->cells[i] != SliceCell::kOutside;
        EXPECT_EQ(std::isfinite(slice->logRatio[i]), lit);
      }
    }
  }
}

// What is left over is of third order: an eighth of it at half the distance.
TEST_F(Inspect, QuadraticApproximatesTheTargetNearby) {
  const Inspection result = run();
  ASSERT_TRUE(result.model.available);
  const auto largestError = [&](double half) {
    double error = 0;
    const Direction &x = result.pairs[0].x, &y = result.pairs[0].y;
    const Slice slice = traceSlice(scene_, result.path, x, y, half, half, 9, 1, nullptr);
    std::vector<double> offset(x.vector.size());
    for (int row = 0; row < 9; ++row)
      for (int column = 0; column < 9; ++column) {
        for (std::size_t i = 0; i < offset.size(); ++i)
          offset[i] = slice.x(column) * x.vector[i] + slice.y(row) * y.vector[i];
        error = std::max(error, std::abs(slice.logRatio[slice.index(column, row)] -
                                         result.model.logRatio(offset)));
      }
    return error;
  };
  const double length = 1 / std::sqrt(std::abs(result.model.eigen[0].value));
  const double wide = largestError(0.1 * length), narrow = largestError(0.05 * length);
  EXPECT_LT(wide, 0.02);
  EXPECT_LT(narrow, 0.25 * wide + 1e-5);
}

TEST_F(Inspect, SlicesEndWithThePrimarySpace) {
  settings_.sliceSize = 1;
  settings_.pair = "u0,u1";
  const Inspection result = run();
  // A film position and a width of 1: what is beyond the film is outside.
  const InspectedPair& pair = result.pairs.front();
  ASSERT_EQ(pair.x.name, "u0");
  ASSERT_GE(result.path.technique.t, 2);
  const Slice& slice = pair.wide;
  for (int row = 0; row < 15; ++row)
    for (int column = 0; column < 15; ++column) {
      const double x = result.path.filmX + slice.x(column), y = result.path.filmY + slice.y(row);
      const bool inside = x >= 0 && x < 1 && y >= 0 && y < 1;
      EXPECT_EQ(slice.cells[slice.index(column, row)] != SliceCell::kOutside, inside);
    }
}

TEST_F(Inspect, ProposalsAreProbabilitiesAndOffsets) {
  const Inspection result = run();
  std::vector<std::string> names;
  for (const ProposalKind& kind : result.kinds) {
    names.push_back(kind.name);
    ASSERT_EQ(kind.proposals.size(), 200u);
    double acceptance = 0, jump = 0;
    std::vector<double> along(result.model.eigen.size(), 0);
    for (const InspectedProposal& p : kind.proposals) {
      EXPECT_GE(p.acceptance, 0);
      EXPECT_LE(p.acceptance, 1);
      EXPECT_TRUE(!p.accepted || p.acceptance > 0);
      acceptance += p.acceptance / 200;
      if (p.offset.empty()) continue;
      const std::vector<double> offset(p.offset.begin(), p.offset.end());
      const double squares = dotProduct(offset, offset);
      jump += p.acceptance / 200 * std::sqrt(squares);
      // Eigenvectors are a basis: the projections have all of the offset's length.
      double projected = 0;
      for (std::size_t i = 0; i < along.size(); ++i) {
        const double a = dotProduct(result.model.eigen[i].vector, offset);
        projected += a * a;
        along[i] += p.acceptance / 200 * a * a;
      }
      EXPECT_NEAR(projected, squares, 1e-9 + 1e-6 * squares);
    }
    EXPECT_NEAR(kind.acceptance, acceptance, 1e-9);
    EXPECT_NEAR(kind.jump, jump, 1e-9);
    for (std::size_t i = 0; i < along.size(); ++i)
      EXPECT_NEAR(kind.jumpAlong[i], std::sqrt(along[i]), 1e-9);
  }
  if (result.path.technique.t >= 2) {
    EXPECT_EQ(names, (std::vector<std::string>{"large", "lens", "isotropic", "hamiltonian"}));
  }
  // In a diffuse room small steps are accepted more often than large ones.
  EXPECT_GT(result.kinds.back().acceptance, result.kinds.front().acceptance);
}

TEST_F(Inspect, SameForAnyNumberOfThreads) {
  const auto text = [&] {
    return inspectionJson(scene_, run(), options_, settings_, ArrayForm::kNumbers).dump();
  };
  const std::string one = text();
  settings_.threads = 3;
  EXPECT_EQ(text(), one);
  settings_.seed = 1;
  EXPECT_NE(text(), one);
}

TEST_F(Inspect, TheLargestIsLargerThanAState) {
  const float state = run().path.target;
  settings_.choice = PathChoice::kLargest;
  const Inspection largest = run();
  EXPECT_GE(largest.path.target, state);

  settings_.choice = PathChoice::kGiven;
  settings_.given = largest.path.technique;
  settings_.givenSample = largest.path.sample;
  const Inspection given = run();
  EXPECT_EQ(given.path.target, largest.path.target);
  EXPECT_EQ(given.pixelX, 5);
}

// Of paths that are drawn alike it takes the one with the clearest ridge, and slices that show it.
TEST_F(Inspect, ShowsARidge) {
  const auto ridgeOf = [&](const Inspection& inspection) {
    return ridgeAt(scene_, inspection.path, inspection.model, 1, nullptr);
  };
  double states = 0;
  for (settings_.seed = 0; settings_.seed < 4; ++settings_.seed)
    states = std::max(states, ridgeOf(run()).strength);
  settings_.seed = 0;
  settings_.choice = PathChoice::kRidge;
  const Inspection result = run();
  EXPECT_EQ(static_cast<int>(result.path.filmX * 16), 5);
  EXPECT_GT(result.search.accepted, 0);
  const Ridge ridge = ridgeOf(result);
  EXPECT_GT(ridge.strength, states);
  EXPECT_EQ(result.pairs.front().wide.halfX, ridge.half);
  // Wider than an isotropic step, and than the ridge.
  EXPECT_GE(ridge.half, 1.5 * result.model.settings.sigma);
  EXPECT_GE(ridge.half, std::min(0.5, 4 / std::sqrt(-result.model.eigen[0].value)));
  settings_.sliceSize = 0.03;
  EXPECT_EQ(run().pairs.front().wide.halfX, 0.015);
}

// Their film position is no coordinate, and the lens perturbation has none to move.
TEST_F(Inspect, PathsThatTheLightSubpathEnds) {
  BidirectionalSampler sampler(3);
  Random random(1, 2, 3);
  while (settings_.choice != PathChoice::kGiven)
    sampler.sample(scene_, random, -1, -1, 3, [&](const BidirectionalSampler::Connection& c) {
      if (c.technique.t != 1) return;
      settings_.choice = PathChoice::kGiven;
      settings_.given = c.technique;
      settings_.givenSample = sampler.primarySample(c.technique);
    });
  const Inspection result = run();
  EXPECT_EQ(result.path.technique.t, 1);
  EXPECT_EQ(result.kinds.size(), 3u);
  for (const ProposalKind& kind : result.kinds) {
    EXPECT_NE(kind.name, "lens");
    for (const InspectedProposal& p : kind.proposals) {
      if (p.acceptance > 0) {
        EXPECT_GE(p.filmX, 0);
        EXPECT_LT(p.filmX, 1);
      }
    }
  }
  EXPECT_GT(drawPair(scene_, result, result.pairs.front(), result.pairs.front().close).width, 100);
}

TEST_F(Inspect, ComparesTopologies) {
  const Inspection result = run();
  Path other = result.path;
  EXPECT_EQ(compareTopology(result.path, other), SliceCell::kSame);
  const auto last = at(result.path.technique.t) - 1;
  ASSERT_GE(last, 1u);
  other.camera[1].id.primitive += 1;
  EXPECT_EQ(compareTopology(result.path, other), SliceCell::kOtherPrimitive);
  other.camera[1].id.shape += 1;
  EXPECT_EQ(compareTopology(result.path, other), SliceCell::kOtherTopology);
  other = result.path;
  other.lightIndex += 1;
  EXPECT_EQ(compareTopology(result.path, other), SliceCell::kOtherTopology);
  // A subpath's last vertex scatters through no lobe of its own.
  other = result.path;
  other.camera[last].lobe.lobe += 1;
  EXPECT_EQ(compareTopology(result.path, other), SliceCell::kSame);
}

TEST_F(Inspect, LongPaths) {
  options_.set("minDepth", "9");
  options_.set("maxDepth", "9");
  const Inspection result = run();
  EXPECT_TRUE(result.model.available);
  EXPECT_EQ(result.model.eigen.size(), 18u);
}

TEST_F(Inspect, OfMmltToo) {
  method_ = &methodNamed("mmlt");
  OptionSet options(method_->plugin());
  options.set("maxDepth", "3");
  options.set("largeStep", "multiplexed");
  options_ = options;
  const Inspection result = run();
  EXPECT_TRUE(result.model.available);
  EXPECT_EQ(result.kinds.front().name, "large");
  EXPECT_EQ(result.kinds.back().name, "isotropic");
}

TEST_F(Inspect, RefusesPairsThatAreNone) {
  for (const char* bad : {"", "e1", "e1,", ",e1", "e1,e1", "e1,u0", "x,y", "e1,e2,e3", "e-1,e2"})
    EXPECT_THROW(checkPairText(bad), InspectError) << bad;
  for (const char* good : {"e1,e2", "u0,u7", "time,u0", "e2,e1"}) checkPairText(good);
  settings_.pair = "e1,e7";
  EXPECT_THROW(run(), InspectError);
}

TEST_F(Inspect, SaysWhereNoLightArrives) {
  // The camera looks past everything there.
  settings_.pixelX = 15;
  settings_.pixelY = 0;
  EXPECT_THROW(run(), DarkPixel);
}

}  // namespace
}  // namespace h2mc
