// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes a radar's frame, from its echoes to its detections. This is the only entry point; echo.h shows the
// stages.
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
#include "rf/radar/signal/interference.h"
#include "rf/radar/signal/maps.h"
#include "rf/radar/signal/patches.h"
#include "rf/radar/signal/receiver.h"
#include "rf/radar/signal/symbols.h"

namespace greatx::rf {

struct RadarFrameInput {
  std::span<const EchoList> lists;  ///< in the order of slots, without overlap; slots of no list are silent
  std::span<const RadarAttitude> attitudes;  ///< one per list, or one for all
  dvec3 baseline_m{0.0};                     ///< from the receiver's origin to the transmitter's, world axes
  RadarSeeds seeds;
  std::span<const Interferer> interferers = {};  ///< frames of other radars

  const RadarAttitude& attitude(size_t list) const { return attitudes[attitudes.size() == 1 ? 0 : list]; }
};

struct RadarReport {
  uint64_t echoes = 0;   ///< number of echoes of all lists
  uint64_t patches = 0;  ///< number of patches of all lists
  BeatReport beat;
  uint64_t saturated_samples = 0;  ///< samples beyond the full scale of the converter
  /// Echoes delayed beyond latest_delay_s(). In a real receiver their first samples belong to no slot.
  uint64_t late_echoes = 0;
  uint32_t terms = 1;                            ///< terms of a coded waveform (Symbols)
  std::vector<InterferenceReport> interference;  ///< of each of the interferers
  uint64_t sidelobes = 0;                        ///< peaks left out as sidelobes of a stronger peak's windows
};

struct RadarFrame {
  RadarCube cube;  ///< sqrt(W) [rx, tx, chirp, sample]; [rx, 1, chirp, sample] with Doppler multiplexing
  /// W [range, velocity], mean of the virtual antennas; empty if not requested.
  std::vector<float> range_doppler;
  std::vector<float> range_azimuth;        ///< W [range, azimuth]; empty if not requested
  std::vector<RadarDetection> detections;  ///< in the order of range bin, then velocity bin
  RadarReport report;
};

/// Processes the frames of one radar. It is made once; process() may run on many threads at once.
class RadarProcessor {
 public:
  /// `name` is the name of the radar for messages. Requires a configuration that check() accepts.
  RadarProcessor(std::string name, const RadarSignalConfig& config, RadarGain transmit_gain,
                 RadarGain receive_gain);
  RadarProcessor(const RadarProcessor&) = delete;
  RadarProcessor& operator=(const RadarProcessor&) = delete;

  const RadarSignalConfig& config() const { return config_; }
  const RadarAxes& axes() const { return maps_.axes(); }
  const RadarMaps& maps() const { return maps_; }

  /// Returns the frame. `threads`: 0 uses all there are; the bytes do not depend on it. Throws UserError for
  /// echoes that cannot be used (check_echoes()).
  RadarFrame process(const RadarFrameInput& input, uint32_t threads = 0) const;

 private:
  /// Adds the echoes of `timely`, the patches and the leakage of a frame to a cube.
  void add_echoes(const RadarFrameInput& input, std::span<const EchoList> timely, const PhaseWalk* walk,
                  uint32_t term, uint32_t threads, std::span<std::complex<float>> cube,
                  BeatReport& report) const;
  /// Returns what the receiver takes in, without its noise: samples, or the signal of symbols.
  RadarCube received(const RadarFrameInput& input, uint32_t threads, RadarReport& report) const;
  void detect(const RadarFrameInput& input, std::span<const std::complex<float>> spectrum, uint32_t threads,
              RadarFrame& frame) const;

  std::string name_;
  RadarSignalConfig config_;
  BeatSynthesizer synthesizer_;
  PatchSynthesizer patches_;
  std::optional<Symbols> symbols_;
  RadarMaps maps_;
  std::optional<Cfar> cfar_;
  std::optional<DetectionMaker> maker_;
};

}  // namespace greatx::rf
