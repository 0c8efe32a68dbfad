// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx::apps::test {

/// The text of a glTF file with one triangle: (0, 0, 0), (1, 0, 0), (0, 0, -1) in glTF's axes, which is (0,
/// 0), (1, 0), (0, 1) on the ground with z up.
inline constexpr const char* ground_gltf =
    R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "ground"}],
    "materials": [{"name": "itu_medium_dry_ground", )"
    R"("pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.5, 0.3, 1]}}],
    "meshes": [{"name": "ground", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/"}]})";

}  // namespace greatx::apps::test
