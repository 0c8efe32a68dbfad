// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the materials that let a LiDAR's light through.
#pragma once

#include <optional>

#include "scene/material/material.h"
#include "shaders/shared/lidar.h"

namespace greatx::render {

/// Returns the index of soda-lime glass at a vacuum wavelength of 0.31 to 4.6 um: 1.5130 - 0.003169 w^2 +
/// 0.003962 w^-2, w in um (M. Rubin, "Optical properties of soda lime silica glasses", Solar Energy Materials
/// 12 (1985), pp. 275-288).
double glass_index(double wavelength_nm);

/// Returns the pane of a material, or nothing if it is none. A material is a pane of glass if
/// - the file says that it lets light through (KHR_materials_transmission, or alpha mode BLEND without a
///   texture), by the amount that the file states, or
/// - its radio layers are glass or clear acrylic of finite thickness, with layers of air between or none, and
///   its base colour has no texture and it gives off no light (a picture of a facade shows the rooms behind
///   its windows).
/// `reflectance` (of the surface itself: dirt, frosting) counts if the file states it for the wavelength.
/// Otherwise the pane is clean.
std::optional<shared::LidarPane> pane_of(const scene::Material& material, uint32_t wavelength_nm);

}  // namespace greatx::render
