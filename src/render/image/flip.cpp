// SPDX-License-Identifier: MIT
#include "render/image/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/core/index.h"

namespace h2mc {
namespace {

constexpr double kPi = std::numbers::pi;

// One channel of a picture.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> v;
  Plane() = default;
  Plane(int w, int h) : width(w), height(h), v(static_cast<std::size_t>(w) * h) {}
};
using Planes = std::array<Plane, 3>;
using Triple = std::array<double, 3>;

// --- Colour spaces --------------------------------------------------------------------------------

// Rec. 709 primaries with the white point D65; the rows of RGB -> XYZ add up to the white.
constexpr double kToXyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                 {0.2126729, 0.7151522, 0.0721750},
                                 {0.0193339, 0.1191920, 0.9503041}};
constexpr double white(int i) { return kToXyz[i][0] + kToXyz[i][1] + kToXyz[i][2]; }

Triple relativeXyz(const Triple& rgb) {
  Triple xyz;
  for (int i = 0; i < 3; ++i)
    xyz[i] = (kToXyz[i][0] * rgb[0] + kToXyz[i][1] * rgb[1] + kToXyz[i][2] * rgb[2]) / white(i);
  return xyz;
}

// The inverse of relativeXyz, by Cramer's rule.
Triple rgbOf(const Triple& xyz) {
  const auto& m = kToXyz;
  const Triple b{xyz[0] * white(0), xyz[1] * white(1), xyz[2] * white(2)};
  const auto cofactor = [&](int r, int c) {
    const int r0 = (r + 1) % 3, r1 = (r + 2) % 3, c0 = (c + 1) % 3, c1 = (c + 2) % 3;
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
  };
  const double determinant =
      m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Triple rgb;
  for (int i = 0; i < 3; ++i)
    rgb[i] = (cofactor(0, i) * b[0] + cofactor(1, i) * b[1] + cofactor(2, i) * b[2]) / determinant;
  return rgb;
}

// A linear version of CIELAB, for the filters: luminance and two opponent colours [2020, section 4.1].
Triple yCxCz(const Triple& xyz) {
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Triple xyzOf(const Triple& ycc) {
  const double y = (ycc[0] + 16) / 116;
  return {y + ycc[1] / 500, y, y - ycc[2] / 200};
}

// CIELAB with the Hunt effect: chroma counts less where it is dark [2020, section 4.1].
Triple huntLab(const Triple& xyz) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double fx = f(xyz[0]), fy = f(xyz[1]), fz = f(xyz[2]);
  const double l = 116 * fy - 16;
  return {l, 0.01 * l * 500 * (fx - fy), 0.01 * l * 200 * (fy - fz)};
}

// Distance in that space, for large differences [Abasi et al. 2020].
template <class Lab>
double hyab(const Lab& a, const Lab& b) {
  const double p = a[1] - b[1], q = a[2] - b[2];
  return std::abs(static_cast<double>(a[0]) - b[0]) + std::sqrt(p * p + q * q);
}

// --- Filters --------------------------------------------------------------------------------------

// Odd number of weights, the centre in the middle.
using Kernel = std::vector<float>;

Kernel gaussian(double sigma, int radius) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i)
    kernel.push_back(static_cast<float>(std::exp(-i * i / (2 * sigma * sigma))));
  return kernel;
}

void scale(Kernel& kernel, double factor) {
  for (float& w : kernel) w *= static_cast<float>(factor);
}

double sum(const Kernel& kernel) {
  double total = 0;
  for (const float w : kernel) total += w;
  return total;
}

// The picture goes on beyond its border as it is at the border.
Plane convolved(const Plane& in, const Kernel& alongX, const Kernel& alongY) {
  const int w = in.width, h = in.height;
  const int rx = static_cast<int>(alongX.size()) / 2, ry = static_cast<int>(alongY.size()) / 2;
  Plane rows(w, h), out(w, h);
  std::vector<float> padded(static_cast<std::size_t>(w) + 2 * rx);
  for (int y = 0; y < h; ++y) {
    const float* row = &in.v[at(y) * w];
    for (int x = -rx; x < w + rx; ++x) padded[x + rx] = row[std::clamp(x, 0, w - 1)];
    float* to = &rows.v[at(y) * w];
    for (int k = 0; k <= 2 * rx; ++k)
      for (int x = 0; x < w; ++x) to[x] += alongX[k] * padded[x + k];
  }
  for (int y = 0; y < h; ++y) {
    float* to = &out.v[at(y) * w];
    for (int k = -ry; k <= ry; ++k) {
      const float* from = &rows.v[at(std::clamp(y + k, 0, h - 1)) * w];
      for (int x = 0; x < w; ++x) to[x] += alongY[k + ry] * from[x];
    }
  }
  return out;
}

