// SPDX-License-Identifier: MIT
#include "compare/strip_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/image/color_encoding.h"
#include "render/image/tone_mapping.h"

namespace h2mc {
namespace {

constexpr double kWidth = 506, kGap = 3, kTextSize = 7;
constexpr double kTop = 11, kBelow = 21;  // names above, two lines below
constexpr FigureColor kFrames[] = {{0.91, 0.31, 0.04}, {0.05, 0.55, 0.75}, {0.2, 0.6, 0.2}};
constexpr FigureColor kText{0.1, 0.1, 0.1};

std::vector<FigurePoint> corners(const FigureBox& b) {
  return {{b.x, b.y}, {b.x + b.width, b.y}, {b.x + b.width, b.y + b.height}, {b.x, b.y + b.height}};
}

FigurePicture picture(const FigureBox& box, const Image& linear, const PixelRectangle& part) {
  FigurePicture result{box, part.width, part.height, {}};
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x)
      for (int c = 0; c < 3; ++c)
        result.srgb.push_back(static_cast<std::uint8_t>(
            255 * linearToSrgb(std::clamp(linear.at(x, y)[c], 0.f, 1.f)) + 0.5f));
  return result;
}

struct Column {
  std::string name, first, second;
  const Image* image;
};

}  // namespace

Figure stripFigure(const SceneResults& scene, const ComparisonPlan& plan, const Image& reference,
                   const std::vector<Image>& images, const std::vector<PixelRectangle>& insets) {
  const std::string& metric = comparedMetrics().front();
  const Summary& summary = mainSummaries(scene, plan).front();
  // All by the reference's exposure.
  const ToneMapping look{autoExposure(reference), ToneCurve::kSrgb};
  const Image shown = toneMapped(reference, look);
  std::vector<Image> developed;
  developed.reserve(images.size());
  std::vector<Column> columns;
  for (std::size_t m = 0; m < images.size(); ++m) {
    const Point* point = shownPoint(scene.runs.methods[m], summary.position, summary.timed);
    if (images[m].pixels.empty() || !point) continue;
    developed.push_back(toneMapped(images[m], look));
    columns.push_back({scene.runs.methods[m].name,
                       fmt::format("{} {:.3g}", metric, point->errors.at(metric)),
                       fmt::format("{:.3g} s", point->seconds), &developed.back()});
  }
  columns.push_back({"reference", "", "", &shown});

  // The whole picture is as high as the insets of a column.
  const auto count = static_cast<double>(columns.size()), rows = static_cast<double>(insets.size());
  const double aspect = static_cast<double>(reference.width) / reference.height;
  const double tall = static_cast<double>(insets[0].height) / insets[0].width;
  const double column =
      (kWidth - count * kGap - (rows - 1) * kGap * aspect) / (count + rows * tall * aspect);
  const double cell = tall * column, height = rows * cell + (rows - 1) * kGap;
  Figure figure{kWidth, kTop + height + kBelow, {}};

  const FigureBox whole{0, kTop, height * aspect, height};
  figure.shapes.push_back(picture(whole, shown, {0, 0, reference.width, reference.height}));
  const double scale = whole.width / reference.width;
  for (std::size_t i = 0; i < insets.size(); ++i)
    figure.shapes.push_back(FigureLine{corners({insets[i].x * scale, kTop + insets[i].y * scale,
                                                insets[i].width * scale, insets[i].height * scale}),
                                       kFrames[i % std::size(kFrames)], 1, false, true});
  figure.shapes.push_back(FigureText{{0, kTop - 4},
                                     scene.runs.scene.name,
                                     kTextSize,
                                     FigureText::Anchor::kStart,
                                     true,
                                     false,
                                     kText});

  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& own = columns[k];
    const double x = whole.width + kGap + static_cast<double>(k) * (column + kGap);
    const auto text = [&](double y, const std::string& words, bool bold) {
      figure.shapes.push_back(FigureText{{x + column / 2, y},
                                         fitted(words, kTextSize, column),
                                         kTextSize,
                                         FigureText::Anchor::kMiddle,
                                         bold,
                                         false,
                                         kText});
    };
    text(kTop - 4, own.name, true);
    for (std::size_t i = 0; i < insets.size(); ++i) {
      const FigureBox box{x, kTop + static_cast<double>(i) * (cell + kGap), column, cell};
      figure.shapes.push_back(picture(box, *own.image, insets[i]));
      figure.shapes.push_back(
          FigureLine{corners({box.x + 0.5, box.y + 0.5, box.width - 1, box.height - 1}),
                     kFrames[i % std::size(kFrames)], 1, false, true});
    }
    text(kTop + height + 8, own.first, false);
    text(kTop + height + 17, own.second, false);
  }
  return figure;
}

}  // namespace h2mc
