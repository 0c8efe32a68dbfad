// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/error/flip.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/units.h"
#include "core/vec.h"

namespace greatx::sim {

namespace {

using glm::dmat3;

/// Matrix from linear Rec. 709 to XYZ, and the white point, XYZ of (1, 1, 1).
const dmat3 xyz_from_rgb = glm::transpose(dmat3(dvec3(10135552.0, 8788810.0, 4435075.0) / 24577794.0,
                                                dvec3(2613072.0, 8788810.0, 887015.0) / 12288897.0,
                                                dvec3(1425312.0, 8788810.0, 70074185.0) / 73733382.0));
const dvec3 white = xyz_from_rgb * dvec3(1.0);

struct Plane {
  int64_t height = 0, width = 0;
  std::vector<dvec3> pixels;
};

double linear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

/// Returns a colour in the opponent space YCxCz of section 4.1.1. The space is linear in light, and contrast
/// sensitivities were measured in it.
dvec3 ycxcz_from_rgb(const dvec3& rgb) {
  const dvec3 n = (xyz_from_rgb * rgb) / white;
  return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}
dvec3 rgb_from_ycxcz(const dvec3& c) {
  const double y = (c.x + 16.0) / 116.0;
  static const dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
  return rgb_from_xyz * (dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white);
}

/// Returns CIE 1976 L*a*b*, with a* and b* scaled by lightness (Hunt's effect, section 4.1.2).
dvec3 hunt_lab(const dvec3& rgb) {
  const auto f = [](double t) {
    constexpr double d = 6.0 / 29.0;
    return t > d * d * d ? std::cbrt(t) : t / (3.0 * d * d) + 4.0 / 29.0;
  };
  const dvec3 n = (xyz_from_rgb * rgb) / white;
  const double l = 116.0 * f(n.y) - 16.0;
  return {l, 0.01 * l * 500.0 * (f(n.x) - f(n.y)), 0.01 * l * 200.0 * (f(n.y) - f(n.z))};
}
double hyab(const dvec3& a, const dvec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

Plane ycxcz(const Array& picture) {
  GREATX_CHECK(picture.dtype == DType::u8 && picture.shape.size() == 3 && picture.shape[2] == 3,
               "not u8 [h, w, 3]");
  static const std::vector<double> linear_of = [] {
    std::vector<double> table;
    for (int byte = 0; byte < 256; ++byte) table.push_back(linear(byte / 255.0));
    return table;
  }();
  Plane plane{picture.shape[0], picture.shape[1], {}};
  const std::span<const uint8_t> bytes = picture.as<uint8_t>();
  plane.pixels.reserve(bytes.size() / 3);
  for (size_t i = 0; i < bytes.size(); i += 3)
    plane.pixels.push_back(
        ycxcz_from_rgb({linear_of[bytes[i]], linear_of[bytes[i + 1]], linear_of[bytes[i + 2]]}));
  return plane;
}

/// Numbers of one channel, [h, w].
struct Channel {
  int64_t height = 0, width = 0;
  std::vector<double> values;
};

/// Holds the weights at the offsets -radius..radius in one direction. All filters of FLIP are products of one
/// along each axis, or sums of such products.
using Taps = std::vector<double>;
Taps taps_of(int64_t radius, const std::function<double(double)>& weight) {
  Taps taps;
  for (int64_t x = -radius; x <= radius; ++x) taps.push_back(weight(static_cast<double>(x)));
  return taps;
}
double sum_of(const Taps& taps) { return std::accumulate(taps.begin(), taps.end(), 0.0); }

/// Filters along the rows, and hands the result over transposed, so that two calls filter along both axes.
/// The pixels at the border continue outside the picture.
Channel filtered_along(const Channel& in, const Taps& taps) {
  const auto radius = static_cast<int64_t>(taps.size() / 2);
  Channel out{in.width, in.height, std::vector<double>(in.values.size())};
  std::vector<double> row(static_cast<size_t>(in.width + 2 * radius));
  std::vector<double> sums(static_cast<size_t>(in.width));
  for (int64_t y = 0; y < in.height; ++y) {
    const double* const source = in.values.data() + y * in.width;
    for (int64_t x = 0; x < in.width + 2 * radius; ++x)
      row[static_cast<size_t>(x)] = source[std::clamp<int64_t>(x - radius, 0, in.width - 1)];
    std::ranges::fill(sums, 0.0);
    for (size_t t = 0; t < taps.size(); ++t) {
      const double weight = taps[t], *const shifted = row.data() + t;
      for (size_t x = 0; x < sums.size(); ++x) sums[x] += weight * shifted[x];
    }
    for (int64_t x = 0; x < in.width; ++x)
      out.values[static_cast<size_t>(x * in.height + y)] = sums[static_cast<size_t>(x)];
  }
  return out;
}
Channel filtered(const Channel& in, const Taps& along_x, const Taps& along_y) {
  return filtered_along(filtered_along(in, along_x), along_y);
}

Channel channel_of(const Plane& plane, int c) {
  Channel channel{plane.height, plane.width, {}};
  channel.values.reserve(plane.pixels.size());
  for (const dvec3& pixel : plane.pixels) channel.values.push_back(pixel[c]);
  return channel;
}

/// Applies the filter of contrast sensitivity, sums of Gaussians (table 1), to the achromatic, red-green and
/// blue-yellow channels.
Plane contrast_filtered(const Plane& plane, double ppd) {
  struct Gaussian {
    double a, b;
  };
  static const std::vector<Gaussian> channels[3] = {
      {{1.0, 0.0047}}, {{1.0, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}};
  const auto radius = static_cast<int64_t>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd));
  Plane out = plane;
  for (int c = 0; c < 3; ++c) {
    const Channel in = channel_of(plane, c);
    std::vector<double> sum(plane.pixels.size(), 0.0);
    double total = 0.0;
    for (const Gaussian& g : channels[c]) {
      const Taps taps =
          taps_of(radius, [&](double x) { return std::exp(-pi * pi * x * x / (ppd * ppd * g.b)); });
      const double scale = g.a * std::sqrt(pi / g.b);
      const Channel part = filtered(in, taps, taps);
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += scale * part.values[i];
      total += scale * sum_of(taps) * sum_of(taps);
    }
    for (size_t i = 0; i < sum.size(); ++i) out.pixels[i][c] = sum[i] / total;
  }
  return out;
}

/// The first derivative (edges) or the second one (points) of a Gaussian with the width of an edge response
/// (section 4.2): `along` one axis, and smoothed `across` it. Of the product, the positive weights sum to 1,
/// the negative ones to -1.
struct Detector {
  Taps along, across;
  Detector(double ppd, bool points) {
    const double sd = 0.5 * 0.082 * ppd;
    const auto radius = static_cast<int64_t>(std::ceil(3.0 * sd));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sd * sd)); };
    across = taps_of(radius, gaussian);
    along = taps_of(radius, [&](double x) { return (points ? x * x / (sd * sd) - 1.0 : -x) * gaussian(x); });
    double positive = 0.0, negative = 0.0;
    for (const double w : along) (w > 0.0 ? positive : negative) += std::abs(w) * sum_of(across);
    for (double& w : along) w /= w > 0.0 ? positive : negative;
  }
};

