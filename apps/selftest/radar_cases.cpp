// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radar cross-sections of reflectors of a = 0.1 m at 77 GHz, and the chain from echo to detection.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "rf/radar/echoes/echo_finder.h"
#include "rf/radar/signal/radar_processor.h"

namespace greatx::apps::selftest {

namespace {

using rf::Complex;
using rf::EchoTracing;

constexpr double radar_hz = 77e9, radar_wavelength_m = speed_of_light / radar_hz;
constexpr double edge_m = 0.1, distance_m = 400.0;

const char* name_of_tracing(EchoTracing tracing) {
  return tracing == EchoTracing::host ? "host rays, fp32 + fp64" : "device rays, fp32 + fp64";
}

/// Returns the cross-section, dBsm, that a monostatic radar at `at` sees by physical optics, from the echoes
/// of `bounces` bounces (0: all). All surfaces conduct perfectly.
double section_db(const Lab& lab, const scene::Scene& scene, const dvec3& at, const dvec3& target,
                  EchoTracing tracing, uint32_t bounces = 0) {
  rf::RadioSurface conductor;
  conductor.front = conductor.back = {{Complex(1.0, -1e14), 0.0}};
  const rf::RadioSurfaces surfaces(std::vector(scene.materials.size(), conductor), radar_hz);
  rf::EchoOptions options;
  const double half = std::atan(0.13 / distance_m);
  options.field_of_view = {-half, half, -half, half};
  options.tubes = 400;
  options.merge_share = 0.0;
  options.border_floor_m2 = 0.0;
  options.max_echoes = 1u << 24;
  options.tracing = tracing;
  scene::GpuScene gpu(lab.device(), scene, {});
  rf::EchoFinder finder(gpu, surfaces, {}, std::nullopt, options);
  const dvec3 d = target - at;
  const Pose pose{
      at, orientation_from_yaw_pitch_roll(std::atan2(d.y, d.x), -std::atan2(d.z, std::hypot(d.x, d.y)), 0.0)};
  rf::EchoMotion motion;
  motion.transmitter = motion.receiver = [pose](double) { return pose; };
  motion.body = [](uint32_t, double) { return Pose{}; };
  motion.slot_start_s = {0.0};
  const std::vector<Pose> bodies(scene.bodies.size());
  gpu::TickRing ring(lab.device(), 1, 1u << 20, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  gpu.record_update(slot, bodies);
  const rf::EchoFinder::Pending pending = finder.record(slot, pose, pose, bodies);
  ring.submit(slot);
  ring.wait(slot);
  Complex field(0.0);
  for (const rf::Echo& echo : finder.collect(pending, motion).echoes)
    if (bounces == 0 || echo.bounces == bounces)
      field += echo.amplitude *
               std::polar(1.0, -2.0 * pi * std::remainder(radar_hz * echo.delay.coefficients[0], 1.0));
  const double r = glm::length(d);
  return decibels(std::norm(field) * std::pow(4.0 * pi, 3) * std::pow(r, 4) /
                  (radar_wavelength_m * radar_wavelength_m));
}

void n62_reflectors(const Lab& lab, Rows& rows) {
  const double a = lab.given(edge_m), h = 0.5 * a;
  const double unit = 4.0 * pi * std::pow(edge_m, 4) / (radar_wavelength_m * radar_wavelength_m);
  Stage plate = lab.stage(), dihedral = lab.stage(), trihedral = lab.stage();
  plate.quad({0, -h, -h}, {0, h, -h}, {0, h, h}, {0, -h, h});
  dihedral.quad({0, 0, 0}, {a, 0, 0}, {a, 0, a}, {0, 0, a}).quad({0, 0, 0}, {0, 0, a}, {0, a, a}, {0, a, 0});
  const dvec3 o(0.0), x(a, 0, 0), y(0, a, 0), z(0, 0, a);
  trihedral.triangle(o, x, y).triangle(o, z, x).triangle(o, y, z);
  const scene::Scene flat = plate.build(), two = dihedral.build(), three = trihedral.build();
  const double tilt = radians(20.0), k = 2.0 * pi / radar_wavelength_m;
  const double u = k * edge_m * std::sin(tilt);
  for (const EchoTracing tracing : {EchoTracing::device, EchoTracing::host}) {
    const char* by = name_of_tracing(tracing);
    // 4 pi a^4/lambda^2 (cos(theta) sinc(k a sin(theta)))^2 (Balanis, Advanced Engineering Electromagnetics,
    // 11.3); 8 pi a^4/lambda^2; 4 pi a^4/(3 lambda^2).
    rows.add("plate of 0.1 m, dBsm", by, decibels(unit),
             section_db(lab, flat, {distance_m, 0, 0}, o, tracing), 2e-3);
    rows.add("plate at 20 degrees, dBsm", by, decibels(unit * std::pow(std::cos(tilt) * std::sin(u) / u, 2)),
             section_db(lab, flat, distance_m * dvec3(std::cos(tilt), std::sin(tilt), 0), o, tracing), 0.01);
    const dvec3 middle(0, 0, 0.5 * edge_m);
    rows.add("dihedral, two bounces, dBsm", by, decibels(2.0 * unit),
             section_db(lab, two, middle + distance_m * dvec3(std::sqrt(0.5), std::sqrt(0.5), 0), middle,
                        tracing, 2),
             3e-3);
    rows.add("trihedral, three bounces, dBsm", by, decibels(unit / 3.0),
             section_db(lab, three, distance_m * dvec3(std::sqrt(1.0 / 3.0)), o, tracing, 3), 0.05);
  }
}

/// Returns a radar with 4 x 4 antennas, 200 MHz over 250 samples (187 m) and 32 chirps of each transmitter.
rf::RadarSignalConfig long_range() {
  rf::RadarSignalConfig config;
  config.waveform.slope_hz_per_s = 4e12;
  config.waveform.samples = 250;
  config.waveform.sample_rate_hz = 5e6;
  config.waveform.chirp_s = 55e-6;
  config.waveform.slots = 128;
  const double half = 0.5 * config.waveform.wavelength_m();
  config.arrays = {{}, {}};
  for (int i = 0; i < 4; ++i) {
    config.arrays.transmit_m.push_back({0, half * 4 * i, 0});
    config.arrays.receive_m.push_back({0, half * i, 0});
  }
  return config;
}

/// Returns the echo of a sphere of 1 m^2 by the radar equation.
rf::EchoList point_echo(const rf::RadarSignalConfig& config, double range_m, double velocity_m_s,
                        double gain) {
  rf::Echo echo;
  echo.amplitude =
      gain * config.waveform.wavelength_m() * std::sqrt(1.0 / std::pow(4 * pi, 3)) / (range_m * range_m);
  echo.departure = echo.arrival = {1, 0, 0};
  echo.delay.mid_s = config.waveform.frame_middle_s();
  echo.delay.coefficients = {2 * range_m / speed_of_light, 2 * velocity_m_s / speed_of_light, 0.0, 0.0};
  echo.instance = 1;
  return {0, config.waveform.slots, {echo}, {}};
}

rf::RadarFrame frame_of(const rf::RadarSignalConfig& config, const rf::EchoList& list, double gain,
                        uint32_t threads = 0) {
  const std::vector<rf::RadarAttitude> attitudes(1);
  const auto gains = [gain](const dvec3&) { return gain; };
  return rf::RadarProcessor("selftest", config, gains, gains)
      .process({std::span(&list, 1), attitudes, {}, {1, 2, 3}}, threads);
}

void n62_radar_equation(const Lab& lab, Rows& rows) {
  // 12 dBm, 12 dBi, 1 m^2, 77 GHz, 100 m: P_t G^2 lambda^2 sigma/((4 pi)^3 R^4) = -125.1697 dBm.
  const rf::RadarSignalConfig config = long_range();
  const double gain = from_decibels(12.0);
  const double span = config.waveform.velocity_span_m_s();
  // A velocity inside the span, one between two bins, and one beyond the span, whose alias is documented.
  for (const double velocity : {0.0, 3.21, 0.4 * span + span}) {
    const rf::RadarFrame frame =
        frame_of(config, point_echo(config, lab.given(100.0), lab.given(velocity), gain), gain);
    const auto strongest = std::ranges::max_element(frame.detections, {}, &rf::RadarDetection::power_w);
    const std::string at = " at " + std::to_string(velocity) + " m/s";
    if (strongest == frame.detections.end()) {
      rows.add("detections" + at, "host, complex64", 1.0, 0.0, 0.0);
      continue;
    }
    const double alias = std::remainder(velocity, span);
    // With an alias, the range is wrong by f_c/S times the error of the velocity, and time division turns the
    // virtual antennas by wrong phases, so that their sum has less power (docs/radar.md).
    if (alias == velocity)
      rows.add("power, dBm" + at, "host, complex64", -125.1697, decibels(strongest->power_w) + 30.0, 0.01);
    const double shift = config.waveform.carrier_hz / config.waveform.slope_hz_per_s * (velocity - alias);
    rows.add("range, m" + at, "host, complex64", 100.0 + shift, strongest->range_m, 0.01);
    rows.add("velocity, m/s" + at, "host, complex64", alias, strongest->velocity_m_s, 2e-3);
  }
}

void n63_threads_of_the_radar(const Lab& lab, Rows& rows) {
  const rf::RadarSignalConfig config = long_range();
  std::vector<rf::RadarFrame> frames;
  for (const uint32_t threads : {1u, 2u, 16u})
    frames.push_back(frame_of(config, point_echo(config, threads == 1 ? 63.0 : lab.given(63.0), 1.5, 10.0),
                              10.0, threads));
  double differ = 0.0;
  for (size_t i = 1; i < frames.size(); ++i)
    differ += frames[0].cube != frames[i].cube || frames[0].range_doppler != frames[i].range_doppler;
  rows.add("frames that differ with 2 or 16 threads", "host, complex64", 0.0, differ, 0.0);
}

constexpr Case list_of_radar_cases[] = {
    {62, "radar: cross-sections of reflectors", n62_reflectors},
    {62, "radar: equation, bins and aliases", n62_radar_equation},
    {63, "radar: threads", n63_threads_of_the_radar},
};

}  // namespace

std::span<const Case> radar_cases() { return list_of_radar_cases; }

}  // namespace greatx::apps::selftest
