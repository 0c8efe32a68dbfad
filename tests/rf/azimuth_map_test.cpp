// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of the range-azimuth map of sensing: the power and the place of a target, the noise, and the whole
// map against its definition.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "tests/rf/sensing_points.h"

namespace greatx::rf {
namespace {

using namespace test;

constexpr size_t all_azimuths = 181;

SensingConfig with_map(SensingConfig config) {
  config.range_azimuth = true;
  config.range_doppler = config.detections = false;
  return config;
}

SensingArrays panel_of(int columns, int rows) {
  SensingArrays panel;
  panel.receive_m.clear();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      panel.receive_m.push_back(0.5 * waveform.wavelength_m() * dvec3(0.0, column - 1.5, row - 0.5));
  panel.transmit_m = panel.receive_m;
  return panel;
}

dvec3 towards(double azimuth_deg, double elevation_deg = 0.0) {
  const double a = radians(azimuth_deg), e = radians(elevation_deg);
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

TEST(AzimuthMap, ATargetPeaksInItsBeamWithItsPower) {
  SensingArrays apart = panel_of(4, 2), dual = panel_of(4, 2);
  apart.monostatic = false;
  dual.receive_polarizations = 2;
  for (const SensingArrays& arrays : {panel_of(4, 2), apart, dual})
    for (const double velocity_bins : {5.0, 12.4, -17.5}) {
      const double azimuth = 20.0 * (velocity_bins > 0.0 ? 1.0 : -2.0);
      const Point point{100.0 * waveform.range_bin_m(), velocity_bins * waveform.velocity_bin_m_s(), 1e-9, 1,
                        towards(azimuth)};
      const SensingFrame frame =
          frame_of(OfdmSensing("csi", with_map(quiet()), waveform, arrays), arrays, std::span(&point, 1));
      EXPECT_TRUE(frame.range_doppler.empty());
      ASSERT_EQ(frame.range_azimuth.size(), waveform.subcarriers * all_azimuths);
      const auto peak = std::ranges::max_element(frame.range_azimuth);
      EXPECT_EQ(size_t(peak - frame.range_azimuth.begin()), 100 * all_azimuths + size_t(90.0 + azimuth));
      EXPECT_NEAR(decibels(*peak / (2.0 * 1e-9)), 0.0, 0.01) << velocity_bins;
    }
}

/// A row measures the cone about its axis: a target above it appears at the azimuth that has the same cone at
/// elevation 0.
TEST(AzimuthMap, ARowShowsTheAzimuthOfTheCone) {
  const SensingArrays row = panel_of(8, 1);
  const double elevation = 40.0,
               azimuth = degrees(std::asin(std::sin(radians(20.0)) / std::cos(radians(elevation))));
  const Point point{100.0 * waveform.range_bin_m(), 9.0, 1e-9, 1, towards(azimuth, elevation)};
  const SensingFrame frame =
      frame_of(OfdmSensing("csi", with_map(quiet()), waveform, row), row, std::span(&point, 1));
  const auto peak = std::ranges::max_element(frame.range_azimuth);
  EXPECT_EQ(size_t(peak - frame.range_azimuth.begin()), 100 * all_azimuths + 110);
  EXPECT_NEAR(decibels(*peak / (2.0 * 1e-9)), 0.0, 0.01);
}

TEST(AzimuthMap, ATargetAtRestIsRemoved) {
  const SensingArrays arrays = panel_of(4, 2);
  const Point point{100.0 * waveform.range_bin_m(), 0.0, 1e-9, 1, towards(20.0)};
  SensingConfig config = with_map(quiet());
  const auto strongest = [&] {
    const SensingFrame frame =
        frame_of(OfdmSensing("csi", config, waveform, arrays), arrays, std::span(&point, 1));
    return *std::ranges::max_element(frame.range_azimuth);
  };
  EXPECT_LT(decibels(strongest() / (2.0 * 1e-9)), -100.0);
  config.remove_static = false;
  EXPECT_NEAR(decibels(strongest() / (2.0 * 1e-9)), 0.0, 0.01);
}

/// The noise of a beam is k T_0 B F w_r/N over the number of pairs of elements that it sums. The removal of
/// the mean takes the share (2 <w^3>/(<w><w^2>) - <w^2>/<w>^2)/M of it, with the means over the window w over
/// symbols: for Hann's 1/2, 3/8 and 5/16.
TEST(AzimuthMap, TheNoiseOfABeamHasItsPower) {
  for (const bool monostatic : {true, false})
    for (const bool removed : {true, false}) {
      SensingArrays arrays = panel_of(4, 2);
      arrays.monostatic = monostatic;
      if (!monostatic) arrays.transmit_m.resize(3);
      SensingConfig config = with_map(quiet());
      config.noise_figure_db = 6.0;
      config.remove_static = removed;
      const SensingFrame frame = frame_of(OfdmSensing("csi", config, waveform, arrays), arrays, {});
      double mean = 0.0;
      for (const float power : frame.range_azimuth) mean += power;
      mean /= double(frame.range_azimuth.size());
      const double summed = monostatic ? 64.0 : 8.0, symbols = waveform.symbols;
      const double floor = 1.380649e-23 * 290.0 * waveform.bandwidth_hz() * std::pow(10.0, 0.6) * 1.5 /
                           waveform.subcarriers / summed;
      // 384 ranges of 64 velocities and at least 4 beams: the deviation is 0.3 %.
      EXPECT_NEAR(mean / floor, removed ? 1.0 - (10.0 / 3.0 - 1.5) / symbols : 1.0, 0.01)
          << monostatic << removed;
    }
}

/// Computes the map from its definition, in fp64 and without any sum in advance.
struct Definition {
  const SensingWaveform& w;
  const SensingArrays& arrays;
  const std::vector<std::complex<float>>& h;

  static double hann(uint32_t n, uint32_t count) { return 0.5 - 0.5 * std::cos(2.0 * pi * n / count); }

  /// conj(H) in a cell, windows normalized to a gain of 1.
  std::complex<double> cell(size_t rx, size_t tx, uint32_t range, int velocity) const {
    std::complex<double> sum = 0.0;
    for (uint32_t m = 0; m < w.symbols; ++m)
      for (uint32_t k = 0; k < w.subcarriers; ++k)
        sum += hann(m, w.symbols) * hann(k, w.subcarriers) *
               std::conj(std::complex<double>(
                   h[((rx * arrays.transmit_ports() + tx) * w.symbols + m) * w.subcarriers + k])) *
               std::polar(1.0,
                          -2.0 * pi * (double(k) * range / w.subcarriers + double(m) * velocity / w.symbols));
    return sum / (0.25 * w.subcarriers * w.symbols);
  }
  double power(uint32_t range, double azimuth) const {
    const dvec3 u(std::cos(azimuth), std::sin(azimuth), 0.0);
    const size_t groups = arrays.monostatic ? 1 : arrays.transmit_m.size();
    const double each = double(arrays.receive_m.size() * arrays.transmit_m.size() / groups);
    double total = 0.0;
    for (uint32_t q = 0; q < arrays.receive_polarizations; ++q)
      for (uint32_t p = 0; p < arrays.transmit_polarizations; ++p)
        for (size_t group = 0; group < groups; ++group)
          for (uint32_t velocity = 0; velocity < w.symbols; ++velocity) {
            std::complex<double> beam = 0.0;
            for (size_t r = 0; r < arrays.receive_m.size(); ++r)
              for (size_t t = group; t < arrays.transmit_m.size(); t += groups) {
                const dvec3 place =
                    arrays.receive_m[r] + (arrays.monostatic ? arrays.transmit_m[t] : dvec3(0.0));
                // conj(H) turns against the phase of H, which grows towards the direction.
                beam += cell(r * arrays.receive_polarizations + q, t * arrays.transmit_polarizations + p,
                             range, int(velocity)) *
                        std::polar(1.0, 2.0 * pi * glm::dot(u, place) / w.wavelength_m());
              }
            total += std::norm(beam / each);
          }
    return total / (double(groups) * arrays.receive_polarizations * arrays.transmit_polarizations * 1.5);
  }
};

/// Random channels of arrays whose places coincide and of arrays whose places do not, with few azimuths and
/// with so many that the beams are summed themselves.
TEST(AzimuthMap, IsThatOfItsDefinition) {
  const SensingWaveform few{28e9, 120e3, 8, 125e-6, 6};
  RandomStream random(3, 5);
  SensingArrays scattered;
  scattered.receive_m.clear();
  for (int i = 0; i < 12; ++i)
    scattered.receive_m.push_back(0.02 * dvec3(random.uniform(), random.uniform(), random.uniform()));
  scattered.transmit_m = scattered.receive_m;
  SensingArrays two_ends = panel_of(3, 2);
  two_ends.monostatic = false;
  two_ends.transmit_m.resize(2);
  two_ends.transmit_polarizations = 2;
  for (const SensingArrays& arrays : {panel_of(3, 2), two_ends, scattered})
    for (const uint32_t azimuths : {5u, 4096u}) {
      SensingConfig config = with_map({});
      config.remove_static = false;
      config.azimuths = azimuths, config.azimuth_limit = radians(70.0);
      const OfdmSensing sensing("csi", config, few, arrays);
      std::vector<std::complex<float>> h(arrays.pairs() * few.symbols * few.subcarriers);
      for (std::complex<float>& value : h)
        value = std::complex<float>(float(random.uniform() - 0.5), float(random.uniform() - 0.5));
      const SensingFrame frame = sensing.process({h, {}, seeds, {1.0, 0.0, 0.0, 0.0}, dvec3(0.0)}, 2);
      ASSERT_EQ(frame.range_azimuth.size(), size_t{few.subcarriers} * azimuths);
      const Definition definition{few, arrays, h};
      const float top = *std::ranges::max_element(frame.range_azimuth);
      for (const uint32_t k : {0u, azimuths / 3, azimuths - 1})
        EXPECT_NEAR(frame.range_azimuth[3 * azimuths + k], definition.power(3, sensing.axes().azimuth[k]),
                    2e-6 * top)
            << arrays.receive_m.size() << " elements, azimuth " << k << " of " << azimuths;
    }
  // The tables are those of few places, of many pairs of places, and of places alone.
  const auto bytes = [&](const SensingArrays& arrays, uint32_t azimuths) {
    SensingConfig config = with_map({});
    config.azimuths = azimuths;
    return OfdmSensing("csi", config, few, arrays).table_bytes() / (2 * sizeof(float) * azimuths);
  };
  EXPECT_EQ(bytes(panel_of(3, 2), 5), 10u);      // five places
  EXPECT_EQ(bytes(scattered, 5), 78u * 77 / 2);  // 12 elements, and their sums
  EXPECT_EQ(bytes(scattered, 4096), 78u);
}

}  // namespace
}  // namespace greatx::rf
