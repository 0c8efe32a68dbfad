// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dual.h"

namespace greatx::rf {

/// The complex permittivity of liquid water, eps' - j eps'' (time convention e^{+j omega t}).
template <typename R>
struct WaterPermittivityOf {
  R stored = 1.0;  ///< eps'
  R lost = 0.0;    ///< eps''
};
using WaterPermittivity = WaterPermittivityOf<double>;
/// Returns the double-Debye model of ITU-R P.840-8 (2019), eq. 5 to 11, for up to 1000 GHz (H. J. Liebe, G.
/// A. Hufford, T. Manabe, "A model for the complex permittivity of water at frequencies below 1 THz", Int. J.
/// Infrared Millim. Waves 12(7), 1991).
template <typename R = double>
WaterPermittivityOf<R> water_permittivity(const Given<R>& frequency_hz, double temperature_k);

}  // namespace greatx::rf
