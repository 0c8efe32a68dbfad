// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the materials of a model.
#pragma once

#include <string>
#include <vector>

#include "scene/check/check.h"

namespace greatx::scene::check {

/// Returns
///   no_radio         materials that a mesh uses and that have no radio properties (a fault, if `radio`); the
///                    size is the area of their triangles, and `other` holds the radio fields that a word of
///                    the name suggests (scene/material/material_words.h)
///   lost_picture     pictures that cannot be read (a fault); `material` is the message
///   unused_material  materials that no mesh uses (a doubt)
std::vector<SceneFault> find_material_faults(const Model& model, const std::vector<double>& area_of_material,
                                             bool radio);

}  // namespace greatx::scene::check
