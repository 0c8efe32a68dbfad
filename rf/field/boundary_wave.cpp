// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/field/boundary_wave.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/phase.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// k (L - D) from which on the turned path is used. The integrand's singularities are then at least
/// sqrt(far_phase / 2) = 2.8 from the path, in units of the width of its Gaussian.
constexpr double far_phase = 16.0;
/// A piece along which the phase changes by less than this is integrated as it is, wherever it lies: the
/// difference of two turned paths would lose the digits of a short piece.
constexpr double short_phase = 12.0;
/// Largest change of the phase from the middle of a panel of the quadrature to its ends.
constexpr double panel_phase = 4.0;

/// The square root with a positive real part, for numbers that are not near the negative real axis.
Complex root(Complex z) {
  const double real = std::sqrt(0.5 * (std::sqrt(std::norm(z)) + z.real()));
  return {real, 0.5 * z.imag() / real};
}

template <int count>
struct Rule {
  std::array<double, count> node, weight;  ///< on [0, 1]
};

/// Gauss-Legendre, by Newton's method from Tricomi's estimate.
template <int count>
Rule<count> gauss_legendre() {
  Rule<count> rule{};
  for (int i = 0; i < count; ++i) {
    double x = std::cos(pi * (i + 0.75) / (count + 0.5)), slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double before = 1.0, value = x;
      for (int n = 2; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value;
        value = next;
      }
      slope = count * (x * value - before) / (x * x - 1.0);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    rule.node[i] = 0.5 * (1.0 - x);
    rule.weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

/// Describes how the ray sees the line of an edge.
class Line {
 public:
  Line(const UnfoldedRay& ray, const EdgePiece& piece, double wave_number)
      : ray_(ray), piece_(piece), k_(wave_number), length_(ray.length_m()) {
    const double along = glm::dot(ray.direction, piece.along);
    const dvec3 across = ray.direction - along * piece.along;
    origin_ = glm::dot(piece.start, piece.along);
    const dvec3 offset = piece.start - origin_ * piece.along;  // of the line from the ray's point
    const dvec3 from_s = ray.before_m * across + offset, to_r = ray.after_m * across - offset;
    d_s_ = glm::length(from_s), d_r_ = glm::length(to_r);
    z_s_ = -ray.before_m * along - origin_, z_r_ = ray.after_m * along - origin_;
    least_ = (z_s_ * d_r_ + z_r_ * d_s_) / (d_s_ + d_r_);
    triple_ = length_ * std::abs(glm::dot(piece.along, glm::cross(ray.direction, offset)));
    h_ = z_r_ - z_s_;
    shortest_ = std::sqrt(h_ * h_ + (d_s_ + d_r_) * (d_s_ + d_r_));
    root_b_ = std::sqrt(h_ * h_ + (d_s_ - d_r_) * (d_s_ - d_r_));
    least_excess_ = excess(least_);
  }

  double least() const { return least_; }

  double excess(double t) const { return at(t).excess; }

  /// Returns 2 pi E of [t_1, t_2].
  Complex wave(double from, double to) const {
    if (from >= to) return 0.0;
    if (least_ <= from) return monotone(from - least_, to - least_, 1.0);
    if (least_ >= to) return monotone(least_ - to, least_ - from, -1.0);
    return monotone(0.0, to - least_, 1.0) + monotone(0.0, least_ - from, -1.0);
  }

 private:
  struct At {
    double excess;           ///< L - D
    double squares;          ///< L^2 - D^2
    double product;          ///< r s
    double other;            ///< D^2 - (r - s)^2
    double nearest_squared;  ///< of S and R, squared
  };

  dvec3 place(double t) const { return piece_.start + t * piece_.along; }

  At at(double t) const {
    const dvec3 point = place(t);
    const dvec3 r = ray_.before_m * ray_.direction + point, s = ray_.after_m * ray_.direction - point;
    const double rr = glm::dot(r, r), ss = glm::dot(s, s), rs = std::sqrt(rr * ss), inner = glm::dot(r, s);
    // L^2 - D^2 = 2 (r s - r . s), and D^2 - (r - s)^2 = 2 (r s + r . s); their product is 4 |r x s|^2.
    const dvec3 turn = glm::cross(ray_.direction, point);
    const double area = length_ * length_ * glm::dot(turn, turn);
    const double squares = inner > 0.0 ? 2.0 * area / (rs + inner) : 2.0 * (rs - inner);
    const double other = inner > 0.0 ? 2.0 * (rs + inner) : 2.0 * area / (rs - inner);
    const double excess = squares / (std::sqrt(rr) + std::sqrt(ss) + length_);
    return {excess, squares, rs, other, std::min(rr, ss)};
  }

  /// `u`: distance from the least place, to the side of `sign`, ascending; L grows with it.
  Complex monotone(double from, double to, double sign) const {
    const bool endless = std::isinf(to);
    const double first = excess(least_ + sign * from);
    const double last = endless ? to : excess(least_ + sign * to);
    if (!endless && (k_ * last <= far_phase || k_ * (last - first) <= short_phase))
      return direct(from, to, sign);
    const Complex beyond = endless ? Complex(0.0) : turned(last - least_excess_);
    if (k_ * first >= far_phase) return turned(from == 0.0 ? 0.0 : first - least_excess_) - beyond;
    const double far = far_phase / k_;
    const double middle = std::clamp(distance_at(length_ + far, sign), from, to);
    return direct(from, middle, sign) + turned(far - least_excess_) - beyond;
  }

  /// Returns u where r + s = `sum` on the side of `sign`, from the quadratic equation of the place.
  double distance_at(double sum, double sign) const {
    const double squared = sum * sum, q = 0.5 * (d_s_ - d_r_) * (d_s_ + d_r_);
    const double root =
        std::sqrt(std::max(0.0, (sum - shortest_) * (sum + shortest_)) * (sum - root_b_) * (sum + root_b_)) /
        (2.0 * sum);
    const double y = (q * h_ / squared + sign * root) / ((sum - h_) * (sum + h_) / squared);
    return std::max(0.0, sign * (y + 0.5 * (z_s_ + z_r_) - least_));
  }

  Complex direct(double from, double to, double sign) const {
    if (from >= to) return 0.0;
    const double a = least_ + sign * from, b = least_ + sign * to;
    const bool near = k_ * excess(a) < panel_phase;
    Complex sum = near ? Complex(angle(a, b)) : Complex(0.0);
    if (triple_ > 0.0) add_panels(std::min(a, b), std::max(a, b), near, 0, sum);
    return sum;
  }

  /// Returns the angle about the ray between two places, in [0, pi].
  double angle(double a, double b) const {
    const dvec3 p = place(a), q = place(b);
    const double across = std::abs(glm::dot(ray_.direction, glm::cross(p, q)));
    return std::atan2(across, glm::dot(p, q) - glm::dot(p, ray_.direction) * glm::dot(q, ray_.direction));
  }

  /// Halves [a, b] until the phase changes little in each panel and the ends are not near, and adds the
  /// panels.
  void add_panels(double a, double b, bool near, int depth, Complex& sum) const {
    static const Rule<10> rule = gauss_legendre<10>();
    const double middle = 0.5 * (a + b);
    const At center = at(middle);
    const double change =
        k_ * std::max(std::abs(excess(a) - center.excess), std::abs(excess(b) - center.excess));
    const double width = b - a;
    if (depth < 40 && (change > panel_phase || width * width > center.nearest_squared)) {
      add_panels(a, middle, near, depth + 1, sum);
      add_panels(middle, b, near, depth + 1, sum);
      return;
    }
    Complex panel = 0.0;
    for (size_t i = 0; i < rule.node.size(); ++i) {
      const At place = at(a + width * rule.node[i]);
      panel += rule.weight[i] / place.product * (near ? smooth_kernel(place) : kernel(place));
    }
    sum += width * length_ * triple_ * panel;
  }

  Complex kernel(const At& place) const {
    const double phase = k_ * place.excess;
    return Complex(std::cos(phase), -std::sin(phase)) / place.squares;
  }

  /// The kernel without its pole: (e^{-jx} - 1) is -2 sin^2(x/2) - j sin x.
  Complex smooth_kernel(const At& place) const {
    const double phase = k_ * place.excess, half = std::sin(0.5 * phase);
    if (place.squares <= 0.0) return {-1.0 / place.other, -0.5 * k_ / length_};
    return {-2.0 * half * half / place.squares - 1.0 / place.other, -std::sin(phase) / place.squares};
  }

  /// Returns the part of the half line beyond the place where L - L* = `squared`.
  Complex turned(double squared) const {
    static const Rule<16> rule = gauss_legendre<16>();
    const double zeta = std::sqrt(std::max(0.0, squared)), root_k = std::sqrt(k_);
    // zeta + e^{-j pi/4} x / sqrt(k): the exponent is -x^2 - 2 x sqrt(k) zeta e^{j pi/4}.
    const double linear = std::sqrt(2.0) * root_k * zeta;
    const double reach = 72.0 / (linear + std::sqrt(linear * linear + 144.0));  // x^2 + linear x = 36
    const double above_b = 4.0 * d_s_ * d_r_ / (shortest_ + root_b_);           // L* - B
    const Complex turn(std::sqrt(0.5), -std::sqrt(0.5));
    Complex sum = 0.0;
    for (size_t i = 0; i < rule.node.size(); ++i) {
      const double x = reach * rule.node[i], side = x * std::sqrt(0.5) / root_k;
      // (zeta + e^{-j pi/4} x)^2
      const Complex more(zeta * (zeta + 2.0 * side), -2.0 * side * (zeta + side)), total = shortest_ + more;
      const Complex roots = root(plain_product(total + shortest_, total + root_b_));
      const Complex below = plain_product(plain_product(least_excess_ + more, total + length_),
                                          plain_product(roots, root(above_b + more)));
      const double swing = linear * x, decay = std::exp(-x * x - swing);
      // conj(below) / |below|^2 = 1 / below
      sum += rule.weight[i] * decay / std::norm(below) *
             plain_product(Complex(std::cos(swing), -std::sin(swing)), std::conj(below));
    }
    const double phase = k_ * (least_excess_ + zeta * zeta);
    return plain_product(4.0 * length_ * triple_ * reach / root_k * turn,
                         plain_product(Complex(std::cos(phase), -std::sin(phase)), sum));
  }

  const UnfoldedRay& ray_;
  const EdgePiece& piece_;
  double k_, length_;  ///< D
  double origin_ = 0.0;
  double d_s_ = 0.0, d_r_ = 0.0, z_s_ = 0.0, z_r_ = 0.0, h_ = 0.0;
  double least_ = 0.0, least_excess_ = 0.0;  ///< place of L*, and L* - D
  double shortest_ = 0.0, root_b_ = 0.0;     ///< L*, B
  double triple_ = 0.0;                      ///< |T|
};

}  // namespace

Complex boundary_wave(const UnfoldedRay& ray, const EdgePiece& piece, double wave_number) {
  return Line(ray, piece, wave_number).wave(piece.from, piece.to) / (2.0 * pi);
}

double keller_place(const UnfoldedRay& ray, const EdgePiece& piece) { return Line(ray, piece, 0.0).least(); }

double excess_m(const UnfoldedRay& ray, const EdgePiece& piece, double t) {
  return Line(ray, piece, 0.0).excess(t);
}

}  // namespace greatx::rf
