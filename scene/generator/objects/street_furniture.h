// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the furniture of streets: lamps with their photometry, signals, shelters. The foot is at the
// origin, z is up.
#pragma once

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

enum class LampKind { avenue, street, park, yard };

/// A lamp: its mesh, with the arm (if any) along +x, and the light that leaves its glass.
struct Lamp {
  MeshBuilder mesh;
  dvec3 light_position{0.0};  ///< just below the glass
  LightSpec light;            ///< a spot light that points down
};
Lamp make_lamp(LampKind kind);

/// Makes a signal with three lenses on its pole, which faces +x.
MeshBuilder make_signal();
/// Makes a signal for people, red above green, that faces +x, with a pole of its own or fixed to another one.
MeshBuilder make_walk_signal(bool pole);
/// Makes a shelter of 4.2 m along y, open towards +x, with a poster that is lit by night.
MeshBuilder make_shelter();
MeshBuilder make_bin();

}  // namespace greatx::scene::generator