// Contrast sensitivity: a sum of Gaussians in the distance in degrees, sum of
// a sqrt(pi / b) exp(-pi^2 d^2 / b), normalised [2020, table 1].
struct Sensitivity {
  double a[2], b[2];
};
constexpr Sensitivity kSensitivity[3] = {
    {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};

// The colours that the eye blends into each other at this distance.
Planes blurred(const Planes& in, double pixelsPerDegree) {
  constexpr double kWidest = 0.04;  // of all b
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixelsPerDegree));
  Planes out = in;
  for (int c = 0; c < 3; ++c) {
    std::vector<Kernel> kernels;
    std::vector<double> weights;
    double total = 0;
    for (int term = 0; term < 2; ++term) {
      const double a = kSensitivity[c].a[term], b = kSensitivity[c].b[term];
      if (a == 0) continue;
      kernels.push_back(gaussian(std::sqrt(b / 2) / kPi * pixelsPerDegree, radius));
      weights.push_back(a * std::sqrt(kPi / b));
      total += weights.back() * sum(kernels.back()) * sum(kernels.back());
    }
    std::fill(out[c].v.begin(), out[c].v.end(), 0.f);
    for (std::size_t term = 0; term < kernels.size(); ++term) {
      Kernel alongX = kernels[term];
      scale(alongX, weights[term] / total);
      const Plane part = convolved(in[c], alongX, kernels[term]);
      for (std::size_t i = 0; i < part.v.size(); ++i) out[c].v[i] += part.v[i];
    }
  }
  return out;
}

// Strength of edges and of points: first and second derivatives of a Gaussian as wide as an edge
// that is seen, positive and negative weights normalised to 1 each [2020, section 4.2].
Plane featureStrength(const Plane& luminance, double pixelsPerDegree, bool points) {
  constexpr double kEdgeDegrees = 0.082;
  const double sigma = 0.5 * kEdgeDegrees * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  Kernel blur = gaussian(sigma, radius), derivative = blur;
  scale(blur, 1 / sum(blur));
  double positive = 0, negative = 0;
  for (int i = -radius; i <= radius; ++i) {
    float& w = derivative[i + radius];
    w *= static_cast<float>(points ? i * i / (sigma * sigma) - 1 : -i);
    (w > 0 ? positive : negative) += std::abs(w);
  }
  for (float& w : derivative) w /= static_cast<float>(w > 0 ? positive : negative);
  Plane across = convolved(luminance, derivative, blur);
  const Plane along = convolved(luminance, blur, derivative);
  for (std::size_t i = 0; i < across.v.size(); ++i)
    across.v[i] = std::hypot(across.v[i], along.v[i]);
  return across;
}

// --- FLIP -----------------------------------------------------------------------------------------

// What one of the two pictures brings along.
struct Seen {
  std::vector<std::array<float, 3>> lab;
  Plane edges, points;
};

Seen see(const Image& image, double pixelsPerDegree) {
  const int w = image.width, h = image.height;
  Planes opponent{Plane(w, h), Plane(w, h), Plane(w, h)};
  Plane luminance(w, h);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgbf& p = image.pixels[i];
    const auto shown = [](float v) { return std::clamp(static_cast<double>(v), 0.0, 1.0); };
    const Triple ycc = yCxCz(relativeXyz({shown(p.x), shown(p.y), shown(p.z)}));
    for (int c = 0; c < 3; ++c) opponent[c].v[i] = static_cast<float>(ycc[c]);
    luminance.v[i] = static_cast<float>((ycc[0] + 16) / 116);
  }
  const Planes smooth = blurred(opponent, pixelsPerDegree);
  Seen seen{std::vector<std::array<float, 3>>(image.pixels.size()),
            featureStrength(luminance, pixelsPerDegree, false),
            featureStrength(luminance, pixelsPerDegree, true)};
  for (std::size_t i = 0; i < seen.lab.size(); ++i) {
    Triple rgb = rgbOf(xyzOf({smooth[0].v[i], smooth[1].v[i], smooth[2].v[i]}));
    for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
    const Triple lab = huntLab(relativeXyz(rgb));
    for (int c = 0; c < 3; ++c) seen.lab[i][c] = static_cast<float>(lab[c]);
  }
  return seen;
}

