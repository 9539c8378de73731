// SPDX-License-Identifier: MIT
#include "mcmc/tours/film_blocks.h"

#include <nlohmann/json.hpp>

#include "mcmc/populations/landed.h"
#include "render/core/archive.h"

namespace h2mc {
namespace {

FilmSettings blockFilm() {
  FilmSettings settings;
  settings.width = BlockMoments::kColumns;
  settings.height = BlockMoments::kRows;
  return unfiltered(settings);
}

}  // namespace

BlockMoments::BlockMoments() : blocks_(at(kColumns * kRows)), film_(blockFilm()) {}

void BlockMoments::add(SplatList& splats, double scale) {
  film_.clear();
  splats.sort(film_, 1);
  splats.addBand(0, 0, film_);
  double sum = 0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double value = luminance(film_.pixel(x, y, scale));
      blocks_[at(y * kColumns + x)].add(value);
      sum += value;
    }
  whole_.add(sum / (kColumns * kRows));
}

void BlockMoments::add(const BlockMoments& other) {
  for (std::size_t k = 0; k < blocks_.size(); ++k) blocks_[k].add(other.blocks_[k]);
  whole_.add(other.whole_);
}

void BlockMoments::archive(Archive& archive) {
  archive(blocks_, whole_);
  if (blocks_.size() != at(kColumns * kRows)) throw ArchiveError("it has another number of blocks");
}

nlohmann::json BlockMoments::json(double unit) const {
  nlohmann::json means = nlohmann::json::array(), errors = nlohmann::json::array();
  for (const Moments& block : blocks_) {
    means.push_back(block.mean() * unit);
    errors.push_back(block.standardError() * unit);
  }
  return {{"columns", kColumns},
          {"rows", kRows},
          {"estimates", whole_.count},
          {"mean luminance", means},
          {"standard error", errors}};
}

}  // namespace h2mc
