// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From peaks of the range-Doppler map to detections.
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

/// Power gain of an element towards a unit direction in its array's frame; 1: isotropic.
using RadarGain = std::function<double(const dvec3&)>;

struct RadarDetection {
  double range_m =
      0.0;  ///< half the way from transmitter to receiver, at frame_middle_s(), in [-1/2 bin, range_span_m())
  double velocity_m_s = 0.0;  ///< its rate, positive receding, in [-v_max, v_max)
  double azimuth = 0.0;       ///< rad, in the receiving array's frame
  double elevation = 0.0;     ///< rad
  dvec3 position_m{0.0};      ///< in that frame, from the range and both angles
  double snr = 0.0;           ///< power ratio: cell less noise by noise, mean of the virtual antennas
  double power_w = 0.0;       ///< received, of the beam, with the windows' scalloping mended
  double rcs_m2 = 0.0;        ///< by the radar equation, both arrays' gains towards the target
  uint32_t instance = 0;      ///< index + 1; 0: nothing that sends an echo there, a false alarm
  uint32_t range_bin = 0, velocity_bin = 0;
};

/// Where both arrays stand while a frame is sent.
struct RadarGeometry {
  RadarAttitude attitude;
  dvec3 baseline_m{0.0};  ///< from the receiver's origin to the transmitter's, world axes; 0: monostatic
};

class DetectionMaker {
 public:
  DetectionMaker(const RadarSignalConfig& config, const RadarMaps& maps, RadarGain transmit_gain,
                 RadarGain receive_gain);

  /// Drops the peaks that a stronger one's windows leave there (twice the highest response within half a bin
  /// of that offset); returns how many.
  size_t drop_sidelobes(std::vector<CfarPeak>& peaks, std::span<const float> map) const;
  /// [peaks]; spectrum [rx, tx, range, velocity].
  std::vector<RadarDetection> make(std::span<const CfarPeak> peaks, std::span<const float> map,
                                   std::span<const std::complex<float>> spectrum,
                                   std::span<const EchoList> lists, const RadarGeometry& geometry,
                                   uint32_t threads) const;

 private:
  struct Offsets {
    double range, velocity;  ///< bins from the peak's cell
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
