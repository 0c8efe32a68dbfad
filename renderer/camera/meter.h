// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Automatic exposure: each picture is metered by itself, so that no picture depends on another.
#pragma once

namespace greatx::render {

/// EV100 that a reflected-light meter sets for a mean luminance, cd/m^2: log2(L 100 / K) with K = 12.5 (ISO 2720;
/// Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH course 2014, section 5.1).
double metered_ev100(double luminance_cd_m2);

/// cd/m^2 that a stored radiance of 1 stands for under automatic exposure: L_max for grey of 18 % on the ground at this
/// illuminance, at least 1 lux. Halves then hold 2^-14 to 2^16 times that at full precision (docs/film.md).
double anchor_luminance(double ground_illuminance_lux);

}  // namespace greatx::render
