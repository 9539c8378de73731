// SPDX-License-Identifier: MIT
#include "python/primary_space.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/core/unit_interval.h"
#include "render/core/user_error.h"

namespace h2mc::python {

PrimarySpace::PrimarySpace(ScenePtr scene, int s, int t)
    : scene_(std::move(scene)), technique_{s, t} {
  if (s < 0 || t < 1 || technique_.length() < 1 || technique_.length() > kMaxPathLength ||
      technique_ == Technique{1, 1})
    throw UserError(
        fmt::format("there is no technique s={} t={} of 1 to {} edges", s, t, kMaxPathLength));
}

std::vector<std::string> PrimarySpace::names() const {
  std::vector<std::string> names;
  names.reserve(at(columns()));
  for (int i = 0; i < technique_.dimension(); ++i) names.push_back(fmt::format("u{}", i));
  if (scene_->shared().aperture) names.insert(names.end(), {"aperture0", "aperture1"});
  if (scene_->shared().time) names.emplace_back("time");
  for (int i = 0; i < technique_.choices(); ++i) names.push_back(fmt::format("choice{}", i));
  return names;
}

PrimarySample PrimarySpace::sample(const double* row) const {
  PrimarySample sample;
  const int own = technique_.dimension();
  for (int i = 0; i < own; ++i) sample.u[at(i)] = toUnitInterval(row[i]);
  float shared[kMostShared];
  for (int i = 0; i < scene_->shared().count(); ++i) shared[i] = toUnitInterval(row[own + i]);
  setShared(scene_->shared(), shared, sample);
  for (int i = 0; i < technique_.choices(); ++i)
    sample.choice[at(i)] = toUnitInterval(row[dimension() + i]);
  return sample;
}

void PrimarySpace::setRow(const PrimarySample& sample, double* row) const {
  std::copy_n(sample.u.begin(), technique_.dimension(), row);
  getShared(scene_->shared(), sample, row + technique_.dimension());
  std::copy_n(sample.choice.begin(), technique_.choices(), row + dimension());
}

void PrimarySpace::check(const Doubles& x) const {
  if (x.ndim() != 2 || x.shape(1) != columns())
    throw UserError(fmt::format("expected an array of shape (n, {}): coordinates of s={} t={}",
                                columns(), technique_.s, technique_.t));
  for (py::ssize_t i = 0; i < x.size(); ++i)
    if (const double value = x.data()[i]; !(value >= 0 && value < 1))
      throw UserError(fmt::format("row {}: {} is {:g}, expected a number in [0, 1)", i / columns(),
                                  names()[at(i % columns())], value));
}

}  // namespace h2mc::python
