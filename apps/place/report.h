// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts into words, JSON and a picture what was built of a place.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/record.h"
#include "scene/check/check.h"
#include "scene/place/assemble/build_place.h"

namespace greatx::apps {

/// The scene as the loader and `greatx scene check` see it.
struct LoadedPlace {
  uint64_t facets = 0;
  scene::SceneFaults check;
};

nlohmann::json json_of(const scene::place::PlaceReport& report, const LoadedPlace& loaded);
/// Returns the report as Markdown: numbers, findings by topic with some of their objects, materials,
/// licences.
std::string markdown_of(const scene::place::PlaceReport& report, const LoadedPlace& loaded);
/// Returns some lines for the terminal.
std::string summary_of(const scene::place::PlaceReport& report, const LoadedPlace& loaded);
/// Draws the place from above, north up: on the left the polygons and lines of the sources, on the right
/// what was built, with roofs coloured by height. Returns u8 [height, width, 3].
Array picture_of(const scene::place::BuiltPlace& built, const scene::place::PlaceInput& input);

}  // namespace greatx::apps
