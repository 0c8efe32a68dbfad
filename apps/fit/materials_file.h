// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes fitted materials as a sidecar that a scenario can use (docs/materials.md).
#pragma once

#include <filesystem>
#include <string>

#include "scene/description/scene.h"
#include "sim/fit/assess.h"

namespace greatx::apps {

/// Returns the radio fields of a material as YAML on one line, complete: whatever other sources say of it,
/// the result is this material.
std::string radio_fields_line(const scene::Material& material);

/// Returns the text of the sidecar: that of `before` (empty: the scene has none), with an entry for every
/// fitted material, and comments that give each fitted value with its deviation.
std::string fitted_sidecar(const std::filesystem::path& before, const scene::Scene& scene,
                           const sim::FitModel& model, const sim::FitAssessment& assessment,
                           const std::string& title);

}  // namespace greatx::apps
