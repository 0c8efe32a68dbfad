// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/build/tangents.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// `source` in its body's frame: positions in fp64, normals by the inverse transpose (flat ones, with
/// vertices of their own, where the file has none), winding mended under a negative determinant, tangents if
/// `want_tangents`. Throws UserError starting with `what` if a position is not finite in fp32 or a triangle
/// loses its area in fp64.
VertexData place_primitive(const ModelPrimitive& source, const dmat4& body_from_mesh, bool want_tangents,
                           const std::string& what);

/// For each primitive and vertex a number; vertices of the mesh at exactly the same place have the same one.
std::vector<std::vector<uint32_t>> weld(const ModelMesh& mesh);

/// How far rounding to fp32 in the file may have moved a corner, in metres of the body's frame.
double rounding_noise(const ModelPrimitive& source, const dmat4& body_from_mesh);

}  // namespace greatx::scene
