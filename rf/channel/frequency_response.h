// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From paths to what a receiver measures: the frequency response at every pair of ports, and the impulse
// response.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/antenna.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// One end of the channel: an array and how it is turned (local_from_array; the local axes are the world's).
struct ArrayPose {
  AntennaArray array;
  dquat orientation{1.0, 0.0, 0.0, 0.0};
};

/// Where the channel is sampled.
struct ChannelGrid {
  double carrier_hz = 3.5e9;
  double subcarrier_spacing_hz = 30e3;
  uint32_t subcarriers = 256;
  uint32_t time_samples = 1;
  double time_spacing_s = 1e-3;

  /// Number of subcarrier k counted from the carrier: k - floor(N/2).
  double subcarrier_number(uint32_t k) const {
    return static_cast<double>(k) - static_cast<double>(subcarriers / 2);
  }
  size_t size_per_pair() const { return size_t{time_samples} * subcarriers; }
};

/// H_us(f, t) = (lambda/4 pi) sum_i C_{R,u}^H T_i C_{T,s} e^{j 2 pi (r_R . d_u + r_T . d_s)/lambda} e^{j 2 pi nu_i t}
///              e^{-j 2 pi (f_c + f) tau_i}                          (after 3GPP TR 38.901, eq. 7.5-22 and 7.5-28)
/// at f = subcarrier_number(k) * spacing and t = m * time_spacing; complex64 [rx_ant, tx_ant, time, subcarrier], C order.
/// d are the elements' positions, r_T and r_R the directions of departure and arrival (both pointing away from their array),
/// lambda the carrier's wavelength. C_T = F_T is the field pattern that a port radiates; C_R = conj(F_R), the conjugate of
/// what the receiving port would radiate, so that C_R^H = F_R^T is TR 38.901's transpose: by reciprocity a port takes up
/// what it radiates, and two antennas of one circular polarization see each other in full. For real patterns, which are all
/// but imported ones, conj(F) = F.
///
/// The array is met by a plane wave: each path has one direction and one delay for the whole array. Against a solution for
/// every element this costs an NMSE of some -14 dB at 5 m and -40 dB at 100 m (32 elements, 28 GHz).
///
/// The sum is in fp64 and in an order of the paths that depends on what they are, not on where they stand in `paths`: any
/// permutation gives the same bits. Phases are counted in turns and reduced exactly; each phasor is good to some 1e-15
/// before it is rounded to complex64. Delays are the paths' own: nothing is normalised.
std::vector<std::complex<float>> frequency_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                                    const ArrayPose& receiver, const ChannelGrid& grid);
/// The same before it is rounded.
std::vector<Complex> frequency_response_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                             const ArrayPose& receiver, const ChannelGrid& grid);

/// The transfer of a path at each subcarrier, [subcarriers][as Path::transfer].
using TransferSpectrum = std::vector<std::array<Complex, 4>>;

/// The same for walls and air that change over the band (rf/channel/dispersion.h): `spectra[i]` takes the place of the transfer
/// of `paths[i]`. lambda and the arrays' phases stay the carrier's.
std::vector<std::complex<float>> frequency_response(std::span<const Path> paths,
                                                    std::span<const TransferSpectrum> spectra,
                                                    const ArrayPose& transmitter, const ArrayPose& receiver,
                                                    const ChannelGrid& grid);
std::vector<Complex> frequency_response_fp64(std::span<const Path> paths,
                                             std::span<const TransferSpectrum> spectra,
                                             const ArrayPose& transmitter, const ArrayPose& receiver,
                                             const ChannelGrid& grid);

/// Number of values of a response: rx_ant * tx_ant * time * subcarrier.
size_t response_size(const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid);

/// Which paths are summed. Line of sight: the path without interactions (one through walls alone is not it).
enum class PathSelection : uint8_t { all, line_of_sight, others };
bool is_selected(const Path& path, PathSelection selection);

/// frequency_response() into memory of the caller's, [response_size()]: a batch of links is written where it shall lie.
/// The same bits. `spectra`: [paths], or none for the carrier's transfers. Thread-safe, as all of this file.
///
/// With line_of_sight and others the two responses add up to the whole one: to the rounding of complex64, 2^-23 of the
/// sum of the paths' amplitudes, not to the bit.
void frequency_response_into(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                             const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid,
                             std::span<std::complex<float>> out,
                             PathSelection selection = PathSelection::all);

/// h(tau) = sum_i a_i delta(tau - tau_i) about the carrier, at t = 0: H(f) = sum_i a_i e^{-j 2 pi f tau_i}.
struct ImpulseResponse {
  std::vector<std::complex<float>> amplitude;  ///< [paths, rx_ant, tx_ant], with e^{-j 2 pi f_c tau}
  std::vector<double> delay_s;                 ///< [paths]
  std::vector<double> doppler_hz;              ///< [paths]
};
/// In the order of `paths`.
ImpulseResponse impulse_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                 const ArrayPose& receiver, double carrier_hz);

}  // namespace greatx::rf
