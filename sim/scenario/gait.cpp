// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/gait.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::sim {
namespace {

/// A number with two derivatives by time.
struct Jet {
  double v = 0.0, d = 0.0, dd = 0.0;
};
Jet jet(double value) { return {value, 0.0, 0.0}; }
Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * a.d * b.d + a.v * b.dd};
}
Jet operator*(double k, const Jet& a) { return {k * a.v, k * a.d, k * a.dd}; }
Jet operator-(const Jet& a) { return -1.0 * a; }
/// Returns f(a), where f(a.v) = value and its derivatives are first and second.
Jet chain(const Jet& a, double value, double first, double second) {
  return {value, first * a.d, second * a.d * a.d + first * a.dd};
}
Jet inverse(const Jet& a) {
  const double i = 1.0 / a.v;
  return chain(a, i, -i * i, 2.0 * i * i * i);
}
Jet root(const Jet& a) {
  const double r = std::sqrt(a.v);
  return chain(a, r, 0.5 / r, -0.25 / (r * a.v));
}
Jet cosine(const Jet& a) { return chain(a, std::cos(a.v), -std::sin(a.v), -std::cos(a.v)); }
Jet arc_cosine(const Jet& a) {
  const double rest = 1.0 - a.v * a.v, r = std::sqrt(rest);
  return chain(a, std::acos(a.v), -1.0 / r, -a.v / (rest * r));
}
Jet arc_tangent(const Jet& a) {
  const double q = 1.0 / (1.0 + a.v * a.v);
  return chain(a, std::atan(a.v), q, -2.0 * a.v * q * q);
}
/// 6 u^5 - 15 u^4 + 10 u^3: from 0 to 1 with slope and curvature 0 at both ends.
Jet smooth_step(const Jet& a) {
  const double u = a.v;
  return chain(a, u * u * u * (u * (6.0 * u - 15.0) + 10.0), 30.0 * u * u * (u - 1.0) * (u - 1.0),
               60.0 * u * (u - 1.0) * (2.0 * u - 1.0));
}
Turned turned(const Jet& a) { return {a.v, a.d, a.dd}; }

constexpr double rest_reach = 0.998;     ///< of a leg: hip to sole when standing; a straight leg has no speed
constexpr double contact_reach = 0.995;  ///< when the sole meets the ground
constexpr double lift = 0.13;            ///< of the legs' length, by which a sole is lifted
constexpr double rise_of_leg = 0.045;    ///< of the legs' length, by which the hips rise in a step

/// The share of a cycle, in [0, 1), and the size of the steps, 0 standing to 1.
struct Phase {
  Jet cycle, size;
};

Phase phase_of(const Travel& travel, double stride_m, double start) {
  Phase phase;
  const double turns = start + travel.distance_m / stride_m;
  phase.cycle = {turns - std::floor(turns), travel.speed_mps / stride_m, travel.acceleration_mps2 / stride_m};
  const Jet share{std::abs(travel.speed_mps) / Gait::full_speed_mps,
                  std::copysign(travel.acceleration_mps2, travel.speed_mps * travel.acceleration_mps2) /
                      Gait::full_speed_mps,
                  0.0};
  phase.size = share.v >= 1.0 ? jet(1.0) : smooth_step(share);
  return phase;
}

Jet of_side(const Jet& cycle, bool left) {
  Jet result = cycle;
  if (!left) result.v = result.v < 0.5 ? result.v + 0.5 : result.v - 0.5;
  return result;
}

/// The sole's place, forward of the hips, of steps of full size. `cycle` begins when it meets the ground.
Jet full_forward(const Jet& cycle, double stride_m) {
  const double half = 0.25 * stride_m;
  if (cycle.v < 0.5) return half * (jet(1.0) - 4.0 * cycle);
  // It lifts off and lands without sliding; a curve of degree three overshoots the step the least.
  const Jet u = 2.0 * cycle - jet(1.0);
  return half * (4.0 * (u * u * (jet(3.0) - 2.0 * u)) - 2.0 * u - jet(1.0));
}

