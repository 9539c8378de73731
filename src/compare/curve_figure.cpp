// SPDX-License-Identifier: MIT
#include "compare/curve_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace h2mc {
namespace {

constexpr double kWidth = 241, kHeight = 180;  // the column of two that papers have
constexpr FigureBox kFrame{42, 8, kWidth - 42 - 6, kHeight - 8 - 30};
constexpr FigureColor kGrid{0.88, 0.89, 0.91}, kFrameColor{0.5, 0.5, 0.52}, kText{0.1, 0.1, 0.1};
constexpr double kTextSize = 7.5;

// One axis of logarithms.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = 0;

  void include(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void widen() {
    const double margin = std::max(0.07 * std::log(high / low), 0.06);
    low *= std::exp(-margin);
    high *= std::exp(margin);
  }
  // In [0, 1] within the range.
  double at(double v) const { return std::log(v / low) / std::log(high / low); }
  // 1, 2, 5 times powers of ten; fewer where there are many.
  std::vector<double> ticks() const {
    const double decades = std::log10(high / low);
    const std::vector<double> steps = decades > 3     ? std::vector<double>{1}
                                      : decades > 1.3 ? std::vector<double>{1, 3}
                                                      : std::vector<double>{1, 2, 3, 4, 5, 7};
    std::vector<double> found;
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::ceil(std::log10(high));
         ++e)
      for (const double m : steps)
        if (const double v = m * std::pow(10, e); v >= low && v <= high) found.push_back(v);
    return found;
  }
};

struct Plot {
  Axis x, y;
  FigurePoint at(double vx, double vy) const {
    const double inside = std::clamp(y.at(vy), -1.0, 2.0);  // what the clip then cuts
    return {kFrame.x + kFrame.width * x.at(vx), kFrame.y + kFrame.height * (1 - inside)};
  }
};

struct Series {
  std::size_t method;
  MethodCurve curve;
};

void addAxes(Figure& figure, const Plot& plot, const std::string& xName, const std::string& yName) {
  const double bottom = kFrame.y + kFrame.height, right = kFrame.x + kFrame.width;
  double lastLabel = -1e9;
  for (const double v : plot.x.ticks()) {
    const double x = kFrame.x + kFrame.width * plot.x.at(v);
    figure.shapes.push_back(FigureLine{{{x, kFrame.y}, {x, bottom}}, kGrid, 0.5});
    if (x - lastLabel < 22) continue;
    figure.shapes.push_back(FigureText{{x, bottom + 9},
                                       fmt::format("{:g}", v),
                                       kTextSize,
                                       FigureText::Anchor::kMiddle,
                                       false,
                                       false,
                                       kText});
    lastLabel = x;
  }
  for (const double v : plot.y.ticks()) {
    const double y = kFrame.y + kFrame.height * (1 - plot.y.at(v));
    figure.shapes.push_back(FigureLine{{{kFrame.x, y}, {right, y}}, kGrid, 0.5});
    figure.shapes.push_back(FigureText{{kFrame.x - 3, y + 2.5},
                                       fmt::format("{:g}", v),
                                       kTextSize,
                                       FigureText::Anchor::kEnd,
                                       false,
                                       false,
                                       kText});
  }
  figure.shapes.push_back(
      FigureLine{{{kFrame.x, kFrame.y}, {right, kFrame.y}, {right, bottom}, {kFrame.x, bottom}},
                 kFrameColor,
                 0.6,
                 false,
                 true});
  figure.shapes.push_back(FigureText{{kFrame.x + kFrame.width / 2, kHeight - 6},
                                     xName,
                                     kTextSize,
                                     FigureText::Anchor::kMiddle,
                                     false,
                                     false,
                                     kText});
  figure.shapes.push_back(FigureText{{8, kFrame.y + kFrame.height / 2},
                                     yName,
                                     kTextSize,
                                     FigureText::Anchor::kMiddle,
                                     false,
                                     true,
                                     kText});
}

void addCurve(Figure& figure, const Plot& plot, const Series& series) {
  FigureColor color = methodColor(series.method);
  FigureLine line{{}, color, 1.2, false, false, kFrame};
  FigureArea band{{}, color, kFrame};
  band.color.alpha = 0.15;
  std::vector<FigurePoint> back;
  for (const CurvePoint& p : series.curve) {
    line.points.push_back(plot.at(p.position, p.error.value));
    if (!(p.bandLow > 0) || !std::isfinite(p.bandHigh)) continue;
    band.points.push_back(plot.at(p.position, p.bandHigh));
    back.push_back(plot.at(p.position, p.bandLow));
  }
  band.points.insert(band.points.end(), back.rbegin(), back.rend());
  if (back.size() > 1) figure.shapes.push_back(band);
  for (const FigurePoint& p : line.points) figure.shapes.push_back(FigureDisk{p, 1.7, color});
  figure.shapes.push_back(std::move(line));
}

