// SPDX-License-Identifier: MIT
// A render in which path tracing makes the direct light and mutations the rest, by turns.
#pragma once

#include <string>

#include "mcmc/render/direct_lighting.h"
#include "render/core/archive.h"
#include "render/integrator/integrator.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {

// What such renders have alike, whatever makes the mutations: their budget, the direct light beside them and the look
// of their results.
class SplitRender : public RenderInProgress {
 public:
  SplitRender(const SplitRender&) = delete;
  SplitRender& operator=(const SplitRender&) = delete;

  bool isOver() const override { return over_; }
  void pause(const std::function<void()>& work) override {
    clock_.exclude([&] { direct_.pause(work); });
  }

 protected:
  // By the options directSamples, minDepth, maxDepth and mutationsPerPixel. `maxLength`: of paths, in edges. Keeps
  // references.
  SplitRender(const OptionSet& options, int maxLength, const Scene& scene,
              const RenderRequest& request);

  bool timed() const { return request_.budget.seconds > 0; }
  bool stopped() const { return request_.stop && *request_.stop; }
  // Whether direct lighting is left out of the mutations' paths.
  bool split() const { return direct_.wanted(); }
  double pixels() const { return static_cast<double>(scene_.film.width) * scene_.film.height; }

  // Direct lighting keeps pace with the mutations: up to mark i it gets what a render that ends there would give it.
  void extendDirect(std::size_t mark);
  // To be called when mutations begin, before balanceDirect(); not in a render that goes on.
  void startMutations();
  // Brings direct lighting up to what makes the picture's variance least, now that there are so many mutations a pixel,
  // one of them costs so much (DirectLighting::Standing), and there will be another call at the end of the epoch.
  void balanceDirect(double mutations, double mutationCost);

  // Hands out a result at a mark, without counting the time that takes.
  void atMark(std::size_t mark, const std::function<RenderResult()>& result);
  void look() { request_.watch(*this); }
  // When the render is over. Where a rank is lost, what the others have counted since they last met is missing.
  void gatherLast();
  void lookLast();
  // Where there is nothing for mutations to do.
  RenderResult directAlone();
  // Where they would find no light: the same, and says so.
  RenderResult withoutLight();

  // Contributions that were not finite and are left out, and what replays one of them.
  struct NotFinite {
    long long count = 0;
    std::string first;
    void archive(Archive& archive) { archive(count, first); }
  };
  // The picture of the mutations, or nothing, as the render's: with direct light, in the scene's units, with what was
  // not finite of `source` ("chains"), of the bootstrap and of direct light.
  RenderResult finished(RenderResult result, const char* source, const NotFinite& bootstrap) const;
  // As it is with what there is now.
  virtual RenderResult finished(RenderResult result) const = 0;

  // Clock, direct light and where they stand.
  void archiveDirect(Archive& archive);

  RenderClock clock_;
  const OptionSet& options_;
  const Scene& scene_;
  const RenderRequest& request_;
  const long long mutationsPerPixel_;  // 0 where seconds are the only limit
  const RenderRequest directRequest_;
  DirectLighting direct_;
  const int minLength_, maxLength_;  // of the mutations' paths
  std::size_t nextMark_ = 0;

 private:
  long long mutationBudget() const;
  RenderRequest directRequest() const;

  bool over_ = false;
  double began_ = 0, directBefore_ = 0;  // seconds of the clock, seconds of direct_ by then
};

}  // namespace h2mc
