// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_tracks.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr size_t nodes = 4, checks = 9;  // Chebyshev nodes of the cubic, points at which it is checked

struct Span {
  double begin_s = 0.0, end_s = 0.0;
  double mid_s() const { return 0.5 * (begin_s + end_s); }
  double half_s() const { return 0.5 * (end_s - begin_s); }
};

Span span_of(const EchoMotion& motion) {
  GREATX_CHECK(!motion.slot_start_s.empty(), "a frame without slots");
  return {motion.slot_start_s.front(), motion.slot_start_s.back() + motion.slot_s};
}

double chebyshev_node(size_t i) { return std::cos(pi * (2.0 * double(i) + 1.0) / (2.0 * nodes)); }

/// Returns the coefficients of the cubic through (x_i, y_i), x = (t - mid)/half. Divided differences give the
/// Newton form, which is then expanded.
std::array<double, 4> cubic_through(const std::array<double, 4>& x, std::array<double, 4> y) {
  for (int order = 1; order < 4; ++order)
    for (int i = 3; i >= order; --i) y[i] = (y[i] - y[i - 1]) / (x[i] - x[i - order]);
  std::array<double, 4> c{y[3], 0.0, 0.0, 0.0};
  for (int i = 2; i >= 0; --i) {  // c(x) * (x - x_i) + y_i
    for (int k = 3; k > 0; --k) c[k] = c[k - 1] - x[i] * c[k];
    c[0] = y[i] - x[i] * c[0];
  }
  return c;
}

}  // namespace

PoseTable::PoseTable(const EchoMotion& motion, std::span<const bool> bodies, std::vector<double> times_s,
                     uint32_t threads)
    : times_s_(std::move(times_s)), bodies_(bodies.size()) {
  std::vector<uint32_t> asked;
  for (uint32_t body = 1; body < bodies.size(); ++body)
    if (bodies[body]) asked.push_back(body);
  parallel_for(asked.size(), threads, [&](size_t i) {
    std::vector<Pose>& poses = bodies_[asked[i]];
    poses.reserve(times_s_.size());
    for (const double t : times_s_) poses.push_back(motion.body(asked[i], t));
  });
  for (const double t : times_s_) {
    transmitter_.push_back(motion.transmitter(t).position);
    receiver_.push_back(motion.receiver(t).position);
  }
}

double PoseTable::length(std::span<const CarriedPoint> vertices, size_t time) const {
  dvec3 last = transmitter_[time];
  double sum = 0.0;
  for (const CarriedPoint& vertex : vertices) {
    const dvec3 at = vertex.body == 0 ? vertex.at : bodies_[vertex.body][time].apply(vertex.at);
    sum += glm::distance(last, at);
    last = at;
  }
  return sum + glm::distance(last, receiver_[time]);
}

std::vector<double> track_times(const EchoMotion& motion) {
  const Span span = span_of(motion);
  std::vector<double> times;
  for (size_t i = 0; i < nodes; ++i) times.push_back(span.mid_s() + span.half_s() * chebyshev_node(i));
  for (size_t i = 0; i < checks; ++i)
    times.push_back(span.begin_s + 2.0 * span.half_s() * double(i) / double(checks - 1));
  return times;
}

bool fit_track(const PoseTable& poses, std::span<const CarriedPoint> vertices, double tolerance_m,
               DelayTrack& track) {
  const std::vector<double>& times = poses.times_s();
  GREATX_CHECK(times.size() == nodes + checks, "{} times", times.size());
  const double begin = times[nodes], end = times.back();
  track.mid_s = 0.5 * (begin + end);
  const double half = 0.5 * (end - begin), at_begin = poses.length(vertices, nodes);
  track.coefficients = {at_begin / speed_of_light, 0.0, 0.0, 0.0};
  if (half == 0.0) return true;
  std::array<double, 4> x, y;
  for (size_t i = 0; i < nodes; ++i) {
    x[i] = (times[i] - track.mid_s) / half;
    // Differences, because the cubic has to be exact to fractions of a wavelength.
    y[i] = poses.length(vertices, i) - at_begin;
  }
  const std::array<double, 4> c = cubic_through(x, y);
  for (size_t i = nodes; i < times.size(); ++i) {
    const double u = (times[i] - track.mid_s) / half;
    const double error = c[0] + u * (c[1] + u * (c[2] + u * c[3])) - (poses.length(vertices, i) - at_begin);
    if (std::abs(error) > tolerance_m) return false;
  }
  double scale = 1.0 / speed_of_light;
  for (int k = 0; k < 4; ++k, scale /= half) track.coefficients[k] = c[k] * scale;
  track.coefficients[0] += at_begin / speed_of_light;
  return true;
}

std::vector<std::array<double, 2>> track_table(const PoseTable& poses, std::span<const CarriedPoint> vertices,
                                               double step_s) {
  const size_t slots = poses.times_s().size() / 2;
  std::vector<std::array<double, 2>> table(slots);
  for (size_t slot = 0; slot < slots; ++slot) {
    const double now = poses.length(vertices, slot), later = poses.length(vertices, slots + slot);
    table[slot] = {now / speed_of_light, (later - now) / (step_s * speed_of_light)};
  }
  return table;
}

CarriedPath carried_vertices(const FacetWorld& world, const dvec3& transmitter, const dvec3& departure,
                             std::span<const uint32_t> chain, const dvec3& point) {
  CarriedPath vertices;
  GREATX_CHECK(chain.size() <= vertices.points.size(), "{} bounces", chain.size());
  dvec3 at = transmitter, direction = departure;
  for (size_t i = 0; i < chain.size(); ++i) {
    const PosedFacet& facet = world.facet(chain[i]);
    const double towards = glm::dot(facet.normal, direction);
    at = i + 1 == chain.size() ? point : at - facet.distance(at) / towards * direction;
    direction -= 2.0 * towards * facet.normal;
    vertices.points[vertices.count++] = {
        facet.body, facet.body == 0 ? at : world.motion(facet.body).pose.inverse().apply(at)};
  }
  return vertices;
}

}  // namespace greatx::rf
