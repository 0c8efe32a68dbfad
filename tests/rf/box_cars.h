// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::rf::testing {

/// Makes a "hatchback" of 4.0 m or a "van" of 5.3 m of boxes and prisms.
scene::generator::MeshBuilder make_box_car(const std::string& variant);

}  // namespace greatx::rf::testing
