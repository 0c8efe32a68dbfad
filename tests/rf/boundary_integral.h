// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves the two-dimensional field of a line source beside a rectangular block with a surface impedance by a
// boundary integral: a reference for diffraction at two edges that shares nothing with rf/edges/.
//
// With du/dn = j k D u on the boundary (D = 0: hard, infinity: soft) and G = H_0^(2)(k r)/(4 j),
//   u/2 = u_i + int u (dG/dn' - j k D G) ds'.
// Collocation with constant elements; integrals over near elements by Gauss's rule. Points inside, where the
// total field is zero, are added as equations against resonances (H. A. Schenck, "Improved integral
// formulation for acoustic radiation problems", JASA 44, 1968), and all are solved by least squares.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "core/vec.h"

namespace greatx::rf::testing {

class ImpedanceBlock {
 public:
  using Value = std::complex<double>;

  /// The block is 0 <= x <= width, -depth <= y <= 0, in wavelengths. `constant` is D, or 1/D if `by_inverse`,
  /// which suits soft surfaces.
  ImpedanceBlock(double width, double depth, bool by_inverse, Value constant, int per_wavelength = 40)
      : inverse_(by_inverse), constant_(constant) {
    const dvec2 corners[5] = {{0, -depth}, {0, 0}, {width, 0}, {width, -depth}, {0, -depth}};
    for (int side = 0; side < 4; ++side) {
      const dvec2 along = corners[side + 1] - corners[side];
      const double length = glm::length(along);
      const int count = static_cast<int>(std::ceil(length * per_wavelength));
      for (int i = 0; i < count; ++i) {
        elements_.push_back({corners[side] + (i + 0.5) / count * along, along / length,
                             dvec2(-along.y, along.x) / length, length / count});
      }
    }
    RandomStream random(7, 0);
    for (int i = 0; i < 80; ++i)
      inside_.push_back({random.uniform(0.1, 0.9) * width, -random.uniform(0.05, 0.95) * depth});
    factorize();
  }

  /// Sets the source, in wavelengths.
  void solve(const dvec2& source) {
    source_ = source;
    const size_t n = elements_.size(), rows = n + inside_.size();
    density_.assign(n, 0.0);
    for (size_t r = 0; r < rows; ++r) {
      const Value arriving = green(glm::distance(place_of(r), source));
      for (size_t i = 0; i < n; ++i) density_[i] += std::conj(rows_[r * n + i]) * arriving;
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t t = 0; t < i; ++t) density_[i] -= factor_[i * n + t] * density_[t];
      density_[i] /= factor_[i * n + i];
    }
    for (size_t i = n; i-- > 0;) {
      for (size_t t = i + 1; t < n; ++t) density_[i] -= std::conj(factor_[t * n + i]) * density_[t];
      density_[i] /= factor_[i * n + i];
    }
  }

  /// Returns the total field.
  Value field(const dvec2& at) const {
    Value sum = green(glm::distance(at, source_));
    for (size_t j = 0; j < elements_.size(); ++j) sum += kernel(at, j, false) * density_[j];
    return sum;
  }
  /// Returns the source's field in free space, of geometrical optics, after a distance.
  static Value ray(double distance) {
    return std::sqrt(2.0 / (pi * k * distance)) * std::polar(1.0, -(k * distance - 0.25 * pi)) / (4.0 * j_);
  }

 private:
  static constexpr double k = 2.0 * pi;
  static constexpr Value j_{0.0, 1.0};
  struct Element {
    dvec2 center, along, normal;
    double length;
  };
  static Value green(double r) {
    return (std::cyl_bessel_j(0.0, k * r) - j_ * std::cyl_neumann(0.0, k * r)) / (4.0 * j_);
  }
  /// int (dG/dn' - j k D G), or S dG/dn' - j k G if the density is u D = u / S.
  Value kernel(const dvec2& at, size_t index, bool own) const {
    const Element& element = elements_[index];
    const Value of_slope = inverse_ ? constant_ : Value(1.0), of_value = inverse_ ? Value(1.0) : constant_;
    if (own) {
      const double half = 0.25 * k * element.length;
      const Value mean = 1.0 - 2.0 * j_ / pi * (std::log(std::exp(0.57721566490153286) * half) - 1.0);
      return -j_ * k * of_value * element.length * mean / (4.0 * j_);
    }
    const auto at_point = [&](const dvec2& point) {
      const dvec2 from = at - point;
      const double r = glm::length(from);
      const Value slope = 0.25 * k / j_ *
                          (std::cyl_bessel_j(1.0, k * r) - j_ * std::cyl_neumann(1.0, k * r)) *
                          (glm::dot(from, element.normal) / r);
      return of_slope * slope - j_ * k * of_value * green(r);
    };
    if (glm::distance(at, element.center) > 6.0 * element.length)
      return element.length * at_point(element.center);
    static constexpr std::array<double, 4> node = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                                   0.9602898564975363},
                                           weight = {0.3626837833783620, 0.3137066458778873,
                                                     0.2223810344533745, 0.1012285362903763};
    Value sum = 0.0;
    for (size_t i = 0; i < node.size(); ++i)
      for (const double sign : {-1.0, 1.0})
        sum += 0.5 * weight[i] *
               at_point(element.center + sign * 0.5 * node[i] * element.length * element.along);
    return element.length * sum;
  }
  const dvec2& place_of(size_t row) const {
    return row < elements_.size() ? elements_[row].center : inside_[row - elements_.size()];
  }
  /// Sets up the equations and factorizes the normal equations by Cholesky's method.
  void factorize() {
    const size_t n = elements_.size(), rows = n + inside_.size();
    rows_.resize(rows * n), factor_.assign(n * n, 0.0);
    for (size_t r = 0; r < rows; ++r) {
      for (size_t i = 0; i < n; ++i) rows_[r * n + i] = -kernel(place_of(r), i, r == i);
      if (r < n) rows_[r * n + r] += 0.5 * (inverse_ ? constant_ : Value(1.0));
    }
    for (size_t r = 0; r < rows; ++r)
      for (size_t i = 0; i < n; ++i) {
        const Value left = std::conj(rows_[r * n + i]);
        for (size_t c = 0; c <= i; ++c) factor_[i * n + c] += left * rows_[r * n + c];
      }
    for (size_t i = 0; i < n; ++i)
      for (size_t c = 0; c <= i; ++c) {
        Value sum = factor_[i * n + c];
        for (size_t t = 0; t < c; ++t) sum -= factor_[i * n + t] * std::conj(factor_[c * n + t]);
        factor_[i * n + c] = c == i ? Value(std::sqrt(sum.real())) : sum / factor_[c * n + c];
      }
  }

  bool inverse_;
  Value constant_;
  std::vector<Element> elements_;
  std::vector<dvec2> inside_;
  dvec2 source_{0.0};
  std::vector<Value> rows_, factor_, density_;
};

}  // namespace greatx::rf::testing
