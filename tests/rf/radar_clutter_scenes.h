// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides rough materials and radars for tests of clutter.
#pragma once

#include <cstring>

#include <gtest/gtest.h>

#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf::testing {

/// A material of a perfect conductor with a clutter model.
inline scene::Material rough_material(const char* clutter, double cross_db = -200.0) {
  scene::Material material;
  material.name = clutter;
  material.radio.emplace().clutter = scene::clutter_called(clutter);
  material.radio->clutter->cross_db = cross_db;
  return material;
}

/// Options of a radar at rest with one slot, whose range cell is 1 m.
inline EchoOptions still_options(double half_azimuth_deg, double elevation_min_deg,
                                 double elevation_max_deg) {
  EchoOptions options;
  options.field_of_view = {radians(-half_azimuth_deg), radians(half_azimuth_deg), radians(elevation_min_deg),
                           radians(elevation_max_deg)};
  options.tubes = 2000;
  options.diffuse = true;
  options.waveform.carrier_hz = radar_carrier_hz;
  options.waveform.slope_hz_per_s = 3.5e12;
  options.waveform.slots = options.waveform.transmitters = 1;
  options.beam_rad = 0.1;
  return options;
}

inline double patch_range(const PatchList& list, size_t i) { return 0.5 * speed_of_light * list.delay_s[i]; }
inline Complex patch_amplitude(const PatchList& list, size_t i) { return {list.re[i], list.im[i]}; }

inline double power_between(const PatchList& list, double from_m, double to_m) {
  double power = 0.0;
  for (size_t i = 0; i < list.size(); ++i)
    if (patch_range(list, i) > from_m && patch_range(list, i) < to_m)
      power += std::norm(patch_amplitude(list, i));
  return power;
}

/// Expects the same patches from one and from three threads.
inline void expect_same_on_all_threads(EchoScene& scene, EchoOptions options) {
  options.threads = 1;
  const PatchList one = scene.find(options, Pose{}).patches;
  options.threads = 3;
  const PatchList three = scene.find(options, Pose{}).patches;
  const auto expect_same = [](const auto& a, const auto& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
  };
  expect_same(one.re, three.re);
  expect_same(one.arrival, three.arrival);
  expect_same(one.delay_s, three.delay_s);
}

}  // namespace greatx::rf::testing
