// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/material/material.h"

namespace greatx::scene {

/// Returns the metal called `name` with eta' = 1 and its conductivity at rest, from 1 MHz to 1 THz, or
/// nothing if there is none. The conductivities are those of D. M. Pozar, "Microwave Engineering", 4th ed.,
/// Appendix F, at 20 degrees Celsius.
///
/// The conductivity of a metal is constant far below the damping frequency of its free electrons (E. Hagen
/// and H. Rubens, Annalen der Physik 316 (1903), 873). Fits of the Drude model give 2.2 THz for copper, 4.4
/// THz for silver, 6.4 THz for gold and 20 THz for aluminium (M. A. Ordal et al., Applied Optics 22 (1983),
/// 1099). At normal incidence a metal loses 2 sqrt(2 omega epsilon_0/sigma) of the power: 0.28 % for copper
/// at 1 THz. Drude's model gives a fifth less, which no path notices.
std::optional<RadioMedium> conductor_medium(const std::string& name);
/// Returns every name that conductor_medium knows.
std::vector<std::string> conductor_names();

}  // namespace greatx::scene
