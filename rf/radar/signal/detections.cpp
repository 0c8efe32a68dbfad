// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/detections.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/attribution.h"
#include "rf/radar/signal/symbols.h"

namespace greatx::rf {
namespace {

/// Returns `value` shifted by a multiple of `period` into [low, low + period).
double wrapped(double value, double low, double period) {
  const double moved = value - period * std::floor((value - low) / period);
  return moved < low + period ? moved : low;
}

uint32_t distance_on_circle(uint32_t a, uint32_t b, uint32_t size) {
  const uint32_t apart = a > b ? a - b : b - a;
  return std::min(apart, size - apart);
}

/// Returns the largest power of a window's response within half a bin of each whole offset: [size/2 + 1].
std::vector<double> envelope(const Window& window) {
  std::vector<double> result;
  for (uint32_t k = 0; k <= window.size() / 2; ++k) {
    double highest = 0.0;
    for (int i = -8; i <= 8; ++i) highest = std::max(highest, window.power(k + i / 16.0));
    result.push_back(highest);
  }
  return result;
}

}  // namespace

DetectionMaker::DetectionMaker(const RadarSignalConfig& config, const RadarMaps& maps,
                               RadarGain transmit_gain, RadarGain receive_gain)
    : config_(config),
      maps_(maps),
      finder_(config),
      range_envelope_(envelope(maps.range_window())),
      doppler_envelope_(envelope(maps.doppler_window())),
      transmit_gain_(std::move(transmit_gain)),
      receive_gain_(std::move(receive_gain)) {}

DetectionMaker::Offsets DetectionMaker::offsets(const CfarPeak& peak, std::span<const float> map) const {
  const uint32_t ranges = config_.waveform.samples, velocities = config_.waveform.chirps();
  const auto power = [&](uint32_t range, uint32_t velocity) {
    return std::max(0.0, map[size_t{range % ranges} * velocities + velocity % velocities] - peak.noise_w);
  };
  const double here = power(peak.range, peak.velocity);
  return {maps_.range_window().peak_offset(power(peak.range + ranges - 1, peak.velocity), here,
                                           power(peak.range + 1, peak.velocity)),
          maps_.doppler_window().peak_offset(power(peak.range, peak.velocity + velocities - 1), here,
                                             power(peak.range, peak.velocity + 1))};
}

size_t DetectionMaker::drop_sidelobes(std::vector<CfarPeak>& peaks, std::span<const float> map) const {
  const uint32_t ranges = config_.waveform.samples;
  const uint32_t velocities = config_.waveform.chirps() / config_.waveform.bands();
  std::vector<double> strength;  // power at the centre of the tone
  for (const CfarPeak& peak : peaks) {
    const Offsets at = offsets(peak, map);
    strength.push_back(peak.power_w /
                       (maps_.range_window().power(at.range) * maps_.doppler_window().power(at.velocity)));
  }
  std::vector<CfarPeak> kept;
  for (size_t i = 0; i < peaks.size(); ++i) {
    const bool sidelobe = std::any_of(peaks.begin(), peaks.end(), [&](const CfarPeak& other) {
      const size_t j = static_cast<size_t>(&other - peaks.data());
      if (other.power_w <= peaks[i].power_w) return false;
      return peaks[i].power_w <
             2.0 * strength[j] * range_envelope_[distance_on_circle(peaks[i].range, other.range, ranges)] *
                 doppler_envelope_[distance_on_circle(peaks[i].velocity % velocities,
                                                      other.velocity % velocities, velocities)];
    });
    if (!sidelobe) kept.push_back(peaks[i]);
  }
  const size_t dropped = peaks.size() - kept.size();
  peaks = std::move(kept);
  return dropped;
}

void DetectionMaker::place(RadarDetection& detection, const Offsets& at,
                           const RadarGeometry& geometry) const {
  const RadarWaveform& w = config_.waveform;
  const dvec3 unit = Direction{detection.azimuth, detection.elevation, 0.0}.unit();
  // The frequency of the tone is f_b = S tau + nu. The Doppler part nu = (f_c - S tau) dtau/dt turns the
  // phase from chirp to chirp. Waveforms whose samples are spectral lines have f_b = S tau.
  const double turns =
      wrapped(doppler_turns(detection.velocity_bin, w.chirps()) + at.velocity, -0.5 * w.chirps(), w.chirps());
  const double nu = turns / (w.chirps() * w.repetition_s());
  detection.power_w /= symbol_gain(w, nu);
  double way = speed_of_light * ((detection.range_bin + at.range) / w.sampled_s() - (w.sweeps() ? nu : 0.0)) /
               w.slope_hz_per_s;
  // Converts the path length between the centres of the elements to that between the origins.
  const auto middle = [](const std::vector<dvec3>& positions) {
    return std::accumulate(positions.begin(), positions.end(), dvec3(0.0)) / double(positions.size());
  };
  if (!config_.bistatic) way += glm::dot(unit, middle(config_.arrays.transmit_m));
  way += glm::dot(unit, middle(config_.arrays.receive_m));
  detection.range_m = wrapped(0.5 * way, -0.5 * w.range_bin_m(), w.range_span_m());
  detection.velocity_m_s = 0.5 * speed_of_light * nu /
                           (w.carrier_hz - 2.0 * w.squared_slope() * detection.range_m / speed_of_light);
  // The point on the ray of arrival at which the path from the transmitter to the receiver has this length.
  // It lies on a sphere (monostatic) or on an ellipsoid (bistatic).
  way = 2.0 * detection.range_m;
  const dvec3 arrival = geometry.attitude.receiver * unit, baseline = geometry.baseline_m;
  const double back =
      (way * way - glm::dot(baseline, baseline)) / (2.0 * (way - glm::dot(arrival, baseline)));
  const dvec3 outward = back * arrival - baseline;
  const double out = glm::length(outward);
  detection.position_m = back * unit;
  if (!(out > 0.0) || !std::isfinite(back)) return;
  const double gains =
      transmit_gain_(glm::conjugate(geometry.attitude.transmitter) * (outward / out)) * receive_gain_(unit);
  const double lambda = w.wavelength_m();
  if (gains > 0.0)
    detection.rcs_m2 = detection.power_w * std::pow(4.0 * pi, 3) * out * out * back * back /
                       (config_.transmit_power_w * gains * lambda * lambda);
}

std::vector<RadarDetection> DetectionMaker::make(std::span<const CfarPeak> peaks, std::span<const float> map,
                                                 std::span<const std::complex<float>> spectrum,
                                                 std::span<const EchoList> lists,
                                                 const RadarGeometry& geometry, uint32_t threads) const {
  const RadarWaveform& w = config_.waveform;
  const uint32_t velocities = w.chirps();
  const size_t plane = size_t{w.samples} * velocities,
               antennas = config_.arrays.receive_m.size() * w.transmitters;
  const Attribution attribution(config_, maps_, lists);
  std::vector<RadarDetection> detections(peaks.size());
  parallel_for(peaks.size(), threads, [&](size_t i) {
    const CfarPeak& peak = peaks[i];
    RadarDetection& detection = detections[i];
    detection.range_bin = peak.range;
    detection.velocity_bin = peak.velocity;
    const Offsets at = offsets(peak, map);
    const double doppler = doppler_turns(peak.velocity, velocities) + at.velocity;
    std::vector<std::complex<double>> snapshot;
    for (size_t v = 0; v < antennas; ++v) {
      const double turns = tdm_turns(w, static_cast<uint32_t>(v % w.transmitters), doppler);
      snapshot.push_back(
          std::complex<double>(spectrum[v * plane + size_t{peak.range} * velocities + peak.velocity]) *
          unit_phasor(-fraction_of_turn(turns)));
    }
    const Direction direction = finder_.find(snapshot);
    detection.azimuth = direction.azimuth;
    detection.elevation = direction.elevation;
    detection.snr = (peak.power_w - peak.noise_w) / std::max(peak.noise_w, 1e-300);
    detection.power_w = direction.power_w /
                        (maps_.range_window().power(at.range) * maps_.doppler_window().power(at.velocity));
    detection.instance = attribution.instance(peak.range, peak.velocity, peak.power_w - peak.noise_w);
    place(detection, at, geometry);
  });
  return detections;
}

}  // namespace greatx::rf
