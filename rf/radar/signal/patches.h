// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the patches of rough surfaces that a radar sees, and adds them to its beat signal.
//
// A street has a hundred thousand patches, none of which stands out. Their tones are added together: the
// frame is cut into blocks of chirps within which every patch has a constant rate, and a two-dimensional
// non-uniform fast Fourier transform (type 1) makes each block from delays and rates,
//   s(v, m, n) = sum conj(a) sqrt(P_t) e^{j 2 pi [f_c tau - S tau^2/2 + f_r u_n + nu t_m]},
//   f_r = S tau + nu,   nu = (f_c - S tau) d tau/dt,
// with tau at the middle of the block (beat.h has the signal of one echo; this is the same to first order).
// The terms in S tau^2 and the nu of f_r are those of ramps (RadarWaveform).
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/radar_config.h"

namespace greatx::rf {

class PhaseWalk;
struct RadarAttitude;
using RadarCube = std::vector<std::complex<float>>;

/// Holds patches by columns. Amplitudes, departures and arrivals are those of Echo.
struct PatchList {
  std::vector<float> re, im;             ///< amplitude
  std::vector<vec3> departure, arrival;  ///< unit vectors, world axes; no arrivals: the same as departures
  std::vector<uint32_t> instance;        ///< index into Scene::instances + 1
  uint32_t blocks = 1;
  /// [blocks, patches] delay (s) and its rate (s/s) at the middle of each block.
  std::vector<double> delay_s, rate;

  size_t size() const { return re.size(); }
  bool empty() const { return re.empty(); }
  const vec3& arrival_of(size_t i) const { return arrival.empty() ? departure[i] : arrival[i]; }
};

/// Chirps [first, last) of a block of a list, and the time of its middle in the frame.
struct PatchBlock {
  uint32_t first = 0, last = 0;
  double middle_s = 0.0;
};
/// Returns block `block` of `blocks` of the chirps of slots [first_slot, first_slot + slots), which begin and
/// end with the first and the last transmitter (where these send in turn).
PatchBlock patch_block(const RadarWaveform& waveform, uint32_t first_slot, uint32_t slots, uint32_t blocks,
                       uint32_t block);

/// Returns the number of blocks for which two phases that are left out stay below `largest_patch_phase` rad
/// at the corners of a block: that of the range that a patch crosses within the block, and that of the change
/// of its rate. `rate` is the largest |d tau/dt|, `curvature_per_s` the largest |d^2 tau/dt^2|.
uint32_t patch_blocks(const RadarWaveform& waveform, uint32_t slots, double rate, double curvature_per_s);
inline constexpr double largest_patch_phase = 0.25;

/// Adds patches to cubes. The error of each sample is at most 1.5e-3 of the sum of the amplitudes of the
/// patches, plus what three simplifications make of each patch:
/// - Within a block the rate is constant, and the range stays where it is (patch_blocks()).
/// - The range of a patch is the same for all antennas. A patch beside the boresight of an array of length D
///   may be off by D/2 at its ends; the phase there is exact at the carrier.
/// The bytes do not depend on the number of threads.
class PatchSynthesizer {
 public:
  explicit PatchSynthesizer(const RadarSignalConfig& config);
  ~PatchSynthesizer();
  PatchSynthesizer(PatchSynthesizer&&) noexcept;

  /// Adds the patches of slots [first_slot, first_slot + slots) to the cube [receivers, transmitters, chirps,
  /// samples]. `walk` may be null. `term` is that of BeatSynthesizer::add().
  void add(const PatchList& patches, uint32_t first_slot, uint32_t slots, const RadarAttitude& attitude,
           const PhaseWalk* walk, uint32_t threads, std::span<std::complex<float>> cube,
           uint32_t term = 0) const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace greatx::rf
