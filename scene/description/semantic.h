// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Returns the class called `name` (in name_of's spelling), or nothing if there is none.
std::optional<SemanticClass> semantic_class_called(const std::string& name);

/// Returns the class that the name of a node or mesh indicates by the patterns of docs/materials.md, or
/// nothing.
std::optional<SemanticClass> semantic_class_from_name(const std::string& name);

}  // namespace greatx::scene
