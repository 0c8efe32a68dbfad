// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/flip.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/units.h"
#include "core/vec.h"

namespace greatx::test {

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
  /// Returns a pixel. The pixels at the border continue outside the picture.
  const dvec3& at(int64_t y, int64_t x) const {
    return pixels[static_cast<size_t>(std::clamp<int64_t>(y, 0, height - 1) * width +
                                      std::clamp<int64_t>(x, 0, width - 1))];
  }
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
  return glm::inverse(xyz_from_rgb) * (dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white);
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
  Plane plane{picture.shape[0], picture.shape[1], {}};
  const std::span<const uint8_t> bytes = picture.as<uint8_t>();
  for (size_t i = 0; i < bytes.size(); i += 3)
    plane.pixels.push_back(ycxcz_from_rgb(
        {linear(bytes[i] / 255.0), linear(bytes[i + 1] / 255.0), linear(bytes[i + 2] / 255.0)}));
  return plane;
}

/// Holds the weights at the offsets -radius..radius in both directions, one per channel.
struct Kernel {
  int64_t radius = 0;
  std::vector<dvec3> weights;
  Kernel(int64_t r, const std::function<dvec3(double x, double y)>& weight) : radius(r) {
    for (int64_t y = -r; y <= r; ++y)
      for (int64_t x = -r; x <= r; ++x)
        weights.push_back(weight(static_cast<double>(x), static_cast<double>(y)));
  }
  Plane filter(const Plane& plane) const {
    Plane out{plane.height, plane.width, {}};
    for (int64_t y = 0; y < plane.height; ++y)
      for (int64_t x = 0; x < plane.width; ++x) {
        dvec3 sum(0.0);
        size_t i = 0;
        for (int64_t v = -radius; v <= radius; ++v)
          for (int64_t u = -radius; u <= radius; ++u) sum += weights[i++] * plane.at(y + v, x + u);
        out.pixels.push_back(sum);
      }
    return out;
  }
};

/// Returns the filter of contrast sensitivity as sums of Gaussians (table 1) for the achromatic, red-green
/// and blue-yellow channels.
Kernel contrast_sensitivity(double ppd) {
  struct Gaussians {
    double a1, b1, a2, b2;
    double at(double squared_degrees) const {
      const auto term = [&](double a, double b) {
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * squared_degrees / b);
      };
      return term(a1, b1) + term(a2, b2);
    }
  };
  constexpr Gaussians channels[3] = {
      {1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
  Kernel kernel(static_cast<int64_t>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd)),
                [&](double x, double y) {
                  const double squared = (x * x + y * y) / (ppd * ppd);
                  return dvec3(channels[0].at(squared), channels[1].at(squared), channels[2].at(squared));
                });
  dvec3 sum(0.0);
  for (const dvec3& weight : kernel.weights) sum += weight;
  for (dvec3& weight : kernel.weights) weight /= sum;
  return kernel;
}

/// Returns the first derivative (edges) or the second one (points) of a Gaussian with the width of an edge
/// response (section 4.2). The positive weights sum to 1, the negative ones to -1. The first channel
/// differentiates along x, the second one along y.
Kernel feature_detector(double ppd, bool points) {
  const double sd = 0.5 * 0.082 * ppd;
  const auto weight = [&](double along, double across) {
    const double g = std::exp(-(along * along + across * across) / (2.0 * sd * sd));
    return points ? (along * along / (sd * sd) - 1.0) * g : -along * g;
  };
  Kernel kernel(static_cast<int64_t>(std::ceil(3.0 * sd)),
                [&](double x, double y) { return dvec3(weight(x, y), weight(y, x), 0.0); });
  double positive = 0.0, negative = 0.0;
  for (const dvec3& w : kernel.weights) (w.x > 0.0 ? positive : negative) += std::abs(w.x);
  for (dvec3& w : kernel.weights)
    for (int c = 0; c < 2; ++c) w[c] /= w[c] > 0.0 ? positive : negative;
  return kernel;
}

/// Returns the strength of the feature at each pixel.
std::vector<double> feature_strength(const Plane& plane, const Kernel& detector) {
  Plane lightness = plane;
  for (dvec3& pixel : lightness.pixels) pixel = dvec3((pixel.x + 16.0) / 116.0);
  std::vector<double> strength;
  for (const dvec3& found : detector.filter(lightness).pixels)
    strength.push_back(std::hypot(found.x, found.y));
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
Plane perceived(const Plane& plane, const Kernel& filter) {
  Plane lab = filter.filter(plane);
  for (dvec3& pixel : lab.pixels) pixel = hunt_lab(glm::clamp(rgb_from_ycxcz(pixel), 0.0, 1.0));
  return lab;
}

}  // namespace

Flip flip(const Array& reference, const Array& test, double pixels_per_degree) {
  GREATX_CHECK(reference.shape == test.shape, "pictures of different shapes");
  const Plane a = ycxcz(reference), b = ycxcz(test);
  const Kernel sensitivity = contrast_sensitivity(pixels_per_degree);
  const Plane lab_a = perceived(a, sensitivity), lab_b = perceived(b, sensitivity);
  std::vector<double> feature_error(a.pixels.size());
  for (const bool points : {false, true}) {
    const Kernel detector = feature_detector(pixels_per_degree, points);
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

}  // namespace greatx::test
