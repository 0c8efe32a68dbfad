// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/import/imported.h"
#include "scene/import/mitsuba.h"
#include "scene/import/mitsuba_xml.h"

namespace greatx::scene {

/// Returns the name without the prefix that exporters and Sionna RT give it: "mat-itu_wood" -> "itu_wood".
std::string without_prefix(std::string name, const std::string& prefix);

/// Reads the material of an outermost <bsdf> (others may be nested in it). Throws UserError if it has no
/// radio fields.
ImportedMaterial read_mitsuba_material(const MitsubaXml& xml, const pugi::xml_node& bsdf,
                                       const MitsubaOptions& options);

}  // namespace greatx::scene
