// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How a radar's frame is made, stage by stage (data flows one way):
//
//   rays over the field of view ─► EchoPass (GPU; EchoTracer where that is a CPU): hits, bounce by bounce, of every ray tube
//     ─► physical optics of each tube (fp64, host): what it sends back to the receiver
//     ─► Echo list: tubes merged into scatterers                              ── rf/radar/echoes ends here
//     ─► beat signal, cube [rx, tx, chirp, sample] ─► noise                   ── rf/radar/signal: needs no device
//     ─► windows, transforms ─► range-Doppler, range-azimuth maps ─► CFAR ─► detections
//
// This header is where the two meet.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::rf {

/// Delay of an echo over the slots of a frame, seconds from the transmitter's origin to the receiver's. `t` counts from the
/// frame's start.
struct DelayTrack {
  /// tau(t) = sum c_k (t - mid)^k, over the slots of its list.
  std::array<double, 4> coefficients{};
  double mid_s = 0.0;
  /// Of scatterers that turn too fast for a cubic (rotor blades): row of EchoList::tables; -1: none.
  int32_t table = -1;
};

/// What one scatterer gives back: one ray tube, or tubes merged because no output can tell them apart.
struct Echo {
  /// Field at the receiver's port over that of the transmitter's port, with both elements' patterns and polarizations, all
  /// losses and the spreading, such that |amplitude|^2 = P_r/P_t (P_r = P_t G^2 lambda^2 sigma/((4 pi)^3 R^4) for a
  /// monostatic radar); without the phase e^{-j 2 pi f_c tau}, which the beat signal adds in turns.
  std::complex<double> amplitude;
  dvec3 departure{0.0};  ///< unit, world axes, leaving the transmitter
  dvec3 arrival{0.0};    ///< unit, world axes, pointing from the receiver back along the path
  DelayTrack delay;
  dvec3 point{0.0};  ///< local coordinates: where the echo comes from (its last vertex), amplitude-weighted
  uint32_t instance = 0;  ///< index into Scene::instances + 1, of the last vertex; 0: none
  uint32_t material = 0;  ///< index into Scene::materials + 1
  uint32_t bounces = 1;   ///< surfaces met
};

/// The echoes of slots [first_slot, first_slot + slots) of a frame: the whole frame if the scene is traced once.
struct EchoList {
  uint32_t first_slot = 0, slots = 0;
  std::vector<Echo> echoes;  ///< in a total order that does not depend on threads
  /// [tables, slots] delay and its rate (s, s/s) at the start of each slot.
  std::vector<std::array<double, 2>> tables;
};

}  // namespace greatx::rf