/// Returns the strength of the feature at each pixel.
std::vector<double> feature_strength(const Plane& plane, const Detector& detector) {
  Channel lightness = channel_of(plane, 0);
  for (double& value : lightness.values) value = (value + 16.0) / 116.0;
  const Channel x = filtered(lightness, detector.along, detector.across),
                y = filtered(lightness, detector.across, detector.along);
  std::vector<double> strength(x.values.size());
  for (size_t i = 0; i < strength.size(); ++i)
    strength[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  return strength;
}

constexpr double color_exponent = 0.7, feature_exponent = 0.5;

/// Returns the colour error of section 4.1.3. Differences of up to 40 % of the largest possible difference
/// fill 95 % of the range.
double color_error(const dvec3& reference, const dvec3& test) {
  static const double largest =
      std::pow(hyab(hunt_lab({0.0, 1.0, 0.0}), hunt_lab({0.0, 0.0, 1.0})), color_exponent);
  constexpr double pc = 0.4, pt = 0.95;
  const double knee = pc * largest, d = std::pow(hyab(reference, test), color_exponent);
  return d < knee ? pt / knee * d : pt + (d - knee) / (largest - knee) * (1.0 - pt);
}

/// Returns the picture as an observer at that distance perceives it, in CIELAB.
Plane perceived(const Plane& plane, double ppd) {
  Plane lab = contrast_filtered(plane, ppd);
  for (dvec3& pixel : lab.pixels) pixel = hunt_lab(glm::clamp(rgb_from_ycxcz(pixel), 0.0, 1.0));
  return lab;
}

}  // namespace

Flip flip(const Array& reference, const Array& test, double pixels_per_degree) {
  GREATX_CHECK(reference.shape == test.shape, "pictures of different shapes");
  const Plane a = ycxcz(reference), b = ycxcz(test);
  const Plane lab_a = perceived(a, pixels_per_degree), lab_b = perceived(b, pixels_per_degree);
  std::vector<double> feature_error(a.pixels.size());
  for (const bool points : {false, true}) {
    const Detector detector(pixels_per_degree, points);
    const std::vector<double> in_a = feature_strength(a, detector), in_b = feature_strength(b, detector);
    for (size_t i = 0; i < in_a.size(); ++i)
      feature_error[i] = std::max(feature_error[i], std::abs(in_a[i] - in_b[i]));
  }
  Flip result;
  for (size_t i = 0; i < feature_error.size(); ++i) {
    const double feature = std::pow(feature_error[i] / std::sqrt(2.0), feature_exponent);
    const double error = std::pow(color_error(lab_a.pixels[i], lab_b.pixels[i]), 1.0 - feature);
    result.error.push_back(static_cast<float>(error));
    result.mean += error / static_cast<double>(feature_error.size());
  }
  return result;
}

}  // namespace greatx::sim
