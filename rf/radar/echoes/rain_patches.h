// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds what raindrops send back to the patches of a radar (docs/radar_rain.md).
//
// The field of view is divided into columns, four in each beam of the array. A column has one scatterer in
// each range bin, at a random place within the volume dV between two ranges, with a circular Gaussian
// amplitude of the mean power P_r/P_t = G_t G_r lambda^2 eta dV/((4 pi)^3 R^4) (R. J. Doviak, D. S. Zrnic,
// "Doppler Radar and Weather Observations", 2nd ed., 4.4). A column ends where its ray meets the scene. Drops
// are spheres: they send the polarization back that they receive.
#pragma once

#include <cstdint>

#include "rf/antenna/element.h"
#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/signal/patches.h"

namespace greatx::rf {

/// Holds what the rain around a radar needs to know of it.
struct RainRadar {
  const EchoOptions& options;
  TurnedElement transmitter, receiver;
  Pose pose;              ///< of both, in local coordinates; x is boresight
  uint32_t own_body = 0;  ///< rays do not see it
  double wavelength_m = 0.0;
};

/// Appends the rain of a frame to the patches of the slots of `motion`. The draws follow from
/// (EchoOptions::seed, EchoMotion::frame) alone.
void add_rain(const RainRadar& radar, const FacetWorld& world, const EchoTracer& tracer,
              const EchoMotion& motion, PatchList& patches);

}  // namespace greatx::rf
