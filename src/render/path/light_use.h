// SPDX-License-Identifier: MIT
// Which lights matter to what the camera sees.
#pragma once

namespace h2mc {

struct Scene;

// Sets scene.directPicker and scene.emissionPicker. Power says little about which light matters: an
// environment's grows with the scene, a lamp may shine away from the camera or behind a wall. So some
// camera paths are traced, and at each of their vertices every light is asked for its share of what
// arrives there. With w the root mean square of a light's shares, which as a probability makes the
// relative variance of the estimate least, and p its power, both scaled to the sum 1, the
// probabilities are 0.9 w + 0.1 p for next-event estimation and (w + p) / 2 for light subpaths, whose
// light may arrive by ways that the camera paths have not found. Positive for every light that emits.
//
// A function of the scene alone: the same for every integrator and seed. Preconditions: the tracer is
// there, and both pickers are by power.
void pickLightsByUse(Scene& scene);

}  // namespace h2mc
