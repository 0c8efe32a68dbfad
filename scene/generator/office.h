// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// The luminous flux of a ceiling light of a room, lm.
inline constexpr double room_lamp_lm = 3600.0;

/// Adds the light of the eight ceiling lights of the room of 12 x 8 x 3.2 m, without their meshes.
void add_room_lights(SceneWriter& writer);
/// Adds furniture to the room: ceiling lights, tables with chairs, shelves with books, a door and a board.
void add_furniture(SceneWriter& writer);

}  // namespace greatx::scene::generator
