// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The room that a path needs: its Fresnel zone, as a tube of lines.
#pragma once

#include "view/overlay/path_story.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

/// The first Fresnel zone around a path: its radius is sqrt(wavelength d1 d2 / (d1 + d2)), with d1 and d2
/// along the path to both of its ends. A reflection and a wall keep the wave's curvature, so that the lengths
/// go on beyond them (image method). A diffraction and a scattering send out a wave of their own, so that a
/// zone ends there and another one begins. Records hold no tubes: this zone follows from the path's points
/// alone.
Shapes fresnel_shapes(const PathStory& story);

/// The radius of the first zone, m.
double fresnel_radius_m(double wavelength_m, double d1_m, double d2_m);

}  // namespace greatx::view
