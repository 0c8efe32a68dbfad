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
Complex root(const Complex& z) {
  const double real = std::sqrt(0.5 * (std::sqrt(std::norm(z)) + z.real()));
  return {real, 0.5 * z.imag() / real};
}
DualComplex root(const DualComplex& z) {
  const Complex value = root(z.value());
  return z.mapped(value, 0.5 / value);
}

DualComplex plain_product(const DualComplex& a, const DualComplex& b) { return a * b; }
using rf::plain_product;

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
template <typename R>
class Line {
 public:
  using C = ComplexOf<R>;
  using V = Vec3Of<R>;

  Line(const UnfoldedRayOf<R>& ray, const EdgePieceOf<R>& piece, const R& wave_number)
      : ray_(ray), piece_(piece), k_(wave_number), length_(ray.length_m()) {
    using std::abs, std::sqrt;
    const R along = dot(ray.direction, piece.along);
    const V across = ray.direction - along * piece.along;
    origin_ = dot(piece.start, piece.along);
    const V offset = piece.start - origin_ * piece.along;  // of the line from the ray's point
    const V from_s = ray.before_m * across + offset, to_r = ray.after_m * across - offset;
    d_s_ = length(from_s), d_r_ = length(to_r);
    z_s_ = -ray.before_m * along - origin_, z_r_ = ray.after_m * along - origin_;
    least_ = (z_s_ * d_r_ + z_r_ * d_s_) / (d_s_ + d_r_);
    triple_ = length_ * abs(dot(piece.along, cross(ray.direction, offset)));
    h_ = z_r_ - z_s_;
    shortest_ = sqrt(h_ * h_ + (d_s_ + d_r_) * (d_s_ + d_r_));
    root_b_ = sqrt(h_ * h_ + (d_s_ - d_r_) * (d_s_ - d_r_));
    least_excess_ = excess(least_);
  }

  R least() const { return least_; }

  R excess(const R& t) const { return at(t).excess; }

  /// Returns 2 pi E of [t_1, t_2].
  C wave(double from, double to) const {
    if (from >= to) return 0.0;
    if (least_ <= from) return monotone(from - least_, to - least_, 1.0);
    if (least_ >= to) return monotone(least_ - to, least_ - from, -1.0);
    return monotone(R(0.0), to - least_, 1.0) + monotone(R(0.0), least_ - from, -1.0);
  }

 private:
  struct At {
    R excess;           ///< L - D
    R squares;          ///< L^2 - D^2
    R product;          ///< r s
    R other;            ///< D^2 - (r - s)^2
    R nearest_squared;  ///< of S and R, squared
  };

  V place(const R& t) const { return piece_.start + t * piece_.along; }

  At at(const R& t) const {
    using std::sqrt;
    const V point = place(t);
    const V r = ray_.before_m * ray_.direction + point, s = ray_.after_m * ray_.direction - point;
    const R rr = dot(r, r), ss = dot(s, s), rs = sqrt(rr * ss), inner = dot(r, s);
    // L^2 - D^2 = 2 (r s - r . s), and D^2 - (r - s)^2 = 2 (r s + r . s); their product is 4 |r x s|^2.
    const V turn = cross(ray_.direction, point);
    const R area = length_ * length_ * dot(turn, turn);
    const R squares = inner > 0.0 ? 2.0 * area / (rs + inner) : 2.0 * (rs - inner);
    const R other = inner > 0.0 ? 2.0 * (rs + inner) : 2.0 * area / (rs - inner);
    const R excess = squares / (sqrt(rr) + sqrt(ss) + length_);
    return {excess, squares, rs, other, std::min(rr, ss)};
  }

  /// `u`: distance from the least place, to the side of `sign`, ascending; L grows with it.
  C monotone(const R& from, const R& to, double sign) const {
    const bool endless = std::isinf(value_of(to));
    const R first = excess(least_ + sign * from);
    const R last = endless ? to : excess(least_ + sign * to);
    if (!endless && (k_ * last <= far_phase || k_ * (last - first) <= short_phase))
      return direct(from, to, sign);
    const C beyond = endless ? C(0.0) : turned(last - least_excess_);
    if (k_ * first >= far_phase) return turned(from == 0.0 ? R(0.0) : first - least_excess_) - beyond;
    const R far = far_phase / k_;
    const R middle = std::clamp(distance_at(length_ + far, sign), from, to);
    return direct(from, middle, sign) + turned(far - least_excess_) - beyond;
  }

  /// Returns u where r + s = `sum` on the side of `sign`, from the quadratic equation of the place.
  R distance_at(const R& sum, double sign) const {
    using std::sqrt;
    const R squared = sum * sum, q = 0.5 * (d_s_ - d_r_) * (d_s_ + d_r_);
    const R root =
        sqrt(std::max(R(0.0), R((sum - shortest_) * (sum + shortest_))) * (sum - root_b_) * (sum + root_b_)) /
        (2.0 * sum);
    const R y = (q * h_ / squared + sign * root) / ((sum - h_) * (sum + h_) / squared);
    return std::max(R(0.0), R(sign * (y + 0.5 * (z_s_ + z_r_) - least_)));
  }

  C direct(const R& from, const R& to, double sign) const {
    if (from >= to) return 0.0;
    const R a = least_ + sign * from, b = least_ + sign * to;
    const bool near = k_ * excess(a) < panel_phase;
    C sum = near ? C(angle(a, b)) : C(0.0);
    if (triple_ > 0.0) add_panels(std::min(a, b), std::max(a, b), near, 0, sum);
    return sum;
  }