Jet full_height(const Jet& cycle, double leg_m) {
  if (cycle.v < 0.5) return jet(0.0);
  const Jet u = 2.0 * cycle - jet(1.0), bump = u * (jet(1.0) - u);
  return (16.0 * lift * leg_m) * (bump * bump);
}

/// The rise of the hips in steps of full size: they are lowest when both feet are on the ground.
Jet full_rise(const Jet& cycle, double leg_m) {
  return (0.5 * rise_of_leg * leg_m) * (jet(1.0) - cosine((4.0 * pi) * cycle));
}

/// The lowest height of the hips in steps of full size: the greatest at which both legs reach their soles.
double lowest_hips(double leg_m, double stride_m) {
  double lowest = contact_reach * leg_m;
  constexpr int phases = 512;
  for (int i = 0; i < phases; ++i) {
    const Jet cycle = jet(static_cast<double>(i) / phases);
    const double forward = full_forward(cycle, stride_m).v, reach = contact_reach * leg_m;
    const double down = std::sqrt(std::max(reach * reach - forward * forward, 0.0));
    lowest = std::min(lowest, down + full_height(cycle, leg_m).v - full_rise(cycle, leg_m).v);
  }
  return lowest;
}

Jet hips(const Jet& cycle, const Jet& size, double leg_m, double lowest_m) {
  return rest_reach * leg_m * (jet(1.0) - size) + size * (jet(lowest_m) + full_rise(cycle, leg_m));
}

/// A leg of two links, of lengths t and s, from the hip to a point that is `forward` and `down` from it.
struct LegJet {
  Jet squared;  ///< the distance between its ends
  double t, s;
  LegJet(const Jet& forward, const Jet& down, double thigh_m, double shank_m)
      : squared(forward * forward + down * down), t(thigh_m), s(shank_m) {}
  Jet bend() const { return arc_cosine((0.5 / (t * s)) * (squared - jet(t * t + s * s))); }
  Jet thigh(const Jet& forward, const Jet& down) const {
    const Jet distance = root(squared);
    const Jet line = arc_tangent(forward * inverse(down));
    const Jet knee = arc_cosine((0.5 / t) * ((squared + jet(t * t - s * s)) * inverse(distance)));
    return -(line + knee);
  }
};

Jet sine(const Jet& a) { return chain(a, std::sin(a.v), std::cos(a.v), -std::sin(a.v)); }

/// The turn of a cyclist's limb from hanging straight down, at an angle of its own crank.
Jet limb_of_cyclist(const Cyclist& who, Limb limb, const Jet& crank) {
  const Jet forward = jet(who.forward_m) + who.crank_m * cosine(crank),
            down = jet(who.down_m) + who.crank_m * sine(crank);
  const double below = who.shank_m + who.pedal_m;
  const LegJet leg(forward, down, who.thigh_m, std::hypot(below, who.ball_m));
  if (limb == Limb::thigh) return leg.thigh(forward, down);
  return leg.bend() + jet(std::atan2(who.ball_m, below));
}

}  // namespace

Gait::Gait(const Walker& walker, double start)
    : leg_m_(walker.thigh_m + walker.shank_m),
      thigh_m_(walker.thigh_m),
      shank_m_(walker.shank_m),
      stride_m_(1.346 * std::sqrt(walker.speed_mps / leg_m_) * leg_m_),
      start_(start) {
  // Longer steps than the legs can reach would lower the hips too far.
  stride_m_ = std::min(stride_m_, 1.9 * leg_m_);
  lowest_m_ = lowest_hips(leg_m_, stride_m_);
}

Turned Gait::drop(const Travel& travel) const {
  const Phase phase = phase_of(travel, stride_m_, start_);
  return turned(jet(leg_m_) - hips(phase.cycle, phase.size, leg_m_, lowest_m_));
}

