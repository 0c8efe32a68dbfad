// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads scenes of Mitsuba 3 (XML with PLY meshes) whose materials are radio materials in the way of Sionna RT
// (0.19 to 2.x): BSDFs called itu_NAME or mat-itu_NAME, and the plugins itu-radio-material and
// radio-material.
#pragma once

#include <filesystem>

#include "scene/import/imported.h"

namespace greatx::scene {

struct MitsubaOptions {
  /// The thickness of materials whose file gives none, m, > 0. Sionna RT takes 0.1 m for them.
  double default_thickness_m = 0.1;
};

/// Reads shapes of type ply (also inside of merge) with their to_world transforms and materials. Sensors,
/// emitters, integrators and textures are left out. PLY files must lie in the XML file's folder. Throws
/// UserError with file:line and the expected content for broken XML, other shapes, a material without radio
/// fields, and a missing or broken PLY file.
ImportedScene import_mitsuba(const std::filesystem::path& xml, const MitsubaOptions& options);

}  // namespace greatx::scene
