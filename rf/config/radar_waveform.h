// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the waveform of a radar (docs/radar_waveforms.md). Plain data.
#pragma once

#include <cstdint>

#include "core/units.h"

namespace greatx::rf {

enum class RadarModulation : uint32_t {
  fmcw,     ///< linear ramps
  stepped,  ///< frequency steps, one sample at each
  ofdm,     ///< multicarrier symbols with a cyclic prefix
  pmcw      ///< a binary phase code that is repeated
};
enum class RadarMultiplexing : uint32_t {
  time,    ///< the transmitters send in turn (TDM)
  doppler  ///< all send at once, each with a phase ramp from slot to slot (DDM)
};
enum class RadarCode : uint32_t { m_sequence, apas };

/// Describes a train of equal slots. A slot is a ramp, a sweep of frequency steps, a symbol or a block of
/// repeated codes.
///
/// All waveforms share one form. Sample n of a slot stands for the frequency f_c + S u, u = (n - N/2)/f_s. An
/// echo of delay tau has the phase
///   f_c tau + S u tau - square S tau^2/2   turns,
/// with tau at the time of the sample (sweeps()) or at the middle of the slot. For `fmcw` that is the beat
/// signal itself. For `stepped` the frequencies are held, so that the term in tau^2 is absent. For `ofdm` and
/// `pmcw` the samples are the spectral lines of a slot after division by the symbols, or after correlation
/// with the code; S = B^2/N then only says that line n lies at n B/N.
///
/// With time multiplexing transmitter s % transmitters sends slot s as its own chirp s / transmitters. With
/// Doppler multiplexing every slot is a chirp of all transmitters. A frame begins at the start of slot 0.
/// Sample n of slot s is taken at
///   t = s interval_s + adc_start_s + n / sample_rate_hz.
/// The frequency is `carrier_hz` at sample samples/2 (rounded down), the middle of the samples. It is f_c in
/// every formula and gives every wavelength.
struct RadarWaveform {
  double carrier_hz = 77e9;
  double slope_hz_per_s = 20e12;  ///< S
  double chirp_s = 50e-6;         ///< duration of a slot's signal
  double interval_s = 60e-6;      ///< T_c, from the start of one slot to the start of the next
  double adc_start_s = 5e-6;      ///< from the start of a slot to its first sample
  double sample_rate_hz = 6e6;    ///< rate of complex samples (I and Q)
  uint32_t samples = 256;         ///< N, samples of a slot
  uint32_t slots = 512;           ///< slots of a frame, of all transmitters
  uint32_t transmitters = 4;

  RadarModulation modulation = RadarModulation::fmcw;
  RadarMultiplexing multiplexing = RadarMultiplexing::time;
  uint32_t empty_bands = 1;    ///< Doppler bands that no transmitter has (Doppler multiplexing)
  double integration_s = 0.0;  ///< `stepped`: the time over which a sample is the mean, about its instant
  RadarCode code = RadarCode::m_sequence;  ///< `pmcw`
  uint32_t averages = 1;                   ///< `pmcw`: repetitions of the code whose mean is a slot

  double wavelength_m() const { return speed_of_light / carrier_hz; }
  /// Returns the number of slots in which every transmitter sends once.
  uint32_t loop() const { return multiplexing == RadarMultiplexing::time ? transmitters : 1; }
  uint32_t chirps() const { return slots / loop(); }                    ///< M, of each transmitter
  uint32_t middle_sample() const { return samples / 2; }                ///< where the frequency is carrier_hz
  double sampled_s() const { return samples / sample_rate_hz; }         ///< N/f_s
  double bandwidth_hz() const { return slope_hz_per_s * sampled_s(); }  ///< B, of the sampled part
  /// Returns c/2B: the distance of two ranges whose tones differ by one turn over the samples.
  double range_bin_m() const { return speed_of_light / (2.0 * bandwidth_hz()); }
  /// Returns N c/2B = f_s c/2S, which is R_max because samples are complex. Ranges are known up to multiples
  /// of it.
  double range_span_m() const { return samples * range_bin_m(); }
  /// Returns the time T from one chirp of a transmitter to its next.
  double repetition_s() const { return loop() * interval_s; }
  /// Returns lambda/(2 M T), T = repetition_s().
  double velocity_bin_m_s() const { return wavelength_m() / (2.0 * chirps() * repetition_s()); }
  /// Returns lambda/(2 T). Velocities are known up to multiples of it. Outputs lie in [-v_max, v_max) with
  /// v_max half of it.
  double velocity_span_m_s() const { return wavelength_m() / (2.0 * repetition_s()); }
  double slot_start_s(uint32_t slot) const { return slot * interval_s; }
  /// Returns the time of the middle sample of `slot`.
  double slot_middle_s(uint32_t slot) const {
    return slot_start_s(slot) + adc_start_s + middle_sample() / sample_rate_hz;
  }
  /// Returns the time halfway between the first and the last slot's middle, to which a detection's range
  /// refers.
  double frame_middle_s() const { return 0.5 * (slot_middle_s(0) + slot_middle_s(slots - 1)); }

