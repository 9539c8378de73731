// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_rule.h"

#include <cmath>

namespace h2mc {
namespace {

class EnergyRedistribution final : public TourRule {
 public:
  EnergyRedistribution(double energy, long long length) : energy_(energy), length_(length) {}
  long long toursAt(double target, Random& random) const override {
    return static_cast<long long>(std::floor(target / energy_ + random.uniformDouble()));
  }
  bool goesOn(long long made, double, Random&) const override { return made < length_; }
  double level() const override { return 0; }
  double weight() const override { return energy_ / static_cast<double>(length_); }

 private:
  double energy_;
  long long length_;
};

class Regeneration final : public TourRule {
 public:
  explicit Regeneration(double level) : level_(level) {}
  long long toursAt(double, Random&) const override { return 1; }
  bool goesOn(long long, double target, Random& random) const override {
    return random.uniformDouble() * (target + level_) < target;
  }
  double level() const override { return level_; }
  double weight() const override { return level_; }

 private:
  double level_;
};

}  // namespace

std::unique_ptr<TourRule> energyRedistribution(double meanTarget, double chainsASample,
                                               long long length) {
  return std::make_unique<EnergyRedistribution>(meanTarget / chainsASample, length);
}

std::unique_ptr<TourRule> regeneration(double meanTarget, double length) {
  return std::make_unique<Regeneration>(meanTarget / length);
}

}  // namespace h2mc
