// SPDX-License-Identifier: MIT
#include "inspect/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/embed.h"
#include "inspect/canvas.h"
#include "inspect/film_preview.h"
#include "render/image/color_encoding.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

constexpr Canvas::Color kBackground = 0xffffff, kInk = 0x1d1f22, kDim = 0x62666d, kLine = 0xb9bcc2,
                        kAccepted = 0x35e6c8, kRejected = 0xffffff, kShadow = 0x101014,
                        kDarkCell = 0x6c6f75, kDarkStripe = 0x5b5e64, kOutside = 0xc9ccd1,
                        kBorder = 0xffffff, kGaussian = 0x8fd0ff;
// From a ten-thousandth of the brightest to the brightest.
constexpr Canvas::Color kRamp[] = {0x0f1030, 0x41217a, 0x92307f, 0xdb4f62, 0xfb9b5c, 0xfdf3c0};
constexpr double kDecades = 4;

constexpr int kLeft = 92, kRight = 22, kTop = 34, kBottom = 50, kHeader = 64, kFooter = 96;
constexpr int kPlot = 270;  // edge of a plot, about

Canvas::Color mixed(Canvas::Color a, Canvas::Color b, double t) {
  Canvas::Color result = 0;
  for (const int shift : {16, 8, 0}) {
    const double x = a >> shift & 255, y = b >> shift & 255;
    result |= static_cast<Canvas::Color>(std::lround(x + (y - x) * t)) << shift;
  }
  return result;
}

Canvas::Color colorOf(const Rgbf& linear) {
  Canvas::Color result = 0;
  for (int c = 0; c < 3; ++c)
    result = result << 8 | static_cast<Canvas::Color>(
                               std::lround(255 * linearToSrgb(std::clamp(linear[c], 0.f, 1.f))));
  return result;
}

Canvas::Color rampColor(double t) {
  constexpr int kLast = static_cast<int>(std::size(kRamp)) - 1;
  const double position = std::clamp(t, 0.0, 1.0) * kLast;
  const int k = std::min(static_cast<int>(position), kLast - 1);
  return mixed(kRamp[k], kRamp[k + 1], position - k);
}

// The round number nearest below: 1, 2 or 5 times a power of ten.
double roundBelow(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  return power * (x >= 5 * power ? 5 : x >= 2 * power ? 2 : 1);
}

class Picture {
 public:
  Picture(const Scene& scene, const Inspection& inspection, const InspectedPair& pair,
          const Slice& slice)
      : scene_(scene),
        inspection_(inspection),
        pair_(pair),
        slice_(slice),
        cell_(std::max(1, (kPlot + slice.resolution / 2) / slice.resolution)),
        plot_(cell_ * slice.resolution),
        columns_(3),
        rows_((2 + static_cast<int>(inspection.kinds.size()) + columns_ - 1) / columns_),
        canvas_(columns_ * (kLeft + plot_ + kRight),
                kHeader + rows_ * (kTop + plot_ + kBottom) + kFooter, kBackground) {
    // The quadratic is drawn on the target's scale.
    for (const float v : slice.logRatio) brightest_ = std::max(brightest_, double(v));
    brightest_ /= std::log(10.0);
  }

  Image draw() {
    canvas_.text(
        kLeft, 14,
        fmt::format("pixel {},{}: s={} t={}, {} edges, {} coordinates", inspection_.pixelX,
                    inspection_.pixelY, inspection_.path.technique.s, inspection_.path.technique.t,
                    inspection_.path.technique.length(), inspection_.path.dimension()),
        kInk);
    canvas_.text(kLeft, 36,
                 fmt::format("the plane of {} and {}, all else as it is at the path (+)",
                             pair_.x.name, pair_.y.name),
                 kDim);
    place(0);
    drawTarget(1);
    axes("target");
    place(1);
    drawQuadratic();
    axes("quadratic approximation");
    for (std::size_t k = 0; k < inspection_.kinds.size(); ++k) {
      place(2 + static_cast<int>(k));
      const ProposalKind& kind = inspection_.kinds[k];
      const std::string title = fmt::format("{} {:.0f} %", kind.name, 100 * kind.acceptance);
      if (kind.name == "large") {
        drawFilm(kind);
        canvas_.text(left_, top_ - 22, title + ", on the film", kInk);
      } else {
        drawTarget(0.6);
        drawProposals(kind);
        axes(title);
      }
    }
    footer();
    return canvas_.image();
  }

