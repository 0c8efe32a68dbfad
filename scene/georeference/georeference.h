// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the place of a scene on the Earth in its glTF file, as extras of the glTF scene:
//
//   "scenes": [{"extras": {"greatx_georeference": {"latitude_deg": 52.0, "longitude_deg": 4.3,
//                 "height_m": 45.1, "undulation_m": 43.4, "vertical_datum": "NAP"}}}]
//
// It is the place of the origin of the loaded frame (x east, y north, z up), which is glTF's own origin.
// `height_m` is above the ellipsoid. `undulation_m` (0) and `vertical_datum` ("") may be left out, and other
// members are errors. docs/georeference.md describes it for users.
//
//   writer     georeference_extras() -> io::GlbWriter::finish()
//   loader     load_model() -> georeference_of_document() -> Model::georeference
//   scenario   parse_scenario() -> georeference_of_file(), which loads no mesh -> SceneConfig::georeference
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/geodesy.h"

namespace greatx::scene {

/// Returns one JSON object, {"latitude_deg": ...}, with every member. Numbers are read back exactly.
std::string georeference_json(const Georeference& reference);
/// Returns the extras of a glTF scene: {"greatx_georeference": {"latitude_deg": ...}}.
std::string georeference_extras(const Georeference& reference);

/// Returns words for people: "latitude 52.00000000, longitude 4.30000000, 45.100 m above the ellipsoid, 1.700
/// m above NAP".
std::string georeference_words(const Georeference& reference);

/// Returns what the default scene of a glTF document (its JSON) says, or nothing if it says nothing. Throws
/// UserError "FILE:LINE: scenes[0].extras.greatx_georeference.latitude_deg: expected ..., found ...". `where`
/// is the file and the line on which the text begins; if the line is 0, messages name no line.
std::optional<Georeference> georeference_of_document(std::string json, const SourceLocation& where);

/// Does the same for a .gltf or .glb file. It reads the JSON alone, and parses it only if it has the name of
/// the extras. For a file that is no glTF it returns nothing, since the loader says what is wrong with it.
std::optional<Georeference> georeference_of_file(const std::filesystem::path& file);

}  // namespace greatx::scene
