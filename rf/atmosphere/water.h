// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx::rf {

/// The complex permittivity of liquid water, eps' - j eps'' (time convention e^{+j omega t}).
struct WaterPermittivity {
  double stored = 1.0;  ///< eps'
  double lost = 0.0;    ///< eps''
};
/// Returns the double-Debye model of ITU-R P.840-8 (2019), eq. 5 to 11, for up to 1000 GHz (H. J. Liebe, G.
/// A. Hufford, T. Manabe, "A model for the complex permittivity of water at frequencies below 1 THz", Int. J.
/// Infrared Millim. Waves 12(7), 1991).
WaterPermittivity water_permittivity(double frequency_hz, double temperature_k);

}  // namespace greatx::rf