  /// Returns the angle about the ray between two places, in [0, pi].
  R angle(const R& a, const R& b) const {
    using std::abs, std::atan2;
    const V p = place(a), q = place(b);
    const R across = abs(dot(ray_.direction, cross(p, q)));
    return atan2(across, R(dot(p, q) - dot(p, ray_.direction) * dot(q, ray_.direction)));
  }

  /// Halves [a, b] until the phase changes little in each panel and the ends are not near, and adds the
  /// panels.
  void add_panels(const R& a, const R& b, bool near, int depth, C& sum) const {
    using std::abs;
    static const Rule<10> rule = gauss_legendre<10>();
    const R middle = 0.5 * (a + b);
    const At center = at(middle);
    const R change = k_ * std::max(R(abs(excess(a) - center.excess)), R(abs(excess(b) - center.excess)));
    const R width = b - a;
    if (depth < 40 && (change > panel_phase || width * width > center.nearest_squared)) {
      add_panels(a, middle, near, depth + 1, sum);
      add_panels(middle, b, near, depth + 1, sum);
      return;
    }
    C panel = 0.0;
    for (size_t i = 0; i < rule.node.size(); ++i) {
      const At place = at(a + width * rule.node[i]);
      panel += rule.weight[i] / place.product * (near ? smooth_kernel(place) : kernel(place));
    }
    sum += width * length_ * triple_ * panel;
  }

  C kernel(const At& place) const {
    using std::cos, std::sin;
    const R phase = k_ * place.excess;
    return C(cos(phase), -sin(phase)) / place.squares;
  }

  /// The kernel without its pole: (e^{-jx} - 1) is -2 sin^2(x/2) - j sin x.
  C smooth_kernel(const At& place) const {
    using std::sin;
    const R phase = k_ * place.excess, half = sin(0.5 * phase);
    if (place.squares <= 0.0) return {-1.0 / place.other, -0.5 * k_ / length_};
    return {-2.0 * half * half / place.squares - 1.0 / place.other, -sin(phase) / place.squares};
  }

  /// Returns the part of the half line beyond the place where L - L* = `squared`.
  C turned(const R& squared) const {
    using std::cos, std::exp, std::norm, std::sin, std::sqrt;
    static const Rule<16> rule = gauss_legendre<16>();
    const R zeta = sqrt(std::max(R(0.0), squared)), root_k = sqrt(k_);
    // zeta + e^{-j pi/4} x / sqrt(k): the exponent is -x^2 - 2 x sqrt(k) zeta e^{j pi/4}.
    const R linear = std::sqrt(2.0) * root_k * zeta;
    const R reach = 72.0 / (linear + sqrt(linear * linear + 144.0));  // x^2 + linear x = 36
    const R above_b = 4.0 * d_s_ * d_r_ / (shortest_ + root_b_);      // L* - B
    const Complex turn(std::sqrt(0.5), -std::sqrt(0.5));
    C sum = 0.0;
    for (size_t i = 0; i < rule.node.size(); ++i) {
      const R x = reach * rule.node[i], side = x * std::sqrt(0.5) / root_k;
      // (zeta + e^{-j pi/4} x)^2
      const C more(zeta * (zeta + 2.0 * side), -2.0 * side * (zeta + side)), total = shortest_ + more;
      const C roots = root(plain_product(total + shortest_, total + root_b_));
      const C below = plain_product(plain_product(least_excess_ + more, total + length_),
                                    plain_product(roots, root(above_b + more)));
      const R swing = linear * x, decay = exp(-x * x - swing);
      // conj(below) / |below|^2 = 1 / below
      sum += rule.weight[i] * decay / norm(below) * plain_product(C(cos(swing), -sin(swing)), conj(below));
    }
    const R phase = k_ * (least_excess_ + zeta * zeta);
    return plain_product(4.0 * length_ * triple_ * reach / root_k * turn,
                         plain_product(C(cos(phase), -sin(phase)), sum));
  }

  const UnfoldedRayOf<R>& ray_;
  const EdgePieceOf<R>& piece_;
  R k_, length_;  ///< D
  R origin_ = 0.0;
  R d_s_ = 0.0, d_r_ = 0.0, z_s_ = 0.0, z_r_ = 0.0, h_ = 0.0;
  R least_ = 0.0, least_excess_ = 0.0;  ///< place of L*, and L* - D
  R shortest_ = 0.0, root_b_ = 0.0;     ///< L*, B
  R triple_ = 0.0;                      ///< |T|
};

}  // namespace

template <typename Real>
ComplexOf<Real> boundary_wave(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece,
                              const Given<Real>& wave_number) {
  return Line<Real>(ray, piece, wave_number).wave(piece.from, piece.to) / (2.0 * pi);
}

template <typename Real>
Real keller_place(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece) {
  return Line<Real>(ray, piece, 0.0).least();
}

template <typename Real>
Real excess_m(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece,
              const Given<Real>& t) {
  return Line<Real>(ray, piece, 0.0).excess(t);
}

// The templates of this file, for doubles and for dual numbers.
#define GREATX_FOR(Real)                                                                             \
  template ComplexOf<Real> boundary_wave<Real>(const UnfoldedRayOf<Real>&, const EdgePieceOf<Real>&, \
                                               const Real&);                                         \
  template Real keller_place<Real>(const UnfoldedRayOf<Real>&, const EdgePieceOf<Real>&);            \
  template Real excess_m<Real>(const UnfoldedRayOf<Real>&, const EdgePieceOf<Real>&, const Real&);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
