// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides reflectors with known radar cross-sections and computes cross-sections from their echoes.
#pragma once

#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include "core/units.h"
#include "rf/radar/echoes/echo_finder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf::testing {

inline constexpr double radar_carrier_hz = 77e9;
inline constexpr double radar_wavelength_m = speed_of_light / radar_carrier_hz;

/// Returns a perfect conductor. Its reflection coefficients differ from +-1 by about 1e-7.
inline RadioSurface conductor() {
  RadioSurface surface;
  surface.front = surface.back = {{Complex(1.0, -1e14), 0.0}};
  return surface;
}

/// Returns a pose at `at` whose +x axis points towards `target`.
inline Pose looking(const dvec3& at, const dvec3& target) {
  const dvec3 d = target - at;
  return {at,
          orientation_from_yaw_pitch_roll(std::atan2(d.y, d.x), -std::atan2(d.z, std::hypot(d.x, d.y)), 0.0)};
}

/// Returns the sum of all echoes at the carrier, or of the echoes with `bounces` bounces if it is not 0.
inline Complex field_of(const EchoList& list, uint32_t bounces = 0) {
  Complex sum(0.0);
  for (const Echo& echo : list.echoes)
    if (bounces == 0 || echo.bounces == bounces)
      sum += echo.amplitude *
             std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * echo.delay.coefficients[0], 1.0));
  return sum;
}

/// Returns the radar cross-section, dBsm, from the field of echoes at the distances r1 and r2, for elements
/// of gain 1.
inline double section_db(const Complex& field, double r1, double r2) {
  const double four_pi = 4.0 * pi;
  return decibels(std::norm(field) * four_pi * four_pi * four_pi * r1 * r1 * r2 * r2 /
                  (radar_wavelength_m * radar_wavelength_m));
}

/// Returns options for elements without a pattern, with tubes over a square of half width `half_m` around the
/// target.
inline EchoOptions around(double half_m, double distance_m, uint32_t tubes) {
  EchoOptions options;
  const double half = std::atan(half_m / distance_m);
  options.field_of_view = {-half, half, -half, half};
  options.tubes = tubes;
  options.merge_share = 0.0;
  return options;
}

/// Returns the motion of a scene in which the ends stand still and all bodies are where they were built.
inline EchoMotion at_rest(const Pose& transmitter, const Pose& receiver) {
  EchoMotion motion;
  motion.transmitter = [transmitter](double) { return transmitter; };
  motion.receiver = [receiver](double) { return receiver; };
  motion.body = [](uint32_t, double) { return Pose{}; };
  motion.slot_start_s = {0.0};
  return motion;
}

/// Records a search in a scene of `bodies` bodies, submits it and collects the echoes.
inline EchoList trace_echoes(EchoFinder& finder, scene::GpuScene& gpu, size_t bodies,
                             const EchoMotion& motion, EchoStatistics* statistics = nullptr) {
  std::vector<Pose> poses(bodies);
  for (uint32_t body = 1; body < bodies; ++body) poses[body] = motion.body(body, motion.traced_s);
  gpu::TickRing ring(test::device(), 1, 1u << 20, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  gpu.record_update(slot, poses);
  const EchoFinder::Pending pending =
      finder.record(slot, motion.transmitter(motion.traced_s), motion.receiver(motion.traced_s), poses);
  ring.submit(slot);
  ring.wait(slot);
  return finder.collect(pending, motion, statistics);
}

/// Holds one scene on the device. All its materials are perfect conductors unless `surfaces` is given.
class EchoScene {
 public:
  explicit EchoScene(const test::TinyScene& tiny, std::vector<RadioSurface> surfaces = {},
                     const dvec3& origin = dvec3(0.0))
      : scene(tiny.build(origin)), gpu(test::device(), scene, {}) {
    if (surfaces.empty()) surfaces.assign(scene.materials.size(), conductor());
    surfaces_.emplace(surfaces, radar_carrier_hz);
  }
  EchoList find(const EchoOptions& options, const Pose& transmitter, const std::optional<Pose>& receiver = {},
                EchoStatistics* statistics = nullptr, const EchoEnd& end = {}) {
    EchoFinder finder(gpu, *surfaces_, end, receiver ? std::optional(end) : std::nullopt, options);
    return trace_echoes(finder, gpu, scene.bodies.size(),
                        at_rest(transmitter, receiver.value_or(transmitter)), statistics);
  }
  const RadioSurfaces& surfaces() const { return *surfaces_; }

  scene::Scene scene;
  scene::GpuScene gpu;

 private:
  std::optional<RadioSurfaces> surfaces_;
};

}  // namespace greatx::rf::testing
