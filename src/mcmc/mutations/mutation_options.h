// SPDX-License-Identifier: MIT
// Parameters that more than one mutation has.
#pragma once

#include "render/scene/option_set.h"

namespace h2mc {

inline constexpr Parameter kSigmaParameter = {
    "sigma", ParameterType::kNumber, "0.01",
    "standard deviation of isotropic steps, and of the prior of those that derivatives give"};
inline constexpr Parameter kTargetAcceptanceParameter = {
    "targetAcceptance", ParameterType::kNumber, "0",
    "the size of isotropic, lens and Langevin steps is changed between epochs, for each length of "
    "paths, until this share of them is accepted; 0: it stays as it is"};
inline void requireAcceptance(const OptionSet& options) {
  requireRange(options, "targetAcceptance", 0, 0.99);
}
inline constexpr Parameter kTrajectoryLengthParameter = {
    "trajectoryLength", ParameterType::kNumber, "1.5707963",
    "length of the Hamiltonian trajectory, 0 < L < pi"};
inline constexpr Parameter kStepSizeParameter = {
    "stepSize", ParameterType::kNumber, "1",
    "deviation of a Langevin step along a coordinate, times the derivatives met there"};
inline constexpr Parameter kPreconditionerParameter = {
    "preconditioner", ParameterType::kString, "squares",
    "of Langevin steps: by the derivatives' mean squares, or the authors', with a stepSize like "
    "sigma",
    "squares|published"};
inline constexpr Parameter kMaxDriftParameter = {
    "maxDrift", ParameterType::kNumber, "3",
    "longest drift of a proposal along an eigenvector or axis, in its standard deviations"};

inline constexpr Parameter kRoughnessThresholdParameter = {
    "roughnessThreshold", ParameterType::kNumber, "0.1",
    "scattering lobes narrower than this (radians) are followed, not joined to, by perturbations "
    "of a path's ends"};
inline float roughnessThreshold(const OptionSet& options) {
  return static_cast<float>(options.number("roughnessThreshold"));
}

}  // namespace h2mc
