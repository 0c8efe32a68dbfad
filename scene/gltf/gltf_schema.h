// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace greatx::scene {

/// Checks the type of every glTF field that this loader reads. tinygltf does not: where an optional field has
/// the wrong type it silently takes a default, and it truncates integers to 32 bits. Throws UserError, which
/// names file and field.
void check_gltf_types(const std::string& name, const nlohmann::json& document);

}  // namespace greatx::scene
