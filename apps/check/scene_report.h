// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts into words, JSON and a picture what a check of a glTF file has found.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/record.h"
#include "scene/check/check.h"

namespace greatx::apps {

/// Returns a line for each kind with at most `places` lines of places and, if `figures` is set, the figures.
std::string scene_check_text(const std::string& file, const scene::SceneFaults& faults, size_t places,
                             bool figures);

nlohmann::json scene_check_json(const std::string& file, const scene::SceneFaults& faults);

/// Draws the model from straight above (north is up), at most `pixels` wide and high: surfaces that face up
/// are light, higher ones lighter; faults are red, doubts orange. Returns u8 [height, width, 3].
Array draw_faults(const scene::Model& model, const scene::SceneFaults& faults, int pixels);

}  // namespace greatx::apps
