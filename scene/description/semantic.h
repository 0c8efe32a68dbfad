// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "scene/description/scene.h"

namespace greatx::scene {

/// The class called `name` (name_of's spelling); empty if there is none.
std::optional<SemanticClass> semantic_class_called(const std::string& name);

/// What a node's or mesh's name says about its class, by the patterns of docs/materials.md; empty if nothing.
std::optional<SemanticClass> semantic_class_from_name(const std::string& name);

}  // namespace greatx::scene
