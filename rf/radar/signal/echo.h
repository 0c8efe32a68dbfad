// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the echo list, which connects rf/radar/echoes with rf/radar/signal. A radar's frame is made in
// stages, and data flows in one direction:
//
//   rays over the field of view
//     ─► EchoPass (GPU; EchoTracer where that is a CPU): hits of every ray tube, bounce by bounce
//     ─► physical optics of each tube (fp64, host): the field that it sends back to the receiver
//     ─► Echo list: tubes merged into scatterers                  ── rf/radar/echoes ends here
//     ─► beat signal, cube [rx, tx, chirp, sample] ─► noise       ── rf/radar/signal: needs no device
//     ─► windows, transforms ─► range-Doppler, range-azimuth maps ─► CFAR ─► detections
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/radar/signal/patches.h"

namespace greatx::rf {

/// Describes the delay of an echo over the slots of a frame: seconds from the transmitter's origin to the
/// receiver's. `t` counts from the start of the frame.
struct DelayTrack {
  /// The cubic tau(t) = sum c_k (t - mid)^k, valid over the slots of the list.
  std::array<double, 4> coefficients{};
  double mid_s = 0.0;
  /// Row of EchoList::tables for a scatterer that turns too fast for a cubic (rotor blades); -1: none.
  int32_t table = -1;
};

/// Describes the echo of one scatterer: one ray tube, or tubes that were merged because no output can tell
/// them apart.
struct Echo {
  /// Ratio of the field at the receiver's port to that at the transmitter's port, with the patterns and
  /// polarizations of both elements, all losses and the spreading. |amplitude|^2 = P_r/P_t; for a monostatic
  /// radar P_r = P_t G^2 lambda^2 sigma/((4 pi)^3 R^4). The phase e^{-j 2 pi f_c tau} is not included; the
  /// beat signal adds it and computes it in turns.
  std::complex<double> amplitude;
  dvec3 departure{0.0};  ///< unit vector, world axes, leaving the transmitter
  dvec3 arrival{0.0};    ///< unit vector, world axes, pointing from the receiver back along the path
  DelayTrack delay;
  dvec3 point{0.0};       ///< last vertex of the path of the strongest tube, local coordinates
  uint32_t instance = 0;  ///< index into Scene::instances + 1 of the last vertex; 0: none
  uint32_t material = 0;  ///< index into Scene::materials + 1
  uint32_t bounces = 1;   ///< number of surfaces met
};

/// Holds the echoes of slots [first_slot, first_slot + slots) of a frame: the whole frame if the scene is
/// traced once.
struct EchoList {
  uint32_t first_slot = 0, slots = 0;
  std::vector<Echo> echoes;  ///< in a total order that does not depend on threads
  /// [tables, slots] delay (s) and its rate (s/s) at the start of each slot.
  std::vector<std::array<double, 2>> tables;
  PatchList patches;  ///< of rough surfaces
};

}  // namespace greatx::rf
