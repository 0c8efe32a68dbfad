// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads PLY meshes (G. Turk, The PLY Polygon File Format, 1994): ascii, and binary of either byte order.
// Elements and properties other than those of PlyMesh are skipped.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

struct PlyMesh {
  std::vector<vec3> positions;    ///< x, y, z; a double is rounded to float
  std::vector<vec3> normals;      ///< nx, ny, nz as in the file; empty if it has none
  std::vector<uint32_t> indices;  ///< triangles; (a, b, c, d) becomes (a, b, c), (a, c, d)
};

/// Reads a mesh. `name` stands for the file in messages. Throws UserError with the line (header, ascii) or
/// the byte (binary) for a faulty header, counts beyond the file's size, a file that ends early, coordinates
/// that are not finite, faces with other than three or four corners, indices beyond the vertices, and a mesh
/// without a vertex or a face.
PlyMesh read_ply_mesh(std::span<const unsigned char> file, const std::string& name);

}  // namespace greatx::scene