// In the corner that holds fewest points.
void addLegend(Figure& figure, const Plot& plot, const std::vector<Series>& all,
               const std::vector<std::string>& names) {
  double longest = 0;
  for (const std::string& name : names) longest = std::max(longest, widthOf(name, kTextSize));
  const double width = 20 + longest;
  const double height = 10 * static_cast<double>(names.size()) + 4;
  const double left = kFrame.x + 4, right = kFrame.x + kFrame.width - width - 4;
  const double top = kFrame.y + 4, bottom = kFrame.y + kFrame.height - height - 4;
  const FigurePoint corners[] = {{right, top}, {left, bottom}, {left, top}, {right, bottom}};
  const auto hits = [&](const FigurePoint& corner) {
    int count = 0;
    for (const Series& series : all)
      for (const CurvePoint& p : series.curve) {
        const FigurePoint at = plot.at(p.position, p.error.value);
        count += at.x > corner.x - 4 && at.x < corner.x + width + 4 && at.y > corner.y - 4 &&
                 at.y < corner.y + height + 4;
      }
    return count;
  };
  const FigurePoint corner = *std::min_element(
      std::begin(corners), std::end(corners),
      [&](const FigurePoint& a, const FigurePoint& b) { return hits(a) < hits(b); });
  const double x1 = corner.x + width, y1 = corner.y + height;
  const std::vector<FigurePoint> box{
      {corner.x, corner.y}, {x1, corner.y}, {x1, y1}, {corner.x, y1}};
  figure.shapes.push_back(FigureArea{box, {1, 1, 1, 0.85}});
  figure.shapes.push_back(FigureLine{box, kGrid, 0.5, false, true});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double y = corner.y + 9 + 10 * static_cast<double>(i);
    figure.shapes.push_back(FigureLine{
        {{corner.x + 4, y - 2.5}, {corner.x + 15, y - 2.5}}, methodColor(all[i].method), 1.6});
    figure.shapes.push_back(FigureText{
        {corner.x + 18, y}, names[i], kTextSize, FigureText::Anchor::kStart, false, false, kText});
  }
}

}  // namespace

FigureColor methodColor(std::size_t method) {
  // The page's, on white (page/style.css).
  constexpr std::uint32_t kColors[] = {0x0b62a8, 0xc8500a, 0x0a8363, 0xa5307d, 0x8a6a00,
                                       0x4b3fb5, 0xb3261e, 0x3d7a8c, 0x6a6a6a};
  const std::uint32_t rgb = kColors[method % std::size(kColors)];
  return {(rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0};
}

Figure curveFigure(const SceneResults& scene, bool timed) {
  const std::string& metric = comparedMetrics().front();
  Figure figure{kWidth, kHeight, {}};
  Plot plot;
  std::vector<Series> all;
  std::vector<std::string> names;
  bool samplesAlone = true;
  for (std::size_t m = 0; m < scene.runs.methods.size(); ++m) {
    const MethodRuns& method = scene.runs.methods[m];
    for (const Repeat& repeat : method.repeats)
      for (const Point& point : repeat.points) samplesAlone &= point.sampleUnit == "samples";
    Series series{m, {}};
    for (const CurvePoint& p : methodCurve(method, metric, timed))
      if (p.position > 0 && p.error.value > 0 && std::isfinite(p.error.value))
        series.curve.push_back(p);
    if (series.curve.empty()) continue;
    for (const CurvePoint& p : series.curve) {
      plot.x.include(p.position);
      plot.y.include(p.error.value);
      if (p.bandIsRange && p.bandLow > 0) {
        plot.y.include(p.bandLow);
        plot.y.include(p.bandHigh);
      }
    }
    names.push_back(fitted(method.name, kTextSize, 0.7 * kFrame.width));
    all.push_back(std::move(series));
  }
  if (all.empty()) return figure;
  plot.x.widen();
  plot.y.widen();
  addAxes(figure, plot,
          timed          ? "time in seconds"
          : samplesAlone ? "samples a pixel"
                         : "mutations (path, bdpt: samples) a pixel",
          metric);
  for (const Series& series : all) addCurve(figure, plot, series);
  addLegend(figure, plot, all, names);
  return figure;
}

}  // namespace h2mc