// The colour difference in [0, 1]: small differences get most of the range.
double colorDifference(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  constexpr double kExponent = 0.7, kKnee = 0.4, kKneeValue = 0.95;
  static const double largest =
      std::pow(hyab(huntLab(relativeXyz({0, 1, 0})), huntLab(relativeXyz({0, 0, 1}))), kExponent);
  const double e = std::pow(hyab(a, b), kExponent), knee = kKnee * largest;
  if (e < knee) return kKneeValue * e / knee;
  return std::min(1.0, kKneeValue + (1 - kKneeValue) * (e - knee) / (largest - knee));
}

// Each pixel's FLIP.
std::vector<float> difference(const Seen& a, const Seen& r) {
  std::vector<float> result(a.lab.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double color = colorDifference(a.lab[i], r.lab[i]);
    const double feature =
        std::max(std::abs(a.edges.v[i] - r.edges.v[i]), std::abs(a.points.v[i] - r.points.v[i]));
    // An edge or a point that is in one picture only makes a difference of colour count more.
    const double strength = std::min(1.0, std::sqrt(feature / std::numbers::sqrt2));
    result[i] = static_cast<float>(std::pow(color, 1 - strength));
  }
  return result;
}

bool finite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(), [](const Rgbf& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

// --- Exposures ------------------------------------------------------------------------------------

// The fit of the ACES curve: (p0 x^2 + p1 x + p2) / (q0 x^2 + q1 x + q2), its exposure of 0.6 included.
struct ToneCurve {
  double p[3] = {0.36 * 2.51, 0.6 * 0.03, 0};
  double q[3] = {0.36 * 2.43, 0.6 * 0.59, 0.14};
  double operator()(double x) const {
    return ((p[0] * x + p[1]) * x + p[2]) / ((q[0] * x + q[1]) * x + q[2]);
  }
  // The positive x that is mapped to t.
  double inverse(double t) const {
    const double a = p[0] - t * q[0], b = p[1] - t * q[1], c = p[2] - t * q[2];
    const double root = std::sqrt(b * b - 4 * a * c);
    return std::max((-b + root) / (2 * a), (-b - root) / (2 * a));
  }
};

Image toneMapped(const Image& image, double stops) {
  const ToneCurve curve;
  const double factor = std::exp2(stops);
  Image result = image;
  for (Rgbf& p : result.pixels)
    for (float* v : {&p.x, &p.y, &p.z})
      *v = static_cast<float>(
          std::clamp(curve(factor * std::max(static_cast<double>(*v), 0.0)), 0.0, 1.0));
  return result;
}

}  // namespace

struct HdrFlip::Views {
  FlipExposures exposures;
  std::vector<Seen> reference;  // one an exposure
};

std::vector<float> flip(const Image& image, const Image& reference, double pixelsPerDegree) {
  assert(image.width == reference.width && image.height == reference.height);
  return difference(see(image, pixelsPerDegree), see(reference, pixelsPerDegree));
}

FlipExposures flipExposures(const Image& reference) {
  std::vector<double> luminances;
  luminances.reserve(reference.pixels.size());
  for (const Rgbf& p : reference.pixels)
    luminances.push_back(
        std::max(0.0, kToXyz[1][0] * p.x + kToXyz[1][1] * p.y + kToXyz[1][2] * p.z));
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = *middle;
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  FlipExposures exposures;
  if (!(brightest > 0)) return exposures;  // a black picture looks the same at any exposure
  constexpr double kShown = 0.85,
                   kDarkest = 1e-5;  // the latter of the brightest, where half is black
  const double x = ToneCurve().inverse(kShown);
  exposures.start = std::log2(x / brightest);
  exposures.stop = std::log2(x / std::max(median, kDarkest * brightest));
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

HdrFlip::HdrFlip(const Image& reference) {
  if (!finite(reference)) return;
  views_ = std::make_unique<Views>();
  views_->exposures = flipExposures(reference);
  const std::size_t count = static_cast<std::size_t>(views_->exposures.count);
  views_->reference.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    views_->reference[i] =
        see(toneMapped(reference, views_->exposures.at(static_cast<int>(i))), kFlipPixelsPerDegree);
  });
}

HdrFlip::~HdrFlip() = default;

double HdrFlip::operator()(const Image& image) const {
  if (!views_ || !finite(image)) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t count = views_->reference.size();
  std::vector<std::vector<float>> differences(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const double stops = views_->exposures.at(static_cast<int>(i));
    differences[i] =
        difference(see(toneMapped(image, stops), kFlipPixelsPerDegree), views_->reference[i]);
  });
  double total = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    float largest = 0;
    for (const std::vector<float>& d : differences) largest = std::max(largest, d[i]);
    total += largest;
  }
  return total / static_cast<double>(image.pixels.size());
}

}  // namespace h2mc
