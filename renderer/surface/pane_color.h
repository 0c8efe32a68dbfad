// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells which materials are panes to a camera, and their colours.
#pragma once

#include <optional>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::render {

/// Returns the share of the light that a camera's pane lets through beside its reflection, for each linear
/// channel; nothing if the material is no pane. A pane states a transmission (KHR_materials_transmission, or
/// 1 - alpha of a BLEND material), is no metal, no rougher than shared::pane_most_roughness, and has neither
/// holes nor a texture of its colour or roughness. KHR_materials_transmission tints by the base colour;
/// alpha does not.
std::optional<vec3> pane_color(const scene::PbrMaterial& material);

/// Returns the base colour of what a material reflects diffusely: without the light that a pane lets through.
vec3 solid_color(const scene::PbrMaterial& material);

/// Returns whether a material is a pane before a lit room: its name begins with "lit_pane". Such a pane glows
/// with the light of the room behind it where a camera does not look through it, and as far as it does not.
bool is_lit_pane(const scene::Material& material);

/// Returns, for each material of a scene, whether it is a pane to a camera. Without `wanted`, none is.
std::vector<bool> pane_materials(const scene::Scene& scene, bool wanted = true);

}  // namespace greatx::render