 private:
  void place(int index) {
    left_ = index % columns_ * (kLeft + plot_ + kRight) + kLeft;
    top_ = kHeader + index / columns_ * (kTop + plot_ + kBottom) + kTop;
  }

  double px(double x) const { return left_ + plot_ * (0.5 + 0.5 * x / slice_.halfX); }
  double py(double y) const { return top_ + plot_ * (0.5 - 0.5 * y / slice_.halfY); }
  double unit(double logRatio) const {
    return 1 + (logRatio / std::log(10.0) - brightest_) / kDecades;
  }

  void fill(int column, int row, Canvas::Color color, double strength) {
    canvas_.rectangle(left_ + column * cell_, top_ + row * cell_, cell_, cell_,
                      mixed(kShadow, color, strength));
  }

  void drawTarget(double strength) {
    const int n = slice_.resolution;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const std::size_t at = slice_.index(column, row);
        Canvas::Color color = rampColor(unit(slice_.logRatio[at]));
        if (slice_.cells[at] == SliceCell::kDark)
          color = (column + row) / 3 % 2 ? kDarkCell : kDarkStripe;
        else if (slice_.cells[at] == SliceCell::kOutside)
          color = kOutside;
        fill(column, row, color, strength);
      }
    // Where the topology changes.
    const auto kind = [&](int column, int row) { return slice_.cells[slice_.index(column, row)]; };
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const auto border = [&](SliceCell other) {
          const SliceCell own = kind(column, row);
          if (own == other || own == SliceCell::kDark || other == SliceCell::kDark ||
              own == SliceCell::kOutside || other == SliceCell::kOutside)
            return 0.0;
          return own == SliceCell::kOtherTopology || other == SliceCell::kOtherTopology ? 0.8
                                                                                        : 0.25;
        };
        const int x = left_ + column * cell_, y = top_ + row * cell_;
        if (column + 1 < n)
          canvas_.rectangle(x + cell_ - 1, y, 1, cell_, kBorder,
                            strength * border(kind(column + 1, row)));
        if (row + 1 < n)
          canvas_.rectangle(x, y + cell_ - 1, cell_, 1, kBorder,
                            strength * border(kind(column, row + 1)));
      }
  }

  void drawQuadratic() {
    if (!inspection_.model.available) {
      canvas_.rectangle(left_, top_, plot_, plot_, kOutside);
      canvas_.text(left_ + 8, top_ + 8, "not available", kInk);
      return;
    }
    std::vector<double> offset(pair_.x.vector.size());
    for (int row = 0; row < slice_.resolution; ++row)
      for (int column = 0; column < slice_.resolution; ++column) {
        for (std::size_t i = 0; i < offset.size(); ++i)
          offset[i] = slice_.x(column) * pair_.x.vector[i] + slice_.y(row) * pair_.y.vector[i];
        fill(column, row, rampColor(unit(inspection_.model.logRatio(offset))), 1);
      }
    drawGaussian();
  }

  // The ellipses of one and two standard deviations of the Hamiltonian Gaussian's projection.
  void drawGaussian() {
    const LocalModel& model = inspection_.model;
    if (!model.available) return;
    double xx = 0, xy = 0, yy = 0;
    for (const EigenDirection& e : model.eigen) {
      const double a = dotProduct(e.vector, pair_.x.vector) * e.deviation;
      const double b = dotProduct(e.vector, pair_.y.vector) * e.deviation;
      xx += a * a;
      xy += a * b;
      yy += b * b;
    }
    // Its Cholesky factor maps the circle.
    const double lx = std::sqrt(xx), ly = lx > 0 ? xy / lx : 0;
    const double rest = std::sqrt(std::max(yy - ly * ly, 0.0));
    const double meanX = model.driftAlong(pair_.x.vector), meanY = model.driftAlong(pair_.y.vector);
    canvas_.clip(left_, top_, plot_, plot_);
    constexpr int kSegments = 96;
    for (const double radius : {1.0, 2.0})
      for (int k = 0; k < kSegments; ++k) {
        const auto point = [&](int i, double& x, double& y) {
          const double angle = 2 * double(kPi) * i / kSegments;
          const double c = radius * std::cos(angle), s = radius * std::sin(angle);
          x = px(meanX + lx * c);
          y = py(meanY + ly * c + rest * s);
        };
        double x0, y0, x1, y1;
        point(k, x0, y0);
        point(k + 1, x1, y1);
        canvas_.line(x0, y0, x1, y1, 1.4, kGaussian, 0.9);
      }
    canvas_.clip();
  }

  void accepted(double x, double y) {
    canvas_.dot(x, y, 3.6, kShadow, 0.7);
    canvas_.dot(x, y, 2.6, kAccepted);
  }
  void rejected(double x, double y) {
    for (const auto& [thickness, color] : {std::pair{2.8, kShadow}, std::pair{1.2, kRejected}}) {
      canvas_.line(x - 2.5, y - 2.5, x + 2.5, y + 2.5, thickness, color, 0.7);
      canvas_.line(x - 2.5, y + 2.5, x + 2.5, y - 2.5, thickness, color, 0.7);
    }
  }
  void cross(double x, double y) {
    for (const auto& [thickness, color] : {std::pair{4.0, kShadow}, std::pair{1.8, kRejected}}) {
      canvas_.line(x - 7, y, x + 7, y, thickness, color);
      canvas_.line(x, y - 7, x, y + 7, thickness, color);
    }
  }

  void drawProposals(const ProposalKind& kind) {
    if (kind.name == "hamiltonian") drawGaussian();
    int beyond = 0, lost = 0;
    canvas_.clip(left_, top_, plot_, plot_);
    for (const bool wanted : {false, true})
      for (const InspectedProposal& p : kind.proposals) {
        if (p.accepted != wanted) continue;
        if (p.offset.empty()) {
          ++lost;
          continue;
        }
        const std::vector<double> offset(p.offset.begin(), p.offset.end());
        const double x = dotProduct(offset, pair_.x.vector), y = dotProduct(offset, pair_.y.vector);
        beyond += std::abs(x) > slice_.halfX || std::abs(y) > slice_.halfY;
        if (wanted)
          accepted(px(x), py(y));
        else
          rejected(px(x), py(y));
      }
    canvas_.clip();
    if (beyond > 0) label(fmt::format("{} beyond", beyond), 0);
    if (lost > 0) label(fmt::format("{} outside", lost), 1);
  }

  // In the lower left corner of the plot, lines counted from below.
  void label(const std::string& text, int line) {
    const int y = top_ + plot_ - 22 - 20 * line;
    canvas_.rectangle(left_ + 4, y - 3, Canvas::textWidth(text) + 8, Canvas::kTextHeight + 6,
                      kShadow, 0.6);
    canvas_.text(left_ + 8, y, text, kRejected);
  }

  void drawFilm(const ProposalKind& kind) {
    const double aspect = static_cast<double>(scene_.film.width) / scene_.film.height;
    const int width = static_cast<int>(std::lround(plot_ * std::min(1.0, aspect)));
    const int height = static_cast<int>(std::lround(plot_ * std::min(1.0, 1 / aspect)));
    const Image& film = inspection_.film;
    const float white = whiteScale(film, kNoisy);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Rgbf& p = film.at(x * film.width / width, y * film.height / height);
        canvas_.pixel(left_ + x, top_ + y, mixed(kShadow, colorOf(p * white), 0.6));
      }
    canvas_.clip(left_, top_, width, height);
    int lost = 0;
    for (const bool wanted : {false, true})
      for (const InspectedProposal& p : kind.proposals) {
        if (p.accepted != wanted) continue;
        if (p.filmX < 0) {
          ++lost;
          continue;
        }
        const double x = left_ + width * double(p.filmX), y = top_ + height * double(p.filmY);
        if (wanted)
          accepted(x, y);
        else
          rejected(x, y);
      }
    cross(left_ + width * double(inspection_.path.filmX),
          top_ + height * double(inspection_.path.filmY));
    canvas_.clip();
    canvas_.frame(left_ - 1, top_ - 1, width + 2, height + 2, kLine);
    if (lost > 0)
      canvas_.text(left_, top_ + height + 10, fmt::format("{} found nothing", lost), kDim);
  }

  void axes(const std::string& title) {
    canvas_.clip(left_, top_, plot_, plot_);
    cross(px(0), py(0));
    canvas_.clip();
    canvas_.frame(left_ - 1, top_ - 1, plot_ + 2, plot_ + 2, kLine);
    canvas_.text(left_, top_ - 22, title, kInk);
    const double stepX = roundBelow(slice_.halfX * 0.8), stepY = roundBelow(slice_.halfY * 0.8);
    for (const int k : {-1, 0, 1}) {
      const std::string x = fmt::format("{:.3g}", k * stepX), y = fmt::format("{:.3g}", k * stepY);
      canvas_.rectangle(static_cast<int>(px(k * stepX)), top_ + plot_ + 1, 1, 5, kDim);
      canvas_.text(static_cast<int>(px(k * stepX)) - Canvas::textWidth(x) / 2, top_ + plot_ + 9, x,
                   kDim);
      canvas_.rectangle(left_ - 6, static_cast<int>(py(k * stepY)), 5, 1, kDim);
      canvas_.text(left_ - 10 - Canvas::textWidth(y), static_cast<int>(py(k * stepY)) - 7, y, kDim);
    }
    canvas_.text(left_ + plot_ - Canvas::textWidth(pair_.x.name), top_ + plot_ + 27, pair_.x.name,
                 kInk);
    canvas_.text(left_ - 10 - Canvas::textWidth(pair_.y.name), top_, pair_.y.name, kInk);
  }

  void footer() {
    const int y = canvas_.image().height - kFooter + 10;
    constexpr int kBar = 300;
    for (int i = 0; i < kBar; ++i)
      canvas_.rectangle(kLeft + i, y, 1, 14, rampColor((i + 0.5) / kBar));
    canvas_.frame(kLeft - 1, y - 1, kBar + 2, 16, kLine);
    for (int k = 0; k <= static_cast<int>(kDecades); k += 2) {
      const std::string text = fmt::format("{:.2g}", std::pow(10, brightest_ - kDecades + k));
      const int x = kLeft + kBar * k / static_cast<int>(kDecades);
      canvas_.text(x - Canvas::textWidth(text) / 2, y + 20, text, kDim);
    }
    canvas_.text(kLeft, y + 44, "target / target at the path", kInk);

    int x = kLeft + kBar + 60;
    const auto entry = [&](const char* text) {
      canvas_.text(x + 18, y, text, kInk);
      x += 18 + Canvas::textWidth(text) + 30;
    };
    accepted(x + 6, y + 7);
    entry("accepted");
    canvas_.rectangle(x - 2, y - 1, 16, 16, kDarkCell);
    rejected(x + 6, y + 7);
    entry("rejected");
    canvas_.line(x, y + 7, x + 13, y + 7, 3, kGaussian);
    entry("Gaussian, 1 and 2 deviations");
    x = kLeft + kBar + 60;
    canvas_.rectangle(x - 2, y + 25, 16, 16, kDarkCell);
    canvas_.text(x + 18, y + 26, "no light", kInk);
    x += 18 + Canvas::textWidth("no light") + 30;
    canvas_.rectangle(x - 2, y + 25, 16, 16, kOutside);
    canvas_.text(x + 18, y + 26, "outside", kInk);
    x += 18 + Canvas::textWidth("outside") + 42;
    canvas_.rectangle(x - 2, y + 25, 16, 16, 0x92307f);
    canvas_.rectangle(x + 5, y + 25, 2, 16, kBorder);
    canvas_.text(x + 18, y + 26, "other topology begins", kInk);
    canvas_.text(kLeft + kBar + 58, y + 52, "%: mean acceptance", kInk);
  }

  const Scene& scene_;
  const Inspection& inspection_;
  const InspectedPair& pair_;
  const Slice& slice_;
  int cell_, plot_, columns_, rows_;
  Canvas canvas_;
  double brightest_ = 0;  // decades above the path's target
  int left_ = 0, top_ = 0;
};

}  // namespace

Image drawPair(const Scene& scene, const Inspection& inspection, const InspectedPair& pair,
               const Slice& slice) {
  return Picture(scene, inspection, pair, slice).draw();
}

}  // namespace h2mc
