// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/budget.h"
#include "scene/gltf/gltf_file.h"

namespace greatx::scene {

/// What has been read of a model's geometry so far.
struct GeometryMemory {
  Spending all{budget::model_geometry}, zeros{budget::model_zeros};
};

/// `count` elements of `components` floats each, normalized integers mapped to [0, 1] or [-1, 1] (glTF 2.0,
/// section 3.11), sparse values laid over. Throws UserError starting with `what` if the accessor's index,
/// type, component type or any byte that it reads is out of range, or the model's geometry becomes too large.
/// `components` is 2, 3 or 4 (VEC2 … VEC4).
std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& what,
                               GeometryMemory& memory);

/// The same for indices: SCALAR of unsigned bytes, shorts or ints.
std::vector<uint32_t> read_indices(const GltfFile& file, int accessor, const std::string& what,
                                   GeometryMemory& memory);

}  // namespace greatx::scene
