// SPDX-License-Identifier: MIT
// What samples and passes add up to, and how uncertain that is.
#pragma once

namespace h2mc {

// Tallies of one group, merged in the groups' order.
struct SampleTally {
  double luminance = 0, squares = 0;  // of whole samples, splats to other pixels included
  long long samples = 0;
  long long notFinite = 0;  // contributions left out

  void add(const SampleTally& other);
  double meanLuminance() const;
  double meanLuminanceError() const;  // its standard error
};

// Whole passes, where samples of one pass depend on each other but passes don't.
struct PassTally {
  double luminance = 0, squares = 0;  // of the passes' mean luminances
  long long passes = 0;
  double before = 0;  // the samples' luminance in all when the last of them ended

  // A pass of so many samples has ended.
  void end(const SampleTally& all, double samples);
  // The standard error of the mean; infinite before the second.
  double error() const;
};

}  // namespace h2mc