  /// The samples of a slot are taken one after the other, and targets move meanwhile.
  bool sweeps() const {
    return modulation == RadarModulation::fmcw || modulation == RadarModulation::stepped;
  }
  /// The samples of a slot are the lines of a spectrum (`ofdm`, `pmcw`).
  bool coded() const { return !sweeps(); }
  /// Returns the slope in the term S tau^2/2, which only ramps have.
  double squared_slope() const { return modulation == RadarModulation::fmcw ? slope_hz_per_s : 0.0; }
  /// Returns the frequency by which the phase of an echo turns from slot to slot.
  double doppler_hz(double delay_s, double rate) const {
    return (carrier_hz - squared_slope() * delay_s) * rate;
  }
  /// Returns the frequency of an echo's tone over the samples of a slot.
  double tone_hz(double delay_s, double rate) const {
    return slope_hz_per_s * delay_s + (sweeps() ? doppler_hz(delay_s, rate) : 0.0);
  }
  /// Returns the bandwidth of the noise in a sample.
  double noise_bandwidth_hz() const {
    return modulation == RadarModulation::stepped ? 1.0 / integration_s : sample_rate_hz / averages;
  }
  /// Returns the delay beyond which an echo misses the first samples of its slot.
  double latest_delay_s() const {
    if (modulation == RadarModulation::stepped) return adc_start_s - 0.5 * integration_s;
    return adc_start_s - 0.5 * (averages - 1) * sampled_s();
  }
  /// Returns the row of the cube that `receiver` fills in `slot`: [receivers, loop, chirps].
  uint32_t row(uint32_t receiver, uint32_t slot) const {
    return (receiver * loop() + slot % loop()) * chirps() + slot / loop();
  }
  /// Returns the number of Doppler bands: those of the transmitters and the empty ones.
  uint32_t bands() const {
    return multiplexing == RadarMultiplexing::doppler ? transmitters + empty_bands : 1;
  }
  /// Returns the phase of a transmitter in a slot, in turns of the received tone.
  double band_turns(uint32_t transmitter, uint32_t slot) const {
    return double(uint64_t{transmitter} * slot % bands()) / bands();
  }
};

/// These describe the other waveforms as a user does. What waveform_of() returns has one transmitter, and the
/// number of slots is still to be set.
struct SteppedFrequency {
  double carrier_hz = 77e9, step_hz = 1e6;
  double step_s = 1e-6;  ///< from one step to the next
  double settle_s =
      0.5e-6;  ///< from the start of a step to that of its integration, which ends with the step
  uint32_t steps = 128;
  double interval_s = 0.0;  ///< from sweep to sweep; 0: steps step_s
};
struct OfdmSymbols {
  double carrier_hz = 77e9, spacing_hz = 500e3;
  uint32_t subcarriers = 512;
  double prefix_s = 1e-6;
  double interval_s = 0.0;  ///< from symbol to symbol; 0: prefix and symbol
};
struct PhaseCode {
  double carrier_hz = 77e9, chip_rate_hz = 500e6;
  RadarCode code = RadarCode::m_sequence;
  uint32_t chips = 511;
  uint32_t averages = 8;
  double interval_s = 0.0;  ///< from block to block; 0: one repetition ahead of the averages, and these
};
RadarWaveform waveform_of(const SteppedFrequency& stepped);
RadarWaveform waveform_of(const OfdmSymbols& symbols);
RadarWaveform waveform_of(const PhaseCode& code);

/// Says whether there is a code of this length: 2^k - 1 with k from 5 to 16 for an m-sequence; 2 (p + 1) with
/// an odd prime p for an almost perfect sequence, from 16 to 65 536.
bool code_exists(RadarCode code, uint32_t chips);

}  // namespace greatx::rf
