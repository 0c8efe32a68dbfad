// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/budget.h"
#include "scene/gltf/gltf_file.h"

namespace greatx::scene {

/// Sums up the memory that a model's geometry has taken so far.
struct GeometryMemory {
  Spending all{budget::model_geometry}, zeros{budget::model_zeros};
};

/// Returns `count` elements of `components` floats each; `components` is 2, 3 or 4 (VEC2 to VEC4). Normalized
/// integers are mapped to [0, 1] or [-1, 1] (glTF 2.0, section 3.11). Sparse values replace dense ones.
/// Throws UserError, which starts with `what`, if the accessor's index, type or component type is wrong, if a
/// byte that it reads is out of range, or if the model's geometry becomes too large.
std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& what,
                               GeometryMemory& memory);

/// Returns the elements of an accessor of indices: SCALAR of unsigned bytes, shorts or ints. Throws as
/// read_floats does.
std::vector<uint32_t> read_indices(const GltfFile& file, int accessor, const std::string& what,
                                   GeometryMemory& memory);

}  // namespace greatx::scene
