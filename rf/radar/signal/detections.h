// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the peaks of the range-Doppler map into detections.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/cfar.h"
#include "rf/radar/signal/direction_finder.h"
#include "rf/radar/signal/maps.h"

namespace greatx::rf {

/// The power gain of an element towards a unit direction in the frame of its array; 1 is isotropic.
using RadarGain = std::function<double(const dvec3&)>;

struct RadarDetection {
  /// Half the path length from the transmitter over the target to the receiver at frame_middle_s(), in
  /// [-1/2 bin, range_span_m()).
  double range_m = 0.0;
  double velocity_m_s = 0.0;  ///< rate of range_m, positive receding, in [-v_max, v_max)
  double azimuth = 0.0;       ///< rad, in the frame of the receiving array
  double elevation = 0.0;     ///< rad
  dvec3 position_m{0.0};      ///< in the same frame, from the range and both angles
  double snr = 0.0;           ///< (power of the cell - noise)/noise, mean of the virtual antennas
  /// Received power of the beam, corrected for the windows' scalloping and for symbol_gain().
  double power_w = 0.0;
  double rcs_m2 = 0.0;    ///< by the radar equation with the gains of both arrays towards the target
  uint32_t instance = 0;  ///< index + 1; 0: no instance sends an echo there (a false alarm)
  uint32_t range_bin = 0, velocity_bin = 0;
};

/// Describes where both arrays are during a frame.
struct RadarGeometry {
  RadarAttitude attitude;
  dvec3 baseline_m{0.0};  ///< from the receiver's origin to the transmitter's, world axes; 0: monostatic
};

class DetectionMaker {
 public:
  DetectionMaker(const RadarSignalConfig& config, const RadarMaps& maps, RadarGain transmit_gain,
                 RadarGain receive_gain);

  /// Removes the peaks that are sidelobes of a stronger peak's windows: those below twice the highest
  /// response of the windows within half a bin of their offset. With Doppler multiplexing the offset is that
  /// between the places in their bands. Returns their number.
  size_t drop_sidelobes(std::vector<CfarPeak>& peaks, std::span<const float> map) const;
  /// Returns the detections, [peaks]. `spectrum` is [rx, tx, range, velocity].
  std::vector<RadarDetection> make(std::span<const CfarPeak> peaks, std::span<const float> map,
                                   std::span<const std::complex<float>> spectrum,
                                   std::span<const EchoList> lists, const RadarGeometry& geometry,
                                   uint32_t threads) const;

 private:
  struct Offsets {
    double range, velocity;  ///< bins from the cell of the peak
  };
  Offsets offsets(const CfarPeak& peak, std::span<const float> map) const;
  void place(RadarDetection& detection, const Offsets& at, const RadarGeometry& geometry) const;

  RadarSignalConfig config_;
  const RadarMaps& maps_;
  DirectionFinder finder_;
  std::vector<double> range_envelope_, doppler_envelope_;  ///< by distance in bins
  RadarGain transmit_gain_, receive_gain_;
};

}  // namespace greatx::rf
