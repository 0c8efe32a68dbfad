// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/random.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// Adds a hip roof over a rectangle about the origin with the half sizes `half`, and returns the height of
/// its top. The roof is a closed solid that reaches 6 cm below `eaves`, into the body that it covers.
double add_hip_roof(MeshBuilder& mesh, const dvec2& half, double eaves, int tiles);
/// Adds a mansard roof in the same way: steep slates with dormers below a flat top.
double add_mansard(MeshBuilder& mesh, const dvec2& half, double eaves, RandomStream& looks);

/// Adds sky-lights, vents and solar panels to a flat roof, where they fit within `roof` and keep a distance
/// from the points `taken`.
void add_roof_details(MeshBuilder& mesh, const std::vector<dvec2>& roof, std::vector<dvec2> taken,
                      const dvec2& along, double roof_z, RandomStream& looks);

/// Returns whether p lies in the polygon.
bool inside(const std::vector<dvec2>& polygon, const dvec2& p);

}  // namespace greatx::scene::generator
