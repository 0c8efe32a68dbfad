// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/random.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// Roofs over a rectangle of these half sizes about the origin, closed solids that reach 6 cm below `eaves`;
/// what they stand on is hidden in them. Return their height.
double add_hip_roof(MeshBuilder& mesh, const dvec2& half, double eaves, int tiles);
/// Steep slates with dormers below a flat top.
double add_mansard(MeshBuilder& mesh, const dvec2& half, double eaves, RandomStream& looks);

/// Sky-lights, vents and solar panels on a flat roof, where they fit within `roof` and clear of `taken` (m
/// from the spots' middles).
void add_roof_details(MeshBuilder& mesh, const std::vector<dvec2>& roof, std::vector<dvec2> taken,
                      const dvec2& along, double roof_z, RandomStream& looks);

/// Whether p lies in the polygon.
bool inside(const std::vector<dvec2>& polygon, const dvec2& p);

}  // namespace greatx::scene::generator
