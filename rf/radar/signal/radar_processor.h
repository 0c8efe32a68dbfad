// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A radar's frame, from its echoes to its detections (echo.h draws the stages): the one way in.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/cfar.h"
#include "rf/radar/signal/detections.h"
#include "rf/radar/signal/maps.h"
#include "rf/radar/signal/receiver.h"

namespace greatx::rf {

struct RadarFrameInput {
  std::span<const EchoList> lists;           ///< in order of slots, without overlap; slots of none are silent
  std::span<const RadarAttitude> attitudes;  ///< of each list, or one for all
  dvec3 baseline_m{0.0};                     ///< from the receiver's origin to the transmitter's, world axes
  RadarSeeds seeds;
};

struct RadarReport {
  uint64_t echoes = 0;  ///< of all lists
  BeatReport beat;
  uint64_t saturated_samples = 0;  ///< beyond the converter's full scale
  uint64_t late_echoes =
      0;  ///< delayed beyond adc_start_s: their first samples are of no ramp in a real receiver
  uint64_t sidelobes = 0;  ///< peaks left out for a stronger one's windows put them there
};

struct RadarFrame {
  RadarCube cube;  ///< sqrt(W) [rx, tx, chirp, sample]
  std::vector<float>
      range_doppler;  ///< W [range, velocity], mean of the virtual antennas; empty if not asked
  std::vector<float> range_azimuth;        ///< W [range, azimuth]; empty if not asked
  std::vector<RadarDetection> detections;  ///< in order of range bin, then velocity bin
  RadarReport report;
};

/// Made once for a radar; process() may run on many threads at once.
class RadarProcessor {
 public:
  /// `name`: the radar's, for messages. A configuration that check() refuses is a broken contract.
  RadarProcessor(std::string name, const RadarSignalConfig& config, RadarGain transmit_gain,
                 RadarGain receive_gain);
  RadarProcessor(const RadarProcessor&) = delete;
  RadarProcessor& operator=(const RadarProcessor&) = delete;

  const RadarSignalConfig& config() const { return config_; }
  const RadarAxes& axes() const { return maps_.axes(); }
  const RadarMaps& maps() const { return maps_; }

  /// threads: 0, all there are; the bytes do not depend on it. Throws UserError for echoes of no use
  /// (check_echoes()).
  RadarFrame process(const RadarFrameInput& input, uint32_t threads = 0) const;

 private:
  std::string name_;
  RadarSignalConfig config_;
  BeatSynthesizer synthesizer_;
  RadarMaps maps_;
  std::optional<Cfar> cfar_;
  std::optional<DetectionMaker> maker_;
};

}  // namespace greatx::rf
