// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/build/tangents.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Returns `source` in the frame of its body. Positions are in fp64. Normals follow the inverse transpose;
/// where the file has none, each triangle gets vertices of its own with flat normals. The winding is reversed
/// if the determinant is negative. Tangents are made if `want_tangents`. Throws UserError, which starts with
/// `what`, if a position is not finite in fp32 or a triangle loses its area in fp64.
VertexData place_primitive(const ModelPrimitive& source, const dmat4& body_from_mesh, bool want_tangents,
                           const std::string& what);

/// Returns a number for each primitive and vertex. Vertices of the mesh at exactly the same place have the
/// same number.
std::vector<std::vector<uint32_t>> weld(const ModelMesh& mesh);

/// Returns how far rounding to fp32 in the file may have moved a corner, in metres of the body's frame.
double rounding_noise(const ModelPrimitive& source, const dmat4& body_from_mesh);

}  // namespace greatx::scene