Turned Gait::sole_forward(bool left, const Travel& travel) const {
  const Phase phase = phase_of(travel, stride_m_, start_);
  return turned(phase.size * full_forward(of_side(phase.cycle, left), stride_m_));
}

Turned Gait::sole_height(bool left, const Travel& travel) const {
  const Phase phase = phase_of(travel, stride_m_, start_);
  return turned(phase.size * full_height(of_side(phase.cycle, left), leg_m_));
}

Turned Gait::joint(Limb limb, bool left, const Travel& travel) const {
  const Phase phase = phase_of(travel, stride_m_, start_);
  const Jet cycle = of_side(phase.cycle, left);
  // A leg is most forward when its cycle begins; the arm of its side is then most backward.
  const Jet swing = cosine((2.0 * pi) * cycle);
  if (limb == Limb::upper_arm) return turned(0.38 * (phase.size * swing));
  if (limb == Limb::forearm) return turned(jet(-0.12) - phase.size * (jet(0.32) - 0.16 * swing));
  const Jet forward = phase.size * full_forward(cycle, stride_m_);
  const Jet down = hips(phase.cycle, phase.size, leg_m_, lowest_m_) - phase.size * full_height(cycle, leg_m_);
  const LegJet leg(forward, down, thigh_m_, shank_m_);
  return turned(limb == Limb::shank ? leg.bend() : leg.thigh(forward, down));
}

Gait::Range Gait::range(const Walker& walker, Limb limb) {
  const Gait gait(walker, 0.0);
  Range range{1e9, -1e9};
  constexpr int phases = 256, sizes = 8;
  for (int i = 0; i < phases; ++i)
    for (int k = 0; k <= sizes; ++k) {
      const Travel travel{gait.stride_m() * i / phases, full_speed_mps * k / sizes, 0.0};
      const double angle = gait.joint(limb, true, travel).value;
      range.least = std::min(range.least, angle);
      range.most = std::max(range.most, angle);
    }
  constexpr double between_samples = 0.03;
  return {range.least - between_samples, range.most + between_samples};
}

Turned Pedalling::crank(const Travel& pedalled) const {
  const double turns = start_ + pedalled.distance_m / cyclist_.development_m,
               rate = 2.0 * pi / cyclist_.development_m;
  return {std::remainder(2.0 * pi * (turns - std::floor(turns)) - cyclist_.rest, 2.0 * pi),
          rate * pedalled.speed_mps, rate * pedalled.acceleration_mps2};
}

Turned Pedalling::joint(Limb limb, bool left, const Travel& pedalled) const {
  const Turned turn = crank(pedalled);
  const double opposite = left ? 0.0 : pi, rest = cyclist_.rest + opposite;
  const Jet now{turn.value + rest, turn.rate, turn.acceleration};
  return turned(limb_of_cyclist(cyclist_, limb, now) - limb_of_cyclist(cyclist_, limb, jet(rest)));
}

Gait::Range Pedalling::range(const Cyclist& cyclist, Limb limb) {
  const double farthest = std::hypot(cyclist.forward_m, cyclist.down_m) + cyclist.crank_m,
               leg = cyclist.thigh_m + std::hypot(cyclist.shank_m + cyclist.pedal_m, cyclist.ball_m);
  if (farthest >= leg)
    throw_user_error("a cyclist's legs: expected more than the {:.3f} m to the pedals, found {:.3f} m",
                     farthest, leg);
  const Pedalling pedalling(cyclist, 0.0);
  Gait::Range range{1e9, -1e9};
  constexpr int phases = 256;
  for (int i = 0; i < phases; ++i)
    for (const bool left : {true, false}) {
      const double angle = pedalling.joint(limb, left, {cyclist.development_m * i / phases, 0.0, 0.0}).value;
      range.least = std::min(range.least, angle);
      range.most = std::max(range.most, angle);
    }
  constexpr double between_samples = 0.03;
  return {range.least - between_samples, range.most + between_samples};
}

}  // namespace greatx::sim
