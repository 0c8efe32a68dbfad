// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the frequency responses of a burst of OFDM symbols into range-Doppler maps and detections
// (docs/sensing.md; C. Sturm, W. Wiesbeck, "Waveform design and signal processing aspects for fusion of
// wireless communications and radar sensing", Proc. IEEE 99(7), 2011):
//
//   H(f, t) x sqrt(P) + leakage ─► noise ─► converter (in time, with random symbols) ─► less the static mean
//     ─► windows, transforms ─► power over range and velocity ─► CFAR ─► detections
//                               and over range and azimuth
//
// Maps, CFAR and directions are those of rf/radar/signal: conj(H) over subcarriers and symbols is a beat
// signal over samples and chirps.
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rf/config/sensing_config.h"
#include "rf/radar/signal/cfar.h"
#include "rf/radar/signal/detections.h"
#include "rf/radar/signal/direction_finder.h"
#include "rf/radar/signal/maps.h"
#include "rf/radar/signal/receiver.h"
#include "rf/sensing/azimuth_map.h"

namespace greatx::rf {

/// Describes the burst.
struct SensingWaveform {
  double carrier_hz = 3.5e9;
  double spacing_hz = 30e3;    ///< of the subcarriers
  uint32_t subcarriers = 256;  ///< N
  double interval_s = 1e-3;    ///< T, from symbol to symbol
  uint32_t symbols = 64;       ///< M

  double bandwidth_hz() const { return subcarriers * spacing_hz; }
  double wavelength_m() const { return speed_of_light / carrier_hz; }
  double range_bin_m() const { return speed_of_light / (2.0 * bandwidth_hz()); }  ///< c/2B
  double range_span_m() const { return subcarriers * range_bin_m(); }             ///< c/(2 spacing)
  double velocity_bin_m_s() const { return wavelength_m() / (2.0 * symbols * interval_s); }
  double velocity_span_m_s() const { return wavelength_m() / (2.0 * interval_s); }  ///< lambda/2T
};

/// Describes the elements of both ends, metres, in the frames of their arrays. Port p is element
/// p / polarizations.
struct SensingArrays {
  std::vector<dvec3> transmit_m{dvec3(0.0)}, receive_m{dvec3(0.0)};
  uint32_t transmit_polarizations = 1, receive_polarizations = 1;
  /// One array sends and receives, so that both ends turn the phases of a direction.
  bool monostatic = true;
  size_t transmit_ports() const { return transmit_m.size() * transmit_polarizations; }
  size_t receive_ports() const { return receive_m.size() * receive_polarizations; }
  size_t pairs() const { return transmit_ports() * receive_ports(); }
};

/// Describes a path for the attribution of detections.
struct SensingTone {
  uint32_t instance = 0;  ///< of the target, index + 1; 0: the path is none of a target
  double delay_s = 0.0, doppler_hz = 0.0;
  double gain = 0.0;  ///< |a|^2, mean over the pairs of ports
};

struct SensingInput {
  std::span<const std::complex<float>> h;  ///< [rx_ant, tx_ant, symbol, subcarrier]
  std::span<const SensingTone> tones;
  RadarSeeds seeds;
  dquat receiver_orientation{1.0, 0.0, 0.0, 0.0};  ///< world_from_array
  dvec3 baseline_m{0.0};  ///< from the receiver's origin to the transmitter's, world axes
};

struct SensingDetection {
  double range_m = 0.0;       ///< half the way from transmitter over target to receiver, in [-1/2 bin, span)
  double velocity_m_s = 0.0;  ///< rate of the range, positive receding, in [-v_max, v_max)
  double azimuth = 0.0, elevation = 0.0;  ///< rad, in the frame of the receiving array
  dvec3 position_m{0.0};                  ///< in the same frame, from the range and both angles
  double snr = 0.0;                       ///< (power of the cell - noise)/noise
  double power_w = 0.0;   ///< received in a pair of ports, mean, corrected for the windows' scalloping
  uint32_t instance = 0;  ///< index + 1; 0: no target accounts for it
  uint32_t range_bin = 0, velocity_bin = 0;
};

struct SensingFrame {
  std::vector<float> range_doppler;  ///< W [range, velocity], mean over the pairs of ports; empty: not wanted
  std::vector<float> range_azimuth;  ///< W [range, azimuth], AzimuthMap; empty: not wanted
  std::vector<SensingDetection> detections;
  uint64_t saturated_samples = 0;
};

class OfdmSensing {
 public:
  /// The most pairs of a transmitting and a receiving element whose directions are searched.
  static constexpr size_t most_pairs = 1024;
  /// `name` is that of the channel, for messages. Throws UserError if the CFAR's cells do not fit the map, if
  /// there are too many pairs of elements, or if a range-azimuth map is wanted of elements that measure no
  /// azimuth.
  OfdmSensing(const std::string& name, const SensingConfig& config, const SensingWaveform& waveform,
              const SensingArrays& arrays);

  const RadarAxes& axes() const { return maps_->axes(); }
  /// Memory of the tables that the range-azimuth map needs.
  size_t table_bytes() const { return azimuth_map_ ? azimuth_map_->table_bytes() : 0; }
  const SensingWaveform& waveform() const { return waveform_; }
  /// Power of the noise in a sample of a port, W: k T_0 B F. 0: there is none.
  double noise_w() const;
  /// Returns the signal-to-noise ratio of a path of gain |a|^2 in the middle of its cell of the map; infinity
  /// without noise.
  double cell_snr(double gain) const;
  /// Returns the frame. `threads`: 0 uses all there are; the bytes do not depend on it.
  SensingFrame process(const SensingInput& input, uint32_t threads = 0) const;
  /// Returns what remains in a cell of a path of unit gain, as a power: the windows' responses at the offsets
  /// of its delay and Doppler shift, less the static mean.
  double response(const SensingTone& tone, uint32_t range_bin, uint32_t velocity_bin) const;

 private:
  void add_leakage(const RadarSeeds& seeds, std::span<std::complex<float>> cube) const;
  uint64_t convert(const RadarSeeds& seeds, uint32_t threads, std::span<std::complex<float>> cube) const;
  void remove_mean(uint32_t threads, std::span<std::complex<float>> cube) const;
  std::vector<float> whitened(std::span<const float> map) const;
  SensingDetection detection(const CfarPeak& peak, std::span<const float> map,
                             std::span<const std::complex<float>> spectrum, const SensingInput& input) const;
  Direction direction_of(const CfarPeak& peak, std::span<const std::complex<float>> spectrum) const;
  uint32_t instance_of(const CfarPeak& peak, std::span<const SensingTone> tones) const;

  SensingConfig config_;
  SensingWaveform waveform_;
  SensingArrays arrays_;
  std::unique_ptr<RadarMaps> maps_;  ///< of all pairs of ports; the maker below refers to it
  std::unique_ptr<Cfar> cfar_;
  std::unique_ptr<DetectionMaker> maker_;
  std::unique_ptr<DirectionFinder> finder_;
  std::unique_ptr<AzimuthMap> azimuth_map_;
  /// [velocities] share of the noise that the removal of the mean leaves in a bin; all 1 without it.
  std::vector<double> noise_left_;
};

}  // namespace greatx::rf
